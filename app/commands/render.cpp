// SPDX-License-Identifier: Apache-2.0
// restage render SCENE -o out.exr: a scene file becomes a picture.
#include "base/file.hpp"
#include "commands.hpp"
#include "progress.hpp"
#include "rendering.hpp"
#include "scene/validate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

namespace restage::app {
namespace {

struct Options : RenderOptions {
    std::string scene, statistics;
    std::vector<std::string> outputs;
    std::vector<float> crop;           // x0 x1 y0 y1, shares of the film
    std::vector<std::uint32_t> region; // x y width height [pixel]
    PictureOptions picture;
};

// The part of the film that is rendered. Shares are such that Renderer's rounding gives the very pixels back.
Result<void> apply_crop(const Options& o, scene::Scene& scene) {
    if (o.crop.empty() && o.region.empty()) return {};
    scene::Film film = scene.film.value;
    if (!o.crop.empty()) {
        film.crop = {o.crop[0], o.crop[1], o.crop[2], o.crop[3]};
        if (!(film.crop.x >= 0 && film.crop.x < film.crop.y && film.crop.y <= 1 && film.crop.z >= 0 &&
              film.crop.z < film.crop.w && film.crop.w <= 1))
            return fail("--crop: X0 X1 Y0 Y1 are shares of the film, 0 to 1, the first less than the second");
    } else {
        const std::uint32_t x = o.region[0], y = o.region[1], width = o.region[2], height = o.region[3];
        if (width == 0 || height == 0 || x >= film.width || width > film.width - x || y >= film.height ||
            height > film.height - y)
            return fail(fmt::format("--region: {} {} {} {} is empty or not inside of the {}x{} pixels of the film", x, y,
                                    width, height, film.width, film.height));
        // ceil(share * size) is the pixel: half a pixel below it is safe from rounding.
        const auto share = [](std::uint32_t pixel, std::uint32_t size) {
            return pixel == 0 ? 0.f : pixel == size ? 1.f : (float(pixel) - 0.5f) / float(size);
        };
        film.crop = {share(x, film.width), share(x + width, film.width), share(y, film.height),
                     share(y + height, film.height)};
    }
    scene.film = {film, ++scene.clock};
    return {};
}

nlohmann::ordered_json statistics(const Options& o, const render::Renderer& renderer, const Picture& picture,
                                  const std::string& device) {
    const auto& stats = renderer.stats();
    nlohmann::ordered_json dropped = nlohmann::ordered_json::object();
    for (const auto& [type, count] : stats.not_finite)
        dropped[type] = count;
    nlohmann::ordered_json json = {{"scene", o.scene},
                                   {"width", picture.film.width},
                                   {"height", picture.film.height},
                                   {"samples", renderer.samples()},
                                   {"seed", o.renderer.seed},
                                   {"relative_error", nullptr}, // not known with one sample a pixel
                                   {"seconds", stats.seconds},
                                   {"seconds_shading", stats.seconds_shading},
                                   {"seconds_tracing", stats.seconds_tracing},
                                   {"rays", stats.rays},
                                   {"shadow_rays", stats.shadow_rays},
                                   {"not_finite", dropped},
                                   {"dropped", stats.dropped},
                                   {"denoiser", picture.denoiser},
                                   {"tracer", renderer.tracer_name()},
                                   {"device", device}};
    if (renderer.samples() > 1) json["relative_error"] = renderer.relative_error();
    return json;
}

Result<int> run(Context& context, Options& o) {
    for (const std::string& output : o.outputs)
        RESTAGE_CHECK(check_picture_path(output));
    if (auto known = session::check_aovs(o.picture.aovs); !known) return fail("--aov", known.error());
    if (!o.denoise.empty() || !o.denoiser.empty())
        RESTAGE_CHECK(render::choose_denoiser(context.registry(), o.denoiser)); // before hours are spent
    RESTAGE_TRY(auto imported, open_scene(context, o.scene, o.strict));
    scene::Scene& scene = imported.scene;
    if (!scene.active_camera.value) // importers make one up; a project may have none yet
        return fail(o.scene + ": " + scene::no_camera + "; add one to the scene it began with");
    RESTAGE_CHECK(apply_options(context, o, scene));
    RESTAGE_CHECK(apply_crop(o, scene));
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
                          {"restage:denoiser", picture.denoiser}}; // no times: equal renders are equal files
    for (const std::string& output : o.outputs)
        RESTAGE_CHECK(write_picture(output, picture, o.picture));
    const std::string device = renderer->device().info().name;
    if (!o.statistics.empty()) {
        const std::string text = statistics(o, *renderer, picture, device).dump(2) + "\n";
        if (o.statistics == "-")
            std::fputs(text.c_str(), stdout);
        else
            RESTAGE_CHECK(write_file_atomic(o.statistics, text));
    }
    const std::string error = renderer->samples() > 1 ? fmt::format("relative error {:.4f}", renderer->relative_error())
                                                      : "error not known with one sample";
    context.log.info(fmt::format("{}: {}x{}, {} spp in {:.2f} s, {}, {:.2f} Mray/s, {} on {}",
                                 fmt::join(o.outputs, ", "), picture.film.width, picture.film.height,
                                 renderer->samples(), stats.seconds, error, rays / std::max(stats.seconds, 1e-9) * 1e-6,
                                 renderer->tracer_name(), device));
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
        ->add_option("-o,--output", o->outputs,
                     "Picture: .exr (linear; standard error, guides and settings inside), .png or .jpg (8-bit sRGB), "
                     ".pfm or .hdr; may be repeated")
        ->required()
        ->allow_extra_args(false);
    auto* crop = command->add_option("--crop", o->crop, "Render this part of the film only: shares from 0 to 1")
                     ->expected(4)
                     ->type_name("X0 X1 Y0 Y1");
    command->add_option("--region", o->region, "The same in pixels, from the upper left corner")
        ->expected(4)
        ->type_name("X Y WIDTH HEIGHT")
        ->excludes(crop);
    command->add_option("--statistics", o->statistics, "Write time, rays, samples and error as JSON (- = stdout)")
        ->type_name("FILE");
    command->add_flag("--strict", o->strict, strict_help);
    add_render_options(*command, *o);
    command->add_option("--aov", o->picture.aovs, "Layers of an .exr: stderr,albedo,normal,depth,id, or all, or none")
        ->capture_default_str();
    command->add_option("--exposure", o->picture.exposure_stops, "Exposure of a .png or .jpg [stops]")->capture_default_str();
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
