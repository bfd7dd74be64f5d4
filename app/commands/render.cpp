// SPDX-License-Identifier: Apache-2.0
// restage render SCENE -o out.exr: a scene file becomes a picture.
#include "commands.hpp"
#include "progress.hpp"
#include "rendering.hpp"
#include "scene/validate.hpp"

#include <fmt/format.h>
#include <memory>

namespace restage::app {
namespace {

struct Options : RenderOptions {
    std::string scene, output;
    PictureOptions picture;
};

Result<int> run(Context& context, Options& o) {
    RESTAGE_CHECK(check_picture_path(o.output));
    RESTAGE_TRY(auto imported, open_scene(context, o.scene, o.strict));
    scene::Scene& scene = imported.scene;
    if (!scene.active_camera.value) // importers make one up; a project may have none yet
        return fail(o.scene + ": " + scene::no_camera + "; add one to the scene it began with");
    RESTAGE_CHECK(apply_options(context, o, scene));
    o.renderer.strategy = o.strategy == "light"  ? render::Strategy::light_only
                          : o.strategy == "bsdf" ? render::Strategy::bsdf_only
                                                 : render::Strategy::mis;
    o.renderer.fault = device_fault();
    RESTAGE_TRY(const auto renderer,
                render::Renderer::create(o.renderer, render::material_lookup(context.registry()), context.log));
    RESTAGE_CHECK(render_to_target(context, o, scene, *renderer));
    RESTAGE_TRY(const auto picture, take_picture(context, o, scene, *renderer));

    const auto& stats = renderer->stats();
    const double rays = double(stats.rays + stats.shadow_rays);
    o.picture.metadata = {{"restage:version", RESTAGE_VERSION},
                          {"restage:scene", std::filesystem::path(o.scene).filename().string()},
                          {"restage:device", renderer->device().info().name},
                          {"restage:tracer", renderer->tracer_name()},
                          {"restage:samples", std::to_string(renderer->samples())},
                          {"restage:seed", std::to_string(o.renderer.seed)},
                          {"restage:strategy", o.strategy},
                          {"restage:max_depth", std::to_string(scene.settings.value.max_depth)},
                          {"restage:denoiser", o.denoise.empty() ? "none" : "oidn " + o.denoise},
                          {"restage:seconds", fmt::format("{:.3f}", stats.seconds)}};
    RESTAGE_CHECK(write_picture(o.output, picture, o.picture));
    context.log.info(fmt::format("{}: {}x{}, {} spp in {:.2f} s, relative error {:.4f}, {:.2f} Mray/s, {} on {}",
                                 o.output, picture.film.width, picture.film.height, renderer->samples(), stats.seconds,
                                 renderer->relative_error(), rays / std::max(stats.seconds, 1e-9) * 1e-6,
                                 renderer->tracer_name(), renderer->device().info().name));
    context.log.debug(fmt::format("rays {}, shadow rays {}, shading {:.2f} s, tracing {:.2f} s, shaders {} KiB",
                                  stats.rays, stats.shadow_rays, stats.seconds_shading, stats.seconds_tracing,
                                  stats.shader_bytes / 1024));
    return interrupted() ? interrupt_exit_code() : int(exit_ok); // the picture is written
}

} // namespace

void add_render(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    auto* command = program.add_subcommand("render", "Path-trace a scene into a picture");
    command->add_option("SCENE", o->scene, "Scene file")->required();
    command
        ->add_option(
            "-o,--output", o->output,
            "Picture: .exr (linear; standard error, guides and settings inside), .png (8-bit sRGB), .pfm or .hdr")
        ->required();
    command->add_flag("--strict", o->strict, strict_help);
    add_render_options(*command, *o);
    command->add_option("--aov", o->picture.aovs, "Layers of an .exr: stderr,albedo,normal,depth,id, or all, or none")
        ->capture_default_str();
    command->add_option("--exposure", o->picture.exposure_stops, "Exposure of a .png [stops]")->capture_default_str();
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
