// SPDX-License-Identifier: Apache-2.0
// Exporters: a scene with something of everything, with holes where things were removed, in every choice of their
// options; twice the same bytes; a stop at every call of progress(); places that cannot be written.
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "base/file.hpp"
#include "io/export.hpp"
#include "scene/bounds.hpp"
#include "scene/edits.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::check {

namespace fs = std::filesystem;
using namespace scene;

namespace {

struct Building {
    Scene scene;
    template <class T>
    Id<T> add(T item) {
        const Id<T> id = table<T>(scene).next();
        apply(scene, insert(scene, std::move(item), "check"));
        return id;
    }
};

std::shared_ptr<const MeshData> square(bool normals, bool uvs) {
    auto data = std::make_shared<MeshData>();
    data->positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    if (normals) data->normals.assign(4, {0, 0, 1});
    if (uvs) data->uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    data->triangles = {{0, 1, 2}, {0, 2, 3}};
    compute_bounds(*data);
    return data;
}

// Something of everything; names with spaces, quotes and letters of others.
Scene everything() {
    Building b;
    const auto plain = b.add(Mesh{.name = "plain", .data = square(false, false)});
    const auto full = b.add(Mesh{.name = "with \"everything\"", .data = square(true, true)});
    const auto gone = b.add(Mesh{.name = "gone", .data = square(false, false)});
    PixelData pixels{.width = 2, .height = 2, .channels = 3, .values = std::vector<float>(12, 0.25f)};
    const auto image = b.add(Image{.name = "in memory", .data = std::make_shared<PixelData>(pixels)});
    b.add(Image{.name = "missing", .path = "/nowhere/missing.png"});
    const auto texture = b.add(Texture{.name = "Fläche 板", .type = "imagemap", .image = image});
    Texture checks{.name = "checks", .type = "checkerboard"};
    checks.params.set("tex1", Value{.type = model::ParamType::color, .texture = texture});
    checks.params.set("uscale", Value::number(4));
    const auto checker = b.add(std::move(checks));
    b.add(Texture{.name = "strange", .type = "no such texture", .is_float = true});
    Material matte{.name = "matte", .type = "diffuse"};
    matte.params.set("reflectance", Value{.type = model::ParamType::color, .texture = checker});
    const auto diffuse = b.add(std::move(matte));
    Material strange{.name = "of a plugin that is not there", .type = "nosuchmaterial"};
    strange.params.set("gloss", Value::number(0.5f));
    strange.params.set("mode", Value::choice("soft"));
    const auto unknown = b.add(std::move(strange));
    const auto fog = b.add(Medium{.name = "fog", .sigma_a = glm::vec3(0.1f), .sigma_s = glm::vec3(0.2f), .g = 0.3f});
    const auto room = b.add(Group{.name = "room"});
    const auto inner = b.add(Group{.name = "", .parent = room});
    const auto at = [](double x) { return glm::translate(glm::dmat4(1), glm::dvec3(x, 0, 1e-3 * x)); };
    b.add(Instance{.name = "floor", .mesh = plain, .material = diffuse});
    const auto removed = b.add(Instance{.name = "removed", .mesh = gone, .material = diffuse});
    b.add(Instance{.name = "floor", .mesh = full, .material = unknown, .group = inner, .object_to_world = at(2)});
    b.add(Instance{.name = "lamp",
                   .mesh = plain,
                   .material = diffuse,
                   .group = room,
                   .object_to_world = glm::scale(at(4), glm::dvec3(-1, 2, 3)),
                   .emission = Emission{.radiance = {1, 2, 3}, .two_sided = true},
                   .reverse_orientation = true});
    b.add(Instance{.name = "glass",
                   .mesh = full,
                   .material = diffuse,
                   .media = MediumInterface{.interior = fog, .exterior = {}},
                   .alpha = 0.5f});
    b.add(Instance{.name = "hidden", .mesh = full, .material = diffuse, .hidden = true});
    apply(b.scene, *remove_instances(b.scene, std::vector{removed}));
    apply(b.scene, *remove(b.scene, gone));
    for (const scene::LightKindRow& row : scene::light_kinds)
        b.add(Light{.name = "light", .kind = row.kind, .light_to_world = at(1)});
    const auto first = b.add(Camera{.name = "first", .lens_radius = 0.1f, .focal_distance = 4});
    b.add(Camera{.name = "second", .screen_window = glm::vec4(-1, 1, -0.5f, 0.5f)});
    apply(b.scene, *set_active_camera(b.scene, first));
    apply(b.scene, set_environment(b.scene, Environment{.name = "sky", .image = image, .hidden_from_camera = true}));
    apply(b.scene, set_film(b.scene, Film{.width = 64,
                                          .height = 32,
                                          .crop = {0.25f, 1, 0, 0.5f},
                                          .filter = {FilterKind::gaussian, {1.5f, 1.5f}, {0.5f, 0}}}));
    return b.scene;
}

Scene nothing() {
    Building b;
    const auto camera = b.add(Camera{.name = "camera"});
    apply(b.scene, *set_active_camera(b.scene, camera));
    return b.scene;
}

// Every choice of every option, one at a time, after the defaults.
std::vector<ParamSet> option_sets(const model::Exporter& exporter) {
    std::vector<ParamSet> sets{{}};
    for (const model::Param& p : exporter.options) {
        const auto with = [&](Value v) {
            ParamSet set;
            set.set(p.id, std::move(v));
            sets.push_back(std::move(set));
        };
        if (p.type == model::ParamType::choice)
            for (std::size_t k = 0; k < choices(p); ++k)
                with(Value::choice(choice(p, k)));
        if (p.type == model::ParamType::boolean)
            for (const bool on : {false, true})
                with(Value::boolean(on));
        if (p.type == model::ParamType::number)
            for (const float x : {p.min, p.max})
                with(Value::number(x));
        if (p.type == model::ParamType::integer)
            for (const int x : {p.int_min, p.int_max})
                with(Value::integer(x));
    }
    return sets;
}

} // namespace

