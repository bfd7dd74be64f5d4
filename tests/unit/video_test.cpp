// SPDX-License-Identifier: Apache-2.0
// Videos: with a stand-in for ffmpeg, a script that counts what it gets; and with the real one, where there is one.
#include "view/video.hpp"
#include "temporary_folder.hpp"
#include "view/picture.hpp"

#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <fstream>
#include <iterator>

using namespace restage;
namespace fs = std::filesystem;

namespace {

class Path { // of programs, until the end
  public:
    explicit Path(const std::string& now) : before_(std::getenv("PATH")) { ::setenv("PATH", now.c_str(), 1); }
    ~Path() { ::setenv("PATH", before_.c_str(), 1); }
    Path(const Path&) = delete;
    Path& operator=(const Path&) = delete;

  private:
    std::string before_;
};

void write_script(const fs::path& file, const std::string& text) {
    std::ofstream(file) << "#!/bin/sh\n" << text;
    fs::permissions(file, fs::perms::owner_all);
}

std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

void draw(const std::string& file) {
    const std::vector<std::uint32_t> grey(17 * 9, 0xff808080u); // of odd sizes
    REQUIRE(view::write_rgba(file, 17, 9, grey));
}

} // namespace

TEST_CASE("videos are known by their extensions", "[video]") {
    for (const char* name : {"a.mp4", "folder/B.WEBM", "a.b.gif", "a.mov", "a.mkv"})
        CHECK(view::is_video_path(name));
    for (const char* name : {"a.png", "mp4", "a.mp4.png", ""})
        CHECK_FALSE(view::is_video_path(name));
}

TEST_CASE("without ffmpeg there is an error before anything is rendered", "[video]") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "ffmpeg") << "not a program";
    const Path path(folder.path().string() + ":");
    CHECK(view::program_on_path("ffmpeg").empty());
    const auto video = view::VideoFrames::create();
    REQUIRE_FALSE(video);
    CHECK(video.error().message.find("ffmpeg, which is not on PATH") != std::string::npos);
}

TEST_CASE("ffmpeg gets the pictures in order; its last words are the error; nothing is left behind", "[video]") {
    const test::TemporaryFolder folder;
    const std::string before = std::getenv("PATH");
    const Path path(folder.path().string() + ":" + before);
    // The last argument is the video; the one after -i, the pattern of the pictures.
    write_script(folder.path() / "ffmpeg", R"sh(for a in "$@"; do last="$a"; done
while [ "$1" != "-i" ]; do [ "$1" = "-framerate" ] && rate=$2; shift; done
echo "$rate" "$(ls "$(dirname "$2")" | tr '\n' ' ')" > "$last"
)sh");
    const fs::path out = folder.path() / "turn.mp4";
    fs::path frames;
    {
        auto video = view::VideoFrames::create();
        REQUIRE(video);
        CHECK_FALSE(video->write(out, 24)); // no pictures
        for (int i = 0; i < 2; ++i) {
            const std::string file = video->next();
            frames = fs::path(file).parent_path();
            draw(file);
        }
        REQUIRE(video->write(out, 12.5));
        CHECK(text_of(out) == "12.5 000001.png 000002.png \n");
        write_script(folder.path() / "ffmpeg", "echo first >&2; echo no such codec >&2; exit 3\n");
        const auto failed = video->write(folder.path() / "other.webm", 24);
        REQUIRE_FALSE(failed);
        CHECK(failed.error().message.ends_with("other.webm: ffmpeg: exit code 3: no such codec"));
        CHECK(fs::exists(frames));
    }
    CHECK_FALSE(fs::exists(frames));
    CHECK_FALSE(fs::exists(folder.path() / "other.webm"));
    CHECK_FALSE(fs::exists(folder.path() / "turn.part.mp4"));
}

TEST_CASE("a video of pictures with odd sizes", "[video]") {
    if (view::program_on_path("ffmpeg").empty()) SKIP("ffmpeg is not on PATH");
    const test::TemporaryFolder folder;
    auto video = view::VideoFrames::create();
    REQUIRE(video);
    for (int i = 0; i < 3; ++i)
        draw(video->next());
    for (const char* name : {"a.mp4", "a.gif"}) {
        const auto done = video->write(folder.path() / name, 24);
        INFO((done ? "" : done.error().message));
        CHECK(done);
        CHECK(fs::file_size(folder.path() / name) > 100);
    }
}
