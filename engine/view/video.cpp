// SPDX-License-Identifier: Apache-2.0
#include "view/video.hpp"

#include "base/process.hpp"
#include "base/temporary.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

namespace restage::view {

namespace fs = std::filesystem;

namespace {

bool runs(const fs::path& file) {
    std::error_code code;
    if (!fs::is_regular_file(file, code)) return false;
#if defined(__unix__) || defined(__APPLE__)
    return ::access(file.c_str(), X_OK) == 0;
#else
    return true;
#endif
}

std::string extension_of(const fs::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); });
    return extension;
}

std::string last_line(std::string_view text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r'))
        text.remove_suffix(1);
    return std::string(text.substr(text.find_last_of('\n') + 1)); // npos + 1 = 0
}

} // namespace

std::string program_on_path(const std::string& name) {
    const char* given = std::getenv("PATH");
    std::string_view rest = given ? given : "";
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(':'), rest.size());
        const std::string_view folder = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (const fs::path file = fs::path(folder) / name; !folder.empty() && runs(file)) return file.string();
    }
    return {};
}

bool is_video_path(const fs::path& path) {
    constexpr std::array<std::string_view, 5> known{".mp4", ".webm", ".mov", ".mkv", ".gif"};
    return std::ranges::find(known, extension_of(path)) != known.end();
}

Result<VideoFrames> VideoFrames::create() {
    std::string ffmpeg = program_on_path("ffmpeg");
    if (ffmpeg.empty())
        return fail("videos are made by ffmpeg, which is not on PATH: install it, or write single pictures");
    RESTAGE_TRY(auto folder, make_temporary_folder("restage-video"));
    return VideoFrames(std::move(ffmpeg), std::move(folder));
}

VideoFrames::VideoFrames(VideoFrames&& other) noexcept
    : ffmpeg_(std::move(other.ffmpeg_)), folder_(std::exchange(other.folder_, {})), count_(other.count_) {}

VideoFrames::~VideoFrames() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

std::string VideoFrames::next() { return (folder_ / fmt::format("{:06}.png", ++count_)).string(); }

Result<> VideoFrames::write(const fs::path& video, double fps, const std::atomic<bool>* cancel) const {
    if (count_ == 0) return fail(video.string() + ": there are no pictures for it");
    // Written beside its place first: an interrupted ffmpeg leaves no half file there.
    fs::path part = video;
    part.replace_filename(video.stem().string() + ".part" + video.extension().string());
    Process process{.argv = {ffmpeg_, "-y", "-nostdin", "-loglevel", "error", "-framerate", fmt::format("{}", fps),
                             "-i", (folder_ / "%06d.png").string()},
                    .environment = {},
                    .on_out = {},
                    .on_err = {},
                    .cancel = cancel};
    if (extension_of(video) != ".gif")
        for (const char* option : {"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"})
            process.argv.emplace_back(option);
    process.argv.push_back(part.string());
    RESTAGE_TRY(const ProcessOutcome done, run_process(process));
    std::error_code code;
    if (!done.ok()) {
        fs::remove(part, code);
        const std::string said = last_line(done.err);
        return fail(fmt::format("{}: ffmpeg: {}{}{}", video.string(), done.what, said.empty() ? "" : ": ", said));
    }
    fs::rename(part, video, code);
    if (code) return fail(video.string() + ": " + code.message());
    return {};
}

} // namespace restage::view
