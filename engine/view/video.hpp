// SPDX-License-Identifier: Apache-2.0
// Videos of rendered pictures, made by ffmpeg, a program that is not part of Restage.
#pragma once

#include "base/result.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

namespace restage::view {

// By its extension: .mp4, .webm, .mov, .mkv or .gif.
bool is_video_path(const std::filesystem::path& path);

// The pictures of a video while they are rendered, in a temporary folder that is removed with this.
class VideoFrames {
  public:
    // Error, before anything is rendered: ffmpeg is not on PATH, or there is no place for the pictures.
    static Result<VideoFrames> create();
    VideoFrames(VideoFrames&& other) noexcept;
    VideoFrames& operator=(VideoFrames&&) = delete;
    ~VideoFrames();

    std::string next(); // where to write the next picture: a .png
    // Writes the video: 8 bits, in the format's usual codec. `fps`: pictures a second, > 0. Odd sizes get a black
    // border of one pixel, as most codecs need. `cancel` is polled. Errors contain what ffmpeg said last.
    Result<> write(const std::filesystem::path& video, double fps, const std::atomic<bool>* cancel = nullptr) const;

  private:
    VideoFrames(std::string ffmpeg, std::filesystem::path folder)
        : ffmpeg_(std::move(ffmpeg)), folder_(std::move(folder)) {}
    std::string ffmpeg_;
    std::filesystem::path folder_; // "" = moved away
    std::uint32_t count_ = 0;
};

// The program of that name on PATH; "" = there is none.
std::string program_on_path(const std::string& name);

} // namespace restage::view
