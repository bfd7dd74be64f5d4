// SPDX-License-Identifier: Apache-2.0
// restage demo: the main job without a window. Opens the bundled scene, edits it through the editor's Session,
// renders before and after, denoises, writes the edited scene as pbrt, and reads it back to check that it is
// the same.
#include "base/file.hpp"
#include "commands.hpp"
#include "document/session.hpp"
#include "io/scene_compare.hpp"
#include "progress.hpp"
#include "rendering.hpp"

#include <fmt/format.h>
#include <cstdio>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

namespace restage::app {
namespace {

struct Options : RenderOptions {
    std::string folder = "restage-demo";
    std::string scene; // empty = the bundled one
};

using Instances = std::vector<scene::Id<scene::Instance>>;

// The objects a user would click: everything in the groups of this name, in file order.
Result<std::vector<Instances>> objects(const scene::Scene& s, std::string_view name) {
    std::vector<Instances> found;
    s.groups.each([&](scene::Id<scene::Group> id, const scene::Group& group) {
        if (group.name != name && !(group.name.starts_with(name) && group.name.substr(name.size()).starts_with(" ")))
            return;
        Instances parts;
        s.instances.each([&](scene::Id<scene::Instance> i, const scene::Instance& instance) {
            if (instance.group == id) parts.push_back(i);
        });
        if (!parts.empty()) found.push_back(std::move(parts));
    });
    if (found.empty()) return fail(fmt::format("the demo scene has no object \"{}\"", name));
    return found;
}

// Each line corresponds to one gesture in the desktop editor, and is one undo step.
Result<std::vector<std::string>> restage_room(document::Session& session) {
    std::vector<std::string> log;
    const auto done = [&](std::string text) { log.push_back(std::move(text)); };
    const auto& s = session.scene();

    const auto paint = session.find<scene::Material>("Wall paint");
    RESTAGE_CHECK(session.set_param(paint, "reflectance", scene::Value::color(0.07f, 0.17f, 0.19f)));
    done("the back wall repainted teal");
    const auto wool = session.find<scene::Material>("Cushion wool");
    RESTAGE_CHECK(session.set_param(wool, "reflectance", scene::Value::color(0.60f, 0.33f, 0.06f)));
    done("all cushions in mustard");

    RESTAGE_TRY(const auto chairs, objects(s, "Chair"));
    const glm::dmat4 there = glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(2.81, -1.40, 0.013)),
                                         glm::radians(96.0), glm::dvec3(0, 0, 1));
    const glm::dmat4 here = s.instances[chairs[0][0]].object_to_world;
    RESTAGE_CHECK(session.duplicate(chairs[0], there * glm::affineInverse(here)));
    done("a fourth chair, a copy of the first, at the right of the table");

    RESTAGE_TRY(const auto vases, objects(s, "Vase"));
    RESTAGE_CHECK(session.remove(vases[0]));
    done("the vase removed");
    RESTAGE_TRY(const auto books, objects(s, "Red book"));
    RESTAGE_CHECK(session.move(books[0], glm::translate(glm::dmat4(1), glm::dvec3(0, -0.02, 0))));
    done("a book pulled forward");
    RESTAGE_TRY(const auto lacquer, session.add_material("White lacquer", "coateddiffuse"));
    RESTAGE_CHECK(session.set_param(lacquer, "reflectance", scene::Value::color(0.72f, 0.70f, 0.66f)));
    RESTAGE_CHECK(session.set_param(lacquer, "uroughness", scene::Value::number(0.05f)));
    RESTAGE_CHECK(session.set_param(lacquer, "vroughness", scene::Value::number(0.05f)));
    RESTAGE_TRY(const auto tables, objects(s, "Table"));
    RESTAGE_CHECK(session.set_material(tables[0], lacquer));
    done("the table in white lacquer");
    return log;
}

