// SPDX-License-Identifier: Apache-2.0
// Hand-made broken files (tests/data/broken, made by its make.py, and tests/data/pbrt/broken): each gives an error
// that names the file, the place if there is one, and what is wrong; in little time and memory.

#include "broken_files.hpp"
#include "io/image_file.hpp"
#include "io/import.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cstdio>
#include <sstream>
#include <vector>

// A broken file never justifies a single allocation of this size: AddressSanitizer then ends the test.
// NOLINTBEGIN(bugprone-reserved-identifier): the name is AddressSanitizer's
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
    return "max_allocation_size_mb=1024:quarantine_size_mb=64:detect_stack_use_after_return=1";
}
// NOLINTEND(bugprone-reserved-identifier)

using namespace restage;
using Catch::Matchers::ContainsSubstring;
using test::data_folder;
namespace fs = std::filesystem;

namespace {

constexpr double most_seconds = 20; // with sanitizers, on a busy machine
constexpr double most_megabytes = 700;

struct Case {
    fs::path path;
    std::string message;
};

// The lines of expected.txt for one folder.
std::vector<Case> cases(const std::string& folder) {
    std::vector<Case> result;
    std::istringstream lines(test::read_bytes(data_folder / "broken/expected.txt"));
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(folder + "/")) {
            const auto bar = line.find('|');
            REQUIRE(bar != std::string::npos);
            result.push_back({data_folder / "broken" / line.substr(0, bar), line.substr(bar + 1)});
        }
    // The folder holds no unexpected files.
    const auto files = std::distance(fs::directory_iterator(data_folder / "broken" / folder), fs::directory_iterator());
    CHECK(files == static_cast<std::ptrdiff_t>(result.size()));
    return result;
}

// Whether the report has a dropped thing with this text.
bool drops(const io::ImportedScene& imported, const std::string& text) {
    const auto& entries = imported.report.entries;
    return std::any_of(entries.begin(), entries.end(), [&](const io::ReportEntry& e) {
        return e.fate == io::Fate::dropped && to_string(e).find(text) != std::string::npos;
    });
}

// "file:line:column: what"
bool has_place(const std::string& message) {
    for (auto colon = message.find(':'); colon != std::string::npos; colon = message.find(':', colon + 1)) {
        unsigned line = 0, column = 0;
        int used = 0;
        if (std::sscanf(message.c_str() + colon, ":%u:%u: %n", &line, &column, &used) == 2 && used > 0)
            return colon > 0 && line > 0 && column > 0 && colon + static_cast<std::size_t>(used) < message.size();
    }
    return false;
}

} // namespace

TEST_CASE("broken: scene files of the pbrt importer's own collection") {
    const test::Importers importers;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(data_folder / "pbrt/broken"))
        files.push_back(entry.path());
    REQUIRE(files.size() >= 40);
    for (const fs::path& file : files) {
        CAPTURE(file.filename().string());
        const test::Watch watch;
        const auto result = io::import_scene(file.string(), importers.registry);
        REQUIRE_FALSE(result);
        CAPTURE(result.error().message);
        CHECK(has_place(result.error().message));
        CHECK_THAT(result.error().message, ContainsSubstring(file.filename().string()));
        CHECK(watch.seconds() < most_seconds);
        CHECK(watch.grown() < most_megabytes);
    }
}

TEST_CASE("broken: scene files, and what they include") {
    const test::Importers importers;
    for (const Case& c : cases("scenes")) {
        if (c.path.extension() == ".inc") continue; // named by another
        CAPTURE(c.path.filename().string());
        const test::Watch watch;
        const auto result = io::import_scene(c.path.string(), importers.registry);
        if (c.message.starts_with("report:")) { // the scene opens without it
            REQUIRE(result);
            CHECK(drops(*result, c.message.substr(7)));
            continue;
        }
        REQUIRE_FALSE(result);
        CHECK_THAT(result.error().message, ContainsSubstring(c.message));
        CHECK_THAT(result.error().message, ContainsSubstring("broken/scenes/"));
        CHECK(watch.seconds() < most_seconds);
        CHECK(watch.grown() < most_megabytes);
    }
}

