// SPDX-License-Identifier: Apache-2.0
// restage info SCENE: contents of a scene file, and what its import kept, approximated and dropped.
#include "commands.hpp"
#include "document/exposure.hpp"
#include "document/looks.hpp"
#include "import_options.hpp"
#include "io/choices.hpp"
#include "io/material_emission.hpp"
#include "rendering.hpp"
#include "scene/placeholder.hpp"
#include "scene/statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

namespace restage::app {
namespace {

nlohmann::json describe(const io::ImportedScene& imported, const document::Looks& looks,
                        const plugin::Registry& registry) {
    const scene::Scene& s = imported.scene;
    const scene::Statistics counted = scene::statistics_of(s);
    std::size_t emitters = 0;
    const io::MaterialEmissions emissions(registry, s);
    s.instances.each([&](auto, const scene::Instance& i) { emitters += emissions.shines(i); });
    std::map<std::string, int> types;
    nlohmann::json missing = nlohmann::json::array();
    s.materials.each([&](auto, const scene::Material& m) {
        ++types[m.type];
        if (!registry.find_material(m.type)) missing.push_back(m.name + " (" + m.type + ")");
    });
    nlohmann::json lights = {
        {"area", emitters},
        {"environment", s.environment.value ? (s.environment.value->image ? "image" : "constant") : "none"}};
    for (const scene::LightKindRow& row : scene::light_kinds)
        lights[row.id] = 0;
    s.lights.each([&](auto, const scene::Light& l) {
        auto& n = lights[scene::light_row(l.kind).id];
        n = n.get<int>() + 1;
    });
    nlohmann::json cameras = nlohmann::json::array();
    s.cameras.each([&](scene::Id<scene::Camera> id, const scene::Camera& c) {
        cameras.push_back({{"name", c.name}, {"active", id == s.active_camera.value}});
    });
    nlohmann::json look_list = nlohmann::json::array();
    for (std::size_t i = 0; i < looks.list.size(); ++i)
        look_list.push_back({{"name", looks.list[i].name}, {"current", i == looks.current}});
    nlohmann::json choices = nlohmann::json::object();
    for (const io::Choices& one : io::choices_of(imported.report))
        choices[one.option] = one.values;
    nlohmann::json report = nlohmann::json::array();
    for (const auto& e : imported.report.entries)
        report.push_back(
            {{"fate", io::to_string(e.fate)}, {"file", e.file}, {"line", e.line}, {"what", e.what}, {"note", e.note}});
    nlohmann::json placeholders = nlohmann::json::array();
    for (const auto& m : scene::missing_things(s))
        placeholders.push_back({{"kind", m.kind}, {"name", m.name}, {"file", m.file}});
    const auto& film = s.film.value;
    return {{"format", s.format},
            {"objects", s.instances.live()},
            {"groups", s.groups.live()},
            {"meshes", s.meshes.live()},
            {"triangles", counted.triangles},
            {"triangles_instanced", counted.instanced},
            {"materials", types},
            {"materials_without_plugin", missing},
            {"textures", s.textures.live()},
            {"images", s.images.live()},
            {"media", s.media.live()},
            {"lights", lights},
            {"lit", document::has_light(s, registry)},
            {"cameras", s.cameras.live()},
            {"camera_list", cameras},
            {"looks", look_list},
            {"choices", choices},
            {"film", {{"width", film.width}, {"height", film.height}, {"exposure", film.exposure}}},
            {"max_depth", s.settings.value.max_depth},
            {"samples", s.settings.value.samples},
            {"memory_bytes", {{"geometry", counted.geometry_bytes}, {"pixels", counted.pixel_bytes}}},
            {"missing", placeholders},
            {"report", report},
            {"report_counts",
             {{"kept", imported.report.count(io::Fate::kept)},
              {"approximated", imported.report.count(io::Fate::approximated)},
              {"dropped", imported.report.count(io::Fate::dropped)}}}};
}

void print(const nlohmann::json& d, const io::Report& report, bool all) {
    const auto n = [&](const char* key) { return d[key].get<std::size_t>(); };
    std::printf("%s\n", d["format"].get<std::string>().c_str());
    std::printf("objects     %zu in %zu groups, %zu meshes, %zu triangles (%zu with instances)\n", n("objects"),
                n("groups"), n("meshes"), n("triangles"), n("triangles_instanced"));
    std::string line;
    for (const auto& [type, count] : d["materials"].items())
        line += fmt::format("{}{} {}", line.empty() ? "" : ", ", count.get<int>(), type);
    std::printf("materials   %s\n", line.c_str());
    for (const auto& name : d["materials_without_plugin"])
        std::printf("            no plugin for %s: shown as a placeholder, kept on export\n",
                    name.get<std::string>().c_str());
    std::printf("textures    %zu, images %zu, media %zu\n", n("textures"), n("images"), n("media"));
    const auto& l = d["lights"];
    std::printf("lights      %d area", l["area"].get<int>());
    for (const scene::LightKindRow& row : scene::light_kinds)
        std::printf(", %d %s", l[row.id].get<int>(), row.id);
    std::printf(", environment: %s\n", l["environment"].get<std::string>().c_str());
    if (!d["lit"].get<bool>()) std::printf("            %s; `restage render --studio` lights it\n", document::no_light);
    line.clear();
    for (std::size_t i = 0; i < d["camera_list"].size(); ++i) { // names and numbers for `render --camera`
        const auto& c = d["camera_list"][i];
        line += fmt::format("{}{} \"{}\"{}", i == 0 ? "" : ", ", i + 1, c["name"].get<std::string>(),
                            c["active"].get<bool>() ? " (active)" : "");
    }
    std::printf("cameras     %s\n", line.c_str());
    line.clear();
    for (const auto& look : d["looks"]) // names for `render --look`
        line += fmt::format("{}\"{}\"{}", line.empty() ? "" : ", ", look["name"].get<std::string>(),
                            look["current"].get<bool>() ? " (current)" : "");
    if (!line.empty()) std::printf("looks       %s\n", line.c_str());
    for (const auto& [option, values] : d["choices"].items()) // for --import-set
        std::printf("%s\n", fmt::format("{:<12}\"{}\"", option + "s",
                                        fmt::join(values.get<std::vector<std::string>>(), "\", \""))
                                .c_str());
    std::printf("film        %dx%d, %zu samples per pixel, paths up to %zu\n", d["film"]["width"].get<int>(),
                d["film"]["height"].get<int>(), n("samples"), n("max_depth"));
    fmt::print("memory      geometry {:.1f} MB, pixels {:.1f} MB\n", d["memory_bytes"]["geometry"].get<double>() * 1e-6,
               d["memory_bytes"]["pixels"].get<double>() * 1e-6);
    for (const auto& m : d["missing"])
        std::printf("missing     %s %s: %s\n", m["kind"].get<std::string>().c_str(),
                    m["name"].get<std::string>().c_str(), m["file"].get<std::string>().c_str());
    std::printf("import      %zu kept, %zu approximated, %zu dropped\n", report.count(io::Fate::kept),
                report.count(io::Fate::approximated), report.count(io::Fate::dropped));
    for (const auto& e : report.entries)
        if (all || e.fate != io::Fate::kept) std::printf("  %s\n", io::to_string(e).c_str());
}

} // namespace

void add_info(CLI::App& program, Context& context) {
    struct Options {
        std::string scene;
        bool json = false, all = false, strict = false;
        std::vector<std::string> import_options;
    };
    auto o = std::make_shared<Options>();
    auto* command =
        program.add_subcommand("info", "Describe a scene, and what its import kept, approximated and dropped");
    command->add_option("SCENE", o->scene, "Scene file or project")->required();
    command->add_flag("--json", o->json, "Print it as JSON");
    add_import_options(*command, o->import_options);
    command->add_flag("--strict", o->strict, strict_help);
    command->add_flag("--all", o->all, "Also list what was kept, not only what was approximated or dropped");
    add_example(*command, "restage info room.pbrt --all");
    command->callback([&context, o] {
        context.choose([&context, o]() -> Result<int> {
            document::Looks looks;
            RESTAGE_TRY(const auto imported, open_scene_with(context, o->scene, o->strict, o->import_options, &looks));
            const auto d = describe(imported, looks, context.registry());
            if (o->json)
                std::printf("%s\n", d.dump(2).c_str());
            else
                print(d, imported.report, o->all);
            return int(exit_ok);
        });
    });
}

} // namespace restage::app