Result<int> run(Context& context, Options& o) {
    if (o.scene.empty()) {
        RESTAGE_TRY(const auto bin, executable_dir());
        o.scene = (bin.parent_path() / "share/restage/scenes/demo/demo.pbrt").string();
    }
    const std::filesystem::path folder = o.folder;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        return fail(fmt::format("{}: cannot be created: {}; choose another folder with -o", o.folder, error.message()));

    document::Session session(context.registry());
    catch_interrupts();
    {
        ProgressBar bar(context.quiet);
        document::ReadOptions options;
        options.progress = [&](float done, std::string_view what) {
            bar.show(done, std::string(what));
            return !interrupted();
        };
        RESTAGE_CHECK(session.open(o.scene, options));
    }
    RESTAGE_TRY(const auto renderer,
                render::Renderer::create(o.renderer, render::material_lookup(context.registry()), context.log));
    std::printf("opened    %s: %u objects, %u materials\n", o.scene.c_str(), session.scene().instances.live(),
                session.scene().materials.live());
    std::printf("renders   with the %s tracer on %s\n", renderer->tracer_name(),
                renderer->device().info().name.c_str());

    const auto picture = [&](const char* name) -> Result<void> {
        scene::Scene shown = session.scene(); // with this command's size; the document keeps its own
        RESTAGE_CHECK(apply_options(context, o, shown));
        renderer->forget_scene();
        RESTAGE_CHECK(render_to_target(context, o, shown, *renderer, std::string(name) + ": "));
        RESTAGE_TRY(const auto taken, take_picture(context, o, shown, *renderer));
        const auto file = folder / (std::string(name) + ".png");
        RESTAGE_CHECK(write_picture(file.string(), taken, {}));
        RESTAGE_CHECK(write_picture((folder / (std::string(name) + ".exr")).string(), taken, {}));
        std::printf("%-9s %s (%u spp%s)\n", name, file.string().c_str(), renderer->samples(),
                    taken.denoised ? ", denoised" : "");
        return {};
    };
    // Without a denoiser the demo runs without denoising.
    if (!o.denoise.empty()) {
        if (const auto chosen = render::choose_denoiser(context.registry(), o.denoiser); !chosen) {
            context.log.warning("pictures stay noisy: " + chosen.error().message);
            o.denoise.clear();
        }
    }
    RESTAGE_CHECK(picture("before"));
    if (interrupted()) return interrupt_exit_code();

    RESTAGE_TRY(const auto gestures, restage_room(session));
    for (const auto& line : gestures)
        std::printf("edit      %s\n", line.c_str());
    RESTAGE_CHECK(picture("after"));
    if (interrupted()) return interrupt_exit_code();

    const auto file = (folder / "edited.pbrt").string();
    RESTAGE_TRY(const auto report, session.export_to(file));
    for (const auto& entry : report.entries)
        if (entry.fate != io::Fate::kept) context.log.warning(io::to_string(entry));
    RESTAGE_TRY(const auto again, io::import_scene(file, context.registry()));
    const auto differences = io::structural_differences(session.scene(), again.scene, context.registry());
    std::printf("exported  %s (pbrt-v4; read back: %s)\n", file.c_str(),
                differences.empty() ? "the same scene" : "DIFFERS");
    for (const auto& line : differences)
        std::printf("          %s\n", line.c_str());
    while (session.undo()) {
    }
    std::printf("undo      %s\n",
                session.modified() ? "did NOT lead back" : "leads back to the scene as it was opened");
    return differences.empty() && !session.modified() ? int(exit_ok) : int(exit_failed);
}

} // namespace

void add_demo(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    o->spp = 32;
    o->size = "640x360";
    o->denoise = "high";
    auto* command = program.add_subcommand(
        "demo",
        "Restage the bundled room: open, edit, render before and after, export; with 32 samples per pixel, at "
        "640x360 and denoised unless options say otherwise");
    command->add_option("-o,--output", o->folder, "Folder for the pictures and the edited scene")
        ->capture_default_str();
    command->add_option("--scene", o->scene, "Another scene with the demo's objects");
    add_render_options(*command, *o);
    add_example(*command, "restage demo -o demo --spp 8 --size 320x180");
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