Result<StepResult> check_write(Subject& s) {
    const model::Exporter& exporter = *s.exporter;
    const TemporaryFolder folder;
    const std::string& extension = exporter.extensions[0];
    io::ExportOptions options;
    options.format = exporter.format;
    std::size_t saves = 0, bytes = 0, stops = 0;
    const auto save = [&](const Scene& scene, const fs::path& place, const std::string& what) -> Result<io::Report> {
        std::error_code code;
        fs::create_directories(place, code);
        s.doing("save() of " + what);
        ++saves;
        auto done = io::export_scene(scene, (place / ("scene." + extension)).string(), s.registry(), options);
        s.alive();
        return done;
    };
    const std::size_t open_before = open_files();
    const struct {
        Scene scene;
        const char* name;
    } scenes[] = {{everything(), "a scene with something of everything"}, {nothing(), "a scene without objects"}};
    for (const auto& [scene, name] : scenes)
        for (const ParamSet& set : option_sets(exporter)) {
            options.values = set;
            const std::string what = std::string(name) + ", options " + describe(set);
            std::vector<std::pair<std::string, std::string>> written[2];
            for (int k = 0; k < 2; ++k) {
                const fs::path place = folder.path / "saved"; // the same: paths may stand in the files
                std::error_code ignored;
                fs::remove_all(place, ignored);
                if (const auto done = save(scene, place, what); !done)
                    return StepResult::failed(what + ": " + done.error().message);
                written[k] = contents_of(place);
            }
            if (written[0].empty()) return StepResult::failed(what + ": save() returns 1 and has written nothing");
            if (written[0] != written[1]) {
                std::size_t i = 0;
                while (i < std::min(written[0].size(), written[1].size()) && written[0][i] == written[1][i])
                    ++i;
                return StepResult::failed(what + ": saving twice gives different bytes, first in " +
                                          (i < written[0].size() ? written[0][i].first : "a file that is not there"));
            }
            for (const auto& [file, text] : written[0])
                bytes += text.size();
        }
    options.values = {};
    // Stopped at each call, and where nothing can be written.
    std::size_t calls = 0, stop_at = ~std::size_t{0};
    options.progress = [&](float, std::string_view) { return ++calls < stop_at; };
    RESTAGE_CHECK(save(scenes[0].scene, folder.path / "all", scenes[0].name));
    const std::size_t all = calls;
    for (std::size_t k = 1; k <= all; k += std::max<std::size_t>(all / s.size(64, 16), 1)) {
        calls = 0, stop_at = k, ++stops;
        if (save(scenes[0].scene, folder.path / "stopped",
                 fmt::format("{}, stopped at call {} of progress()", scenes[0].name, k)))
            return StepResult::failed(fmt::format("stopped at call {} of progress(), save() goes on", k));
    }
    options.progress = {};
    RESTAGE_CHECK(write_file_atomic(folder.path / "file", "not a folder"));
    const std::string nowhere = (folder.path / "file" / "in a file" / ("scene." + extension)).string();
    s.doing("save() to a path that leads through a file");
    const auto done = io::export_scene(scenes[0].scene, nowhere, s.registry(), options);
    if (done) return StepResult::failed("save() to a path that leads through a file returns 1");
    if (done.error().message.ends_with("gave up and did not say why"))
        return StepResult::failed("save() to a path that leads through a file returns 0, and error() was not called");
    if (open_files() > open_before + 2)
        return StepResult::failed(fmt::format("{} files were left open", open_files() - open_before));
    return StepResult::passed({{"saved", double(saves)}, {"bytes", double(bytes)}, {"stopped", double(stops)}},
                              all == 0 ? "it never asks progress(): nobody can stop it" : "");
}

} // namespace restage::check