TEST_CASE("broken: PLY files are an error at the shape that names them") {
    const test::Importers importers;
    const test::Folder folder;
    const fs::path scene = folder / "scene.pbrt";
    std::size_t count = 0;
    for (const Case& c : cases("ply")) {
        CAPTURE(c.path.filename().string());
        test::write_bytes(scene, "WorldBegin\n  Shape \"plymesh\" \"string filename\" \"" + c.path.string() + "\"\n");
        const test::Watch watch;
        const auto result = io::import_scene(scene.string(), importers.registry);
        ++count;
        if (c.message.starts_with("report:")) { // unreadable as a file, like a missing one
            REQUIRE(result);
            CHECK(drops(*result, c.message.substr(7)));
            continue;
        }
        REQUIRE_FALSE(result);
        CHECK_THAT(result.error().message, ContainsSubstring("scene.pbrt:2:3: "));
        CHECK_THAT(result.error().message, ContainsSubstring(c.path.filename().string()));
        CHECK_THAT(result.error().message, ContainsSubstring(c.message));
        CHECK(watch.seconds() < most_seconds);
        CHECK(watch.grown() < most_megabytes);
    }
    CHECK(count >= 30);
}

TEST_CASE("broken: images are an error to the reader and a line in the report of a scene") {
    const test::Importers importers;
    const test::Folder folder;
    const fs::path scene = folder / "scene.pbrt";
    std::size_t count = 0;
    for (const Case& c : cases("images")) {
        CAPTURE(c.path.filename().string());
        const test::Watch watch;
        const auto image = io::read_image(c.path.string(), scene::Encoding::srgb);
        REQUIRE_FALSE(image);
        CHECK_THAT(image.error().message, ContainsSubstring(c.path.string() + ": "));
        CHECK_THAT(image.error().message, ContainsSubstring(c.message));

        test::write_bytes(scene, "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" +
                                     c.path.string() +
                                     "\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n");
        const auto result = io::import_scene(scene.string(), importers.registry);
        REQUIRE(result); // a scene with a broken picture still opens
        CHECK(drops(*result, c.path.filename().string()));
        CHECK(watch.seconds() < most_seconds);
        CHECK(watch.grown() < most_megabytes);
        ++count;
    }
    CHECK(count >= 30);
}

TEST_CASE("broken: OBJ, STL and glTF models") {
    const test::Importers importers;
    std::size_t count = 0;
    for (const Case& c : cases("models")) {
        CAPTURE(c.path.filename().string());
        const test::Watch watch;
        const auto result = io::import_scene(c.path.string(), importers.registry);
        ++count;
        if (c.message.starts_with("report:")) { // the scene opens without it
            REQUIRE(result);
            CHECK(drops(*result, c.message.substr(7)));
        } else {
            REQUIRE_FALSE(result);
            CHECK_THAT(result.error().message, ContainsSubstring(c.message));
            CHECK_THAT(result.error().message, ContainsSubstring("broken/models/"));
            CHECK_THAT(result.error().message, !ContainsSubstring("a bug, please report it"));
        }
        CHECK(watch.seconds() < most_seconds);
        CHECK(watch.grown() < most_megabytes);
    }
    CHECK(count >= 70);
}

TEST_CASE("broken: PLY files opened directly") {
    const test::Importers importers;
    for (const Case& c : cases("ply")) {
        CAPTURE(c.path.filename().string());
        const auto result = io::import_scene(c.path.string(), importers.registry);
        if (c.path.filename() == "no-faces.ply") { // points get a thickness
            CHECK(result);
            continue;
        }
        REQUIRE_FALSE(result);
        const bool file = c.message.starts_with("report:");
        CHECK_THAT(result.error().message, ContainsSubstring(file ? c.message.substr(7) : c.message));
        CHECK_THAT(result.error().message, ContainsSubstring(c.path.filename().string() + ":"));
    }
}

TEST_CASE("broken: files that are not scenes at all") {
    const test::Importers importers;
    const test::Folder folder;
    for (const fs::path& path : {folder / "absent.pbrt", folder / "", data_folder / "broken/images/cut.png"}) {
        CAPTURE(path.string());
        const auto result = io::import_scene(path.string(), importers.registry);
        REQUIRE_FALSE(result);
        CHECK_THAT(result.error().message, ContainsSubstring(path.string()));
    }
}
