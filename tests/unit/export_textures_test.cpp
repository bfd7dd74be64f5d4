// SPDX-License-Identifier: Apache-2.0
// Textures through pbrt files: each type is read by its table, and written by it if it was created here; losses are
// reported.
#include "export_scene.hpp"
#include "io/import.hpp"
#include "plugin/texture_source.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using test::Folder, test::Plugins, test::version;

namespace {

const glm::dmat4 to_scene = glm::translate(glm::dmat4(1), {1, -2, 0.5}) *
                            glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(0.6, 0, 0.8)) *
                            glm::scale(glm::dmat4(1), {2, 0.5, 1.25});

// Of a line of the map or of a point in space; nullopt: of the type's own.
std::optional<float> placing(const std::string& id) {
    const glm::dmat4 inside = glm::inverse(to_scene);
    const std::string axes = "xyz";
    const auto axis = [&](char c) { return glm::length_t(axes.find(c)); };
    if (id.size() == 8 && id.substr(1, 6) == "_from_") return float(inside[axis(id[7])][axis(id[0])]);
    if (id.starts_with("origin_")) return float(inside[3][axis(id[7])]);
    if (id == "uscale" || id == "vscale") return id == "uscale" ? 3.f : 5.f;
    if (id == "udelta" || id == "vdelta") return id == "udelta" ? 0.25f : -0.75f;
    if (id == "ushear" || id == "vshear" || id == "uvset") return 0.f; // pbrt has none
    return std::nullopt;
}

// Not the default, and in range.
Value another(const model::Param& line, bool scalar, std::size_t at) {
    if (const auto placed = placing(line.id))
        return line.type == model::ParamType::integer ? Value::integer(int(*placed)) : Value::number(*placed);
    switch (line.type) {
        case model::ParamType::number:
            return Value::number(line.def[0] + 0.25f * (std::min(line.max, 4.f) - line.def[0]));
        case model::ParamType::color: {
            const float v = 0.125f + 0.125f * float(at % 6);
            return line.id == "scale" || scalar ? Value::color(v, v, v) : Value::color(v, 0.5f * v, 0.75f);
        }
        case model::ParamType::integer:
            return Value::integer(line.int_def > line.int_min ? line.int_def - 1 : line.int_def + 1);
        case model::ParamType::boolean:
            return Value::boolean(line.int_def == 0);
        default:
            return Value::choice(line.choices[line.choices.size() - 1 - std::size_t(line.int_def)]);
    }
}

std::vector<model::Param> lines_of(const model::Texture& table) {
    std::vector<model::Param> lines = table.params;
    if (table.mapped) lines.insert(lines.end(), model::mapping_params().begin(), model::mapping_params().end());
    return lines;
}

// A texture of each type, with every value set, of a material that has it. `scalar`: in its bump slot.
Scene made_here(const Plugins& plugins, bool scalar) {
    test::Everything out(true);
    Scene& s = out.scene;
    const auto pixels = std::make_shared<PixelData>(PixelData{2, 2, 1, {0, 0.25f, 0.5f, 1}});
    const auto image = out.add(Image{.name = "texels", .encoding = Encoding::linear, .data = pixels});
    for (const plugin::TextureEntry& entry : plugins.registry.textures()) {
        Texture t{.name = "made " + entry.table->type, .type = entry.table->type, .is_float = scalar};
        if (entry.table->image) t.image = image;
        std::size_t at = 0;
        for (const model::Param& line : lines_of(*entry.table))
            t.params.set(line.id, another(line, scalar, at++));
        const auto id = out.add(std::move(t));
        const Value slot{.type = scalar ? model::ParamType::texture : model::ParamType::color, .texture = id};
        const auto m =
            out.material(("of " + entry.table->type).c_str(), "diffuse", {{scalar ? "bump" : "reflectance", slot}});
        Instance i = s.instances[Id<Instance>{1}];
        i.name = entry.table->type;
        i.material = m;
        out.add(std::move(i));
    }
    return s;
}

const Texture* named(const Scene& s, const std::string& name) {
    const Texture* found = nullptr;
    s.textures.each([&](Id<Texture>, const Texture& t) {
        if (t.name == name) found = &t;
    });
    return found;
}

} // namespace

