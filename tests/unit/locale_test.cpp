// SPDX-License-Identifier: Apache-2.0
// A host whose language writes decimal commas (Python after locale.setlocale, another program around the engine)
// changes nothing that is read or written.
#include "document/session.hpp"
#include "export_scene.hpp"
#include "io/import.hpp"
#include "io/scene_compare.hpp"
#include "scene/validate.hpp"

#include <catch2/matchers/catch_matchers_string.hpp>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <locale>

namespace fs = std::filesystem;
using namespace restage;
using namespace restage::test;

namespace {

// German may not be installed: this is its category LC_NUMERIC as compiled by glibc's localedef (decimal_point
// ",", thousands_sep ".", grouping 3;3; the format is as old as glibc 2.3), in a folder that LOCPATH names.
constexpr char lc_numeric[] =
    "\x14\x11\x03\x20\x06\0\0\0\x20\0\0\0\x22\0\0\0\x24\0\0\0\x28\0\0\0\x2c\0\0\0\x30\0\0\0,\0.\0\x03\x03\0\0,\0\0\0."
    "\0\0\0"
    "ANSI_X3.4-1968";

struct Commas : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

// C and C++ of this process write commas while this exists.
class CommaLocale {
  public:
    CommaLocale() : before_(std::locale::global(std::locale(std::locale::classic(), new Commas))) {
        fs::create_directories(folder_ / "comma");
        REQUIRE(write_file_atomic(folder_ / "comma/LC_NUMERIC", std::string_view(lc_numeric, sizeof lc_numeric)));
        setenv("LOCPATH", folder_.path().c_str(), 1);
        REQUIRE(std::setlocale(LC_NUMERIC, "comma"));
        char text[16];
        std::snprintf(text, sizeof text, "%.1f", 0.5);
        REQUIRE(std::string(text) == "0,5");
    }
    ~CommaLocale() {
        std::setlocale(LC_NUMERIC, "C");
        unsetenv("LOCPATH");
        std::locale::global(before_);
    }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

  private:
    TemporaryFolder folder_;
    std::locale before_;
};

fs::path data() { return test::source_dir() / "tests/data"; }

} // namespace

TEST_CASE("files are read identically in every locale", "[locale]") {
    Plugins plugins;
    Folder folder;
    // By its content only; and a number that is special only because of underflow.
    REQUIRE(write_file_atomic(folder.path / "points.txt", "v 0.5 0.5 0.5\nv 1.5 0.25 0\nv 0 1.5 0.5\nf 1 2 3\n"));
    REQUIRE(
        write_file_atomic(folder.path / "tiny.pbrt",
                          "WorldBegin\nTranslate 1e-400 -2.5e-999999999999999999999 0.5\n"
                          "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1.5 0 0 0 1.5 0] \"integer indices\" [0 1 2]\n"));
    const std::vector<std::string> files = {(data() / "pbrt/everything.pbrt").string(),
                                            (data() / "models/thing.obj").string(),
                                            (data() / "models/thing.gltf").string(),
                                            (data() / "models/thing.stl").string(),
                                            folder.file("points.txt"),
                                            folder.file("tiny.pbrt")};
    for (const std::string& file : files) {
        INFO(file);
        const auto plain = io::import_scene(file, plugins.registry);
        INFO((plain ? "" : plain.error().message));
        REQUIRE(plain);
        const CommaLocale commas;
        const auto other = io::import_scene(file, plugins.registry);
        INFO((other ? "" : other.error().message));
        REQUIRE(other);
        CHECK(joined(io::structural_differences(plain->scene, other->scene, plugins.registry)).empty());
        CHECK(plain->report.entries.size() == other->report.entries.size());
    }
    const CommaLocale commas;
    REQUIRE(write_file_atomic(folder.path / "huge.pbrt", "WorldBegin\nTranslate 0.001e999999999999999999999 0 0\n"));
    const auto huge = io::import_scene(folder.file("huge.pbrt"), plugins.registry);
    if (!huge) CHECK_THAT(huge.error().message, Catch::Matchers::ContainsSubstring("too large"));
}

TEST_CASE("files are written identically in every locale", "[locale]") {
    Plugins plugins;
    for (const bool v4 : {true, false}) {
        const Everything all(v4);
        const auto write = [&](const Folder& folder) {
            const auto done =
                io::export_scene(all.scene, folder.file("all.pbrt"), plugins.registry, version(v4 ? "v4" : "v3"));
            INFO((done ? "" : done.error().message));
            REQUIRE(done);
        };
        Folder plain, other;
        write(plain);
        const CommaLocale commas;
        write(other);
        CHECK(plain.contents() == other.contents());
    }
}

TEST_CASE("a shutter and a light kept as text are read identically in every locale", "[locale]") {
    Plugins plugins;
    Folder folder;
    REQUIRE(write_file_atomic(
        folder.path / "kept.pbrt",
        "Camera \"perspective\" \"float fov\" [40.5] \"float shutteropen\" [0.25] \"float shutterclose\" "
        "[0.75]\nWorldBegin\nLightSource \"point\" \"blackbody I\" [3000.5] \"float power\" [12.5]\n"
        "Shape \"sphere\" \"float radius\" [0.5]\n"));
    const auto round = [&](const char* name) {
        const auto in = io::import_scene(folder.file("kept.pbrt"), plugins.registry);
        INFO((in ? "" : in.error().message));
        REQUIRE(in);
        REQUIRE(io::export_scene(in->scene, folder.file(name), plugins.registry));
        return read_file(folder.path / name).value();
    };
    const std::string plain = round("a.pbrt");
    const CommaLocale commas;
    CHECK(plain == round("b.pbrt"));
}

TEST_CASE("messages use decimal points, not commas, in every locale", "[locale]") {
    const CommaLocale commas;
    Everything all(true);
    scene::Camera wrong;
    wrong.fov = 180.5f;
    all.add(wrong);
    bool said = false;
    for (const scene::Problem& p : scene::validate(all.scene))
        said |= p.sentence.find("180.5") != std::string::npos;
    CHECK(said);
}