TEST_CASE("every shipped type of texture created here is written to pbrt by its table and read back", "[export]") {
    Plugins plugins;
    const std::string v = GENERATE("v4", "v3");
    const bool scalar = GENERATE(false, true);
    INFO(v << (scalar ? ", scalar" : ", colour"));
    const Scene scene = made_here(plugins, scalar);
    Folder folder;
    const auto report = io::export_scene(scene, folder.file("out.pbrt"), plugins.registry, version(v.c_str()));
    if (!report) FAIL(report.error().message);
    const auto said_of = [&](const std::string& name) {
        std::string all;
        for (const io::ReportEntry& e : report->entries)
            if (e.fate != io::Fate::kept && e.what.find(name) != std::string::npos) all += e.note + "\n";
        return all;
    };
    const auto again = io::import_scene(folder.file("out.pbrt"), plugins.registry);
    if (!again) FAIL(again.error().message);
    for (const plugin::TextureEntry& entry : plugins.registry.textures()) {
        const std::string& type = entry.table->type;
        INFO(type);
        const std::string said = said_of("made " + type + "\"");
        if (type == "marble" && scalar) { // of colours only, in both versions
            CHECK_THAT(said, ContainsSubstring("has no such texture; its average is written"));
            continue;
        }
        if (type == "imagemap" && v == "v3")
            CHECK_THAT(said, ContainsSubstring("cannot invert"));
        else
            CHECK(said == "");
        const Texture* before = named(scene, "made " + type);
        const Texture* after = named(again->scene, "made " + type);
        REQUIRE(before);
        REQUIRE(after);
        const bool scaled = v == "v4" && !scalar && (type == "fbm" || type == "wrinkled" || type == "windy");
        if (scaled) { // v4 has them as scalars: a product with 1
            CHECK(after->type == "scale");
            after = again->scene.textures.find(after->params.texture("scale"));
            REQUIRE(after);
        }
        CHECK(after->type == type);
        CHECK(after->is_float == (scalar || scaled));
        for (const model::Param& line : lines_of(*entry.table)) {
            if (line.id == "invert" && v == "v3") continue;
            if (type == "scale" && v == "v4" && !scalar) { // of two constants: their product
                const auto product = [](const Texture& t) {
                    return t.params.color("tex", {1, 1, 1})[1] * t.params.color("scale", {1, 1, 1})[1];
                };
                CHECK(std::abs(product(*after) - product(*before)) <= 1e-5f);
                continue;
            }
            INFO(line.id);
            const Value* set = after->params.find(line.id);
            const Value now = set ? *set : default_value(line), was = *before->params.find(line.id);
            CHECK(now.type == was.type);
            for (int k = 0; k < 3; ++k)
                CHECK(std::abs(now.v[std::size_t(k)] - was.v[std::size_t(k)]) <= 1e-5f);
            CHECK(now.i == was.i);
            CHECK(now.text == was.text);
            if (!placing(line.id)) CHECK(!(now == default_value(line)));
        }
    }
}

TEST_CASE("every value of every pbrt type is read by its table", "[pbrt]") {
    Plugins plugins;
    Folder folder;
    const auto head = std::string("Film \"rgb\"\nCamera \"perspective\"\nWorldBegin\nTransform [");
    std::string text = head;
    for (int k = 0; k < 16; ++k)
        text += " " + std::to_string(to_scene[k / 4][k % 4]);
    text += " ]\n";
    std::ofstream(folder.file("a.pfm"), std::ios::binary) << "Pf\n1 1\n-1\n" << std::string(4, '\0');
    for (const plugin::TextureEntry& entry : plugins.registry.textures()) {
        const std::string& type = entry.table->type;
        text += "Texture \"" + type + "\" \"spectrum\" \"" + (type == "checkerboard3d" ? "checkerboard" : type) + "\"";
        if (type == "checkerboard3d") text += " \"integer dimension\" 3";
        if (type == "imagemap") text += " \"string filename\" \"a.pfm\"";
        std::size_t at = 0;
        for (const model::Param& line : lines_of(*entry.table)) {
            const Value x = another(line, false, at++);
            const auto number = [](float f) { return " " + std::to_string(f); };
            if (placing(line.id) && (!entry.table->mapped || line.id.ends_with("shear") || line.id == "uvset"))
                continue;
            if (type == "scale" && line.id == "scale") { // a scalar in v4
                text += " \"float scale\"" + number(x.v[0]);
                continue;
            }
            switch (line.type) {
                case model::ParamType::number:
                    text += " \"float " + line.id + "\"" + number(x.v[0]);
                    break;
                case model::ParamType::color:
                    text += " \"rgb " + line.id + "\" [" + number(x.v[0]) + number(x.v[1]) + number(x.v[2]) + " ]";
                    break;
                case model::ParamType::integer:
                    text += " \"integer " + line.id + "\" " + std::to_string(x.i);
                    break;
                case model::ParamType::boolean:
                    text += " \"bool " + line.id + "\" " + (x.i != 0 ? "true" : "false");
                    break;
                default:
                    text += " \"string " + line.id + "\" \"" + x.text + "\"";
            }
        }
        text += "\n";
    }
    std::ofstream(folder.file("in.pbrt"), std::ios::binary) << text << "Shape \"sphere\"\n";
    const auto in = io::import_scene(folder.file("in.pbrt"), plugins.registry);
    if (!in) FAIL(in.error().message);
    for (const io::ReportEntry& e : in->report.entries)
        CHECK(e.what.find("Texture") == std::string::npos);
    for (const plugin::TextureEntry& entry : plugins.registry.textures()) {
        const Texture* t = named(in->scene, entry.table->type);
        INFO(entry.table->type);
        REQUIRE(t);
        CHECK(t->type == entry.table->type);
        std::size_t at = 0;
        for (const model::Param& line : lines_of(*entry.table)) {
            INFO(line.id);
            const Value* set = t->params.find(line.id);
            const Value now = set ? *set : default_value(line), was = another(line, false, at++);
            for (std::size_t k = 0; k < 3; ++k)
                CHECK(std::abs(now.v[k] - was.v[k]) <= 1e-5f);
            CHECK(now.i == was.i);
            CHECK(now.text == was.text);
        }
    }
}

TEST_CASE("losses of textures in pbrt are reported", "[export]") {
    Plugins plugins;
    Folder folder;
    Scene s = made_here(plugins, false);
    const auto change = [&](const char* type, auto&& f) {
        s.textures.each([&](Id<Texture> id, const Texture& t) {
            if (t.name == std::string("made ") + type) apply(s, *modify(s, id, "change", f));
        });
    };
    change("dots", [](Texture& t) { t.type = "of a plugin"; });
    change("checkerboard", [](Texture& t) { t.params.set("ushear", Value::number(1)); });
    change("bilerp", [](Texture& t) { t.params.set("uvset", Value::integer(1)); });
    change("imagemap", [](Texture& t) { t.image = {}; });
    change("fbm", [](Texture& t) {
        for (const char* id : {"x_from_x", "x_from_y", "x_from_z"})
            t.params.set(id, Value::number(0));
    });
    change("mix", [](Texture& t) { t.params.set("amount", {.type = model::ParamType::number, .texture = {1}}); });
    const auto report = io::export_scene(s, folder.file("out.pbrt"), plugins.registry, version("v4"));
    REQUIRE(report);
    std::map<std::string, std::string> said;
    for (const io::ReportEntry& e : report->entries)
        if (e.fate == io::Fate::approximated) said[e.what] += e.note;
    CHECK_THAT(said["texture \"made dots\" (of a plugin)"], ContainsSubstring("has no such texture"));
    CHECK_THAT(said["texture \"made checkerboard\""], ContainsSubstring("rotation is dropped"));
    CHECK_THAT(said["texture \"made bilerp\""], ContainsSubstring("second texture coordinates"));
    CHECK_THAT(said["texture \"made imagemap\""], ContainsSubstring("has no image"));
    CHECK_THAT(said["texture \"made fbm\""], ContainsSubstring("in a plane"));
    const auto back = io::import_scene(folder.file("out.pbrt"), plugins.registry);
    REQUIRE(back);
    const auto turned = find_by_name<Texture>(back->scene, "made checkerboard");
    REQUIRE(turned);
    const ParamSet& params = back->scene.textures[turned].params;
    CHECK(params.number("uscale", 0) == Catch::Approx(std::hypot(3, 1))); // as many repetitions as along s
    CHECK(params.number("vscale", 0) == Catch::Approx(5));
}
