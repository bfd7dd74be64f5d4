// SPDX-License-Identifier: Apache-2.0
// restage render SCENE -o out.exr: renders a scene file to a picture.
#include "base/file.hpp"
#include "base/version.hpp"
#include "commands.hpp"
#include "developing.hpp"
#include "document/assign.hpp"
#include "frames.hpp"
#include "import_options.hpp"
#include "progress.hpp"
#include "render/film_error.hpp"
#include "rendering.hpp"
#include "scene/development.hpp"
#include "scene/projection.hpp"
#include "scene/validate.hpp"
#include "standard_streams.hpp"
#include "variants.hpp"
#include "view/merge_pictures.hpp"
#include "view/video.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace restage::app {
namespace {

struct Options : RenderOptions {
    std::string scene, statistics;
    std::vector<std::string> outputs;
    std::string format;                   // of a scene on stdin; "" = pbrt
    std::string frames;                   // "1-24"; "" = the one scene
    std::string look;                     // its name, or "all"; "" = the scene as it is
    CameraMove move;
    std::uint32_t move_frame = 0;         // of it, from 1
    double fps = 30;                      // of videos
    std::vector<std::string> import_options; // "up=z"
    std::vector<std::string> assignments; // "Wall paint.reflectance=0.2"
    std::uint32_t first_sample = 0;
    std::string resume;                // the picture to continue
    std::vector<float> crop;           // x0 x1 y0 y1, fractions of the film
    std::vector<std::uint32_t> region; // x y width height [pixel]
    PictureOptions picture;
    DevelopmentOptions development;
};

// The part of the film to render. The fractions are such that Renderer's rounding yields exactly these pixels.
Result<void> apply_crop(const Options& o, scene::Scene& scene) {
    if (o.crop.empty() && o.region.empty()) return {};
    scene::Film film = scene.film.value;
    if (!o.crop.empty()) {
        film.crop = {o.crop[0], o.crop[1], o.crop[2], o.crop[3]};
        if (!(film.crop.x >= 0 && film.crop.x < film.crop.y && film.crop.y <= 1 && film.crop.z >= 0 &&
              film.crop.z < film.crop.w && film.crop.w <= 1))
            return fail(
                "--crop: X0 X1 Y0 Y1 are fractions of the film, 0 to 1, the first of each pair less than the second");
    } else {
        const std::uint32_t x = o.region[0], y = o.region[1], width = o.region[2], height = o.region[3];
        if (width == 0 || height == 0 || x >= film.width || width > film.width - x || y >= film.height ||
            height > film.height - y)
            return fail(fmt::format("--region: {} {} {} {} is empty or not inside the {}x{} pixels of the film", x, y,
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

nlohmann::ordered_json statistics(const Options& o, render::Renderer& renderer, const Picture& picture,
                                  double relative_error, const CpuSeconds& spent) {
    const auto& stats = renderer.stats();
    nlohmann::ordered_json dropped = nlohmann::ordered_json::object();
    for (const auto& [type, count] : stats.not_finite)
        dropped[type] = count;
    nlohmann::ordered_json json = {{"scene", o.scene},
                                   {"width", picture.film.width},
                                   {"height", picture.film.height},
                                   {"samples", picture.film.samples},
                                   {"seed", o.renderer.seed},
                                   {"relative_error", nullptr}, // unknown with one sample per pixel
                                   {"seconds", stats.seconds},
                                   {"seconds_shading", stats.seconds_shading},
                                   {"seconds_tracing", stats.seconds_tracing},
                                   {"cpu_seconds", spent.all},
                                   {"cpu_seconds_first", spent.first},
                                   {"cpu_seconds_denoising", spent.denoising},
                                   {"peak_memory", peak_memory()},
                                   {"rays", stats.rays},
                                   {"shadow_rays", stats.shadow_rays},
                                   {"not_finite", dropped},
                                   {"dropped", stats.dropped},
                                   {"denoiser", picture.denoiser},
                                   {"shader_bytes", stats.shader_bytes},
                                   {"scene_bytes", renderer.gpu_scene().bytes()},
                                   {"tracer", renderer.tracer_name()},
                                   {"device", renderer.device().info().name}};
    if (picture.film.samples > 1) json["relative_error"] = relative_error;
    return json;
}

// The options' changes, made through a session as in the editor.
Result<void> apply_assignments(Context& context, const Options& o, scene::Scene& scene) {
    if (o.assignments.empty()) return {};
    document::Session session(context.registry());
    session.adopt(scene);
    for (const std::string& assignment : o.assignments)
        if (auto done = document::assign(session, assignment); !done) return fail("--set", done.error());
    scene = session.scene();
    return {};
}

using Metadata = std::map<std::string, std::string>;
Metadata what_is_rendered(const Options& o, const scene::Scene& scene) { // as compared by same_render
    std::string changes = fmt::format("{}", fmt::join(o.assignments, "; "));
    for (const std::string& option : o.import_options)
        changes += (changes.empty() ? "import " : "; import ") + option;
    if (!o.look.empty()) changes += " --look " + o.look;
    if (!o.camera.empty()) changes += " --camera " + o.camera;
    if (const std::string moved = o.move.what(o.move_frame); !moved.empty()) changes += " " + moved;
    if (o.studio) changes += " --studio";
    if (!o.development.background.empty()) changes += " --background"; // the sky is hidden
    return {{"restage:scene", o.scene == "-" ? "stdin" : std::filesystem::path(o.scene).filename().string()},
            {"restage:changes", changes},
            {"restage:strategy", o.strategy},
            {"restage:max_depth", std::to_string(scene.settings.value.max_depth)}};
}

// Start and number of the new samples if the picture already has some.
Result<void> go_on(Options& o, const view::StoredPicture& before, const scene::Scene& scene) {
    if (auto same = view::same_render(what_is_rendered(o, scene), before.metadata); !same)
        return fail("--resume " + o.resume + " " + same.error().message);
    const scene::Film& film = scene.film.value;
    const glm::uvec4 window = scene::crop_window(film);
    const std::uint32_t width = window.y - window.x, height = window.w - window.z;
    if (width != before.film.width || height != before.film.height)
        return fail(fmt::format("--resume {}: has {}x{} pixels, not {}x{}; give {}", o.resume, before.film.width,
                                before.film.height, width, height,
                                width == film.width && height == film.height
                                    ? fmt::format("--size {}x{}", before.film.width, before.film.height)
                                    : "the --size and the --crop or --region with which it was rendered"));
    const std::uint32_t target = o.spp ? o.spp : scene.settings.value.samples ? scene.settings.value.samples : 64;
    for (const view::SampleRange& range : before.ranges)
        if (range.seed == o.renderer.seed) o.first_sample = std::max(o.first_sample, range.first + range.count);
    if (o.seconds > 0) return {};
    if (before.film.samples >= target)
        return fail(fmt::format("--resume {}: has {} samples per pixel already; give a larger --spp", o.resume,
                                before.film.samples));
    o.spp = target - before.film.samples;
    return {};
}

Metadata metadata_of(const Options& o, render::Renderer& renderer, const scene::Scene& scene) {
    const view::SampleRange range[] = {{o.renderer.seed, o.first_sample, renderer.most_samples()}};
    Metadata metadata = what_is_rendered(o, scene);
    metadata.merge(Metadata{{"restage:version", version()},
                            {"restage:device", renderer.device().info().name},
                            {"restage:tracer", renderer.tracer_name()},
                            {"restage:samples", std::to_string(renderer.samples())},
                            {"restage:seed", std::to_string(o.renderer.seed)},
                            {"restage:ranges", view::to_text(range)}}); // no times: equal renders are equal
    return metadata;
}

// Adds the picture's samples to those of `before`.
Result<void> add_to(const view::StoredPicture& before, Picture& picture, Metadata& metadata, std::uint32_t first,
                    std::uint32_t seed) {
    const auto names = view::aov_names();
    view::StoredPicture now{
        .film = std::move(picture.film), .layers = {names.begin(), names.end()}, .metadata = metadata, .ranges = {}};
    now.ranges = {{seed, first, now.film.samples}};
    now.film.expose(std::exchange(picture.exposure, 1.f)); // files contain it
    const view::StoredPicture both[] = {before, std::move(now)};
    RESTAGE_TRY(auto merged, view::merge_pictures(both));
    picture.film = std::move(merged.film);
    metadata = std::move(merged.metadata);
    return {};
}

Result<void> write(const std::vector<std::string>& paths, const Picture& picture, const PictureOptions& options) {
    for (const std::string& path : paths) {
        RESTAGE_TRY(const Output output, Output::create(path));
        RESTAGE_CHECK(write_picture(output.path(), picture, options));
        RESTAGE_CHECK(output.finish());
    }
    return {};
}

using RendererPointer = std::unique_ptr<render::Renderer>;

Result<int> render_scene(Context& context, Options o, scene::Scene scene, RendererPointer& renderer) {
    if (!scene.active_camera.value) // importers add one; a project may have none yet
        return fail(o.scene + ": " + scene::no_camera + "; add one to its original scene");
    RESTAGE_CHECK(apply_assignments(context, o, scene));
    RESTAGE_CHECK(apply_options(context, o, scene));
    RESTAGE_CHECK(move_camera(scene, o.move, o.move_frame));
    RESTAGE_CHECK(apply_background(o.development, scene));
    RESTAGE_CHECK(apply_crop(o, scene));
    std::optional<view::StoredPicture> before;
    if (!o.resume.empty()) {
        RESTAGE_TRY(before, view::read_picture(o.resume));
        RESTAGE_CHECK(go_on(o, *before, scene));
    }
    if (o.first_sample > 0) scene.settings.value.adaptive = false; // other samples are to be added to these
    if (!renderer) {
        RESTAGE_TRY(renderer,
                    render::Renderer::create(o.renderer, render::material_lookup(context.registry()), context.log));
    }
    renderer->forget_scene();
    renderer->reset_stats();
    renderer->restart(o.renderer.seed, o.first_sample);
    CpuSeconds spent;
    RESTAGE_CHECK(render_to_target(context, o, scene, *renderer, "", &spent));
    if (before && renderer->samples() == 0) return interrupt_exit_code(); // the resumed file is unchanged
    o.picture.metadata = metadata_of(o, *renderer, scene);
    const scene::Film& film = scene.film.value;
    Picture picture{.film = renderer->image(),
                    .denoised = {},
                    .exposure = film.exposure,
                    .development = o.development.over(scene::development_of(scene)),
                    .window = film.crop};
    if (before) RESTAGE_CHECK(add_to(*before, picture, o.picture.metadata, o.first_sample, o.renderer.seed));
    spent.denoising = -cpu_seconds();
    RESTAGE_CHECK(denoise_picture(context, o, picture));
    spent.denoising += cpu_seconds();
    o.picture.metadata["restage:denoiser"] = picture.denoiser;
    RESTAGE_CHECK(write(o.outputs, picture, o.picture));

    const auto& stats = renderer->stats();
    const double relative_error = render::relative_error(picture.film);
    if (!o.statistics.empty()) {
        const std::string text = statistics(o, *renderer, picture, relative_error, spent).dump(2) + "\n";
        if (o.statistics == "-")
            std::fputs(text.c_str(), stdout);
        else
            RESTAGE_CHECK(write_file_atomic(o.statistics, text));
    }
    const std::string error = picture.film.samples > 1 ? fmt::format("relative error {:.4f}", relative_error)
                                                       : "error unknown with one sample";
    context.log.info(fmt::format("{}: {}x{}, {} spp in {:.2f} s, {}, {:.2f} Mray/s, {} on {}",
                                 fmt::join(o.outputs, ", "), picture.film.width, picture.film.height,
                                 picture.film.samples, stats.seconds, error,
                                 double(stats.rays + stats.shadow_rays) / std::max(stats.seconds, 1e-9) * 1e-6,
                                 renderer->tracer_name(), renderer->device().info().name));
    context.log.debug(fmt::format("rays {}, shadow rays {}, shading {:.2f} s, tracing {:.2f} s, shaders {} KiB",
                                  stats.rays, stats.shadow_rays, stats.seconds_shading, stats.seconds_tracing,
                                  stats.shader_bytes / 1024));
    return interrupted() ? interrupt_exit_code() : int(exit_ok); // the picture is written
}

// The scene's picture, or one for each look and camera.
Result<int> render_frame(Context& context, const Options& o, RendererPointer& renderer) {
    std::optional<TemporaryFile> piped;
    if (o.scene == "-") {
        RESTAGE_TRY(auto file, scene_from_stdin(o.format.empty() ? "pbrt" : o.format));
        piped.emplace(std::move(file));
    }
    document::Looks looks;
    RESTAGE_TRY(auto imported,
                open_scene_with(context, piped ? piped->path().string() : o.scene, o.strict, o.import_options, &looks));
    RESTAGE_TRY(const auto list, variants(imported.scene, looks, o.look, o.camera, o.move));
    for (const std::string& path : o.outputs)
        if (auto good = check_variant_paths(path, list); !good) return fail("-o", good.error());
    if (!o.statistics.empty() && o.statistics != "-")
        if (auto good = check_variant_paths(o.statistics, list); !good) return fail("--statistics", good.error());
    int code = exit_ok;
    std::map<std::string, view::VideoFrames> videos;
    for (const Variant& variant : list) {
        Options one = o;
        one.look = variant.look;
        one.camera = variant.camera;
        one.move_frame = variant.frame;
        for (std::string& path : one.outputs) {
            path = variant_path(path, variant);
            if (!view::is_video_path(path)) continue;
            auto video = videos.find(path);
            if (video == videos.end()) {
                RESTAGE_TRY(auto frames, view::VideoFrames::create());
                video = videos.emplace(path, std::move(frames)).first;
            }
            path = video->second.next();
        }
        for (std::string* path : {&one.statistics, &one.resume})
            *path = variant_path(*path, variant);
        const document::Look* look = looks.find(variant.look);
        RESTAGE_TRY(code, render_scene(context, std::move(one),
                                       look ? document::with_look(imported.scene, *look) : imported.scene, renderer));
        if (interrupted()) break;
    }
    for (const auto& [path, frames] : videos) { // of the frames so far, if it was interrupted
        RESTAGE_CHECK(frames.write(path, o.fps));
        context.log.info(path + " was written");
    }
    return code;
}

// Problems with the options, before hours are spent.
Result<void> check(Context& context, const Options& o) {
    std::ptrdiff_t to_stdout = o.statistics == "-";
    for (const std::string& text : o.outputs) {
        RESTAGE_TRY(const Output output, Output::create(text));
        if (view::is_video_path(text)) {
            if (o.move.frames() == 0) return fail("-o " + text + ": a video needs --turntable or --camera-path");
            if (auto possible = view::VideoFrames::create(); !possible) return fail("-o " + text, possible.error());
            continue;
        }
        RESTAGE_CHECK(check_picture_path(output.path()));
        to_stdout += output.to_stdout();
    }
    if (auto good = check_file_path(o.statistics); !good) return fail("--statistics", good.error());
    std::vector<std::string> files = o.outputs;
    if (!o.statistics.empty()) files.push_back(o.statistics);
    std::sort(files.begin(), files.end());
    if (const auto twice = std::adjacent_find(files.begin(), files.end()); twice != files.end() && *twice != "-")
        return fail("-o, --statistics: " + *twice + " would be written twice");
    if (to_stdout > 1) return fail("-o, --statistics: only one of them can go to stdout");
    if (auto known = view::check_aovs(o.picture.aovs); !known) return fail("--aov", known.error());
    if (!o.denoise.empty() || !o.denoiser.empty())
        RESTAGE_CHECK(render::choose_denoiser(context.registry(), o.denoiser));
    if (!o.format.empty() && o.scene != "-")
        return fail("--format is for a scene on stdin (-); a file's format follows from the file");
    if (o.frames.empty()) return {};
    if (o.scene.find('#') == std::string::npos)
        return fail("--frames: mark the number in the scene's name with #, for example shot.####.pbrt");
    for (const std::string& text : o.outputs)
        if (text.find('#') == std::string::npos && text != "-" && !text.ends_with(":-"))
            return fail("--frames: -o " + text + " would be overwritten by each frame; mark the number with #");
    return {};
}

Result<int> run(Context& context, Options& o) {
    RESTAGE_CHECK(check(context, o));
    o.renderer.strategy = o.strategy == "light"  ? render::Strategy::light_only
                          : o.strategy == "bsdf" ? render::Strategy::bsdf_only
                                                 : render::Strategy::mis;
    o.renderer.fault = device_fault();
    RendererPointer renderer;
    if (o.frames.empty()) return render_frame(context, o, renderer);
    RESTAGE_TRY(const auto frames, parse_frames(o.frames));
    int code = exit_ok;
    for (const std::uint32_t frame : frames) {
        Options one = o;
        for (std::string* path : {&one.scene, &one.resume, &one.statistics})
            *path = frame_path(*path, frame);
        for (std::string& path : one.outputs)
            path = frame_path(path, frame);
        RESTAGE_TRY(code, render_frame(context, one, renderer));
        if (interrupted()) break;
    }
    return code;
}

} // namespace

void add_render(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    auto* command = program.add_subcommand("render", "Path-trace a scene to a picture");
    command->add_option("SCENE", o->scene, "Scene file or project; - = stdin")->required();
    command
        ->add_option("-o,--output", o->outputs,
                     "Picture: .exr (linear; standard error, guides and settings inside), .png or .jpg (8-bit sRGB), "
                     ".pfm or .hdr; - = stdout as .exr, png:- as .png; may be repeated")
        ->required()
        ->allow_extra_args(false);
    command->add_option("--format", o->format, "Format of a scene on stdin, as a file extension (default: pbrt)");
    command
        ->add_option(
            "--frames", o->frames,
            "Render one scene file per frame: 7, 1-24, 1-24x2 (every second) or 1-3,9; the number replaces the # in "
            "SCENE and -o, for example shot.####.pbrt -o shot.####.png")
        ->type_name("FRAMES");
    command
        ->add_option("--look", o->look,
                     "A look of a project, as `restage info` lists them, or all: each is one picture, and {look} in -o "
                     "is its name, for example -o \"{look}.png\". Likewise --camera all and {camera}")
        ->type_name("NAME");
    auto* turntable =
        command
            ->add_option("--turntable", o->move.turntable,
                         "Render this many frames of one turn around the scene, with a number in place of # in -o: "
                         "-o turn.####.png; or a video, which needs ffmpeg: -o turn.mp4 (.webm, .mov, .mkv, .gif)")
            ->type_name("FRAMES")
            ->check(CLI::Range(1u, 100000u));
    command
        ->add_option("--camera-path", o->move.path,
                     "Likewise the way through all cameras of the scene, in its order, smoothly and each stretch in "
                     "the same time")
        ->type_name("FRAMES")
        ->check(CLI::Range(2u, 100000u))
        ->excludes(turntable);
    command->add_option("--fps", o->fps, "Frames of a video in a second")
        ->check(CLI::Range(0.1, 1000.0))
        ->capture_default_str();
    command
        ->add_option("--set", o->assignments,
                     "Change the scene: \"Wall paint.reflectance=0.1,0.2,0.3\", Chair.material=oak, Lamp.value=40, "
                     "film.exposure=2, sky.rotation=90 ... (may be repeated)")
        ->type_name("NAME.FIELD=VALUE")
        ->allow_extra_args(false);
    add_import_options(*command, o->import_options);
    auto* resume =
        command->add_option("--resume", o->resume, "Continue this .exr: --spp includes its samples, --time does not")
            ->type_name("EXR");
    command
        ->add_option(
            "--first-sample", o->first_sample,
            "Number of the first sample of each pixel, to render in parts: parts with one seed and no sample in "
            "common merge into the whole render with `restage merge`")
        ->capture_default_str();
    auto* crop = command
                     ->add_option("--crop", o->crop,
                                  "Render this part of the film only, as fractions from the upper left corner: 0 "
                                  "0.5 0 1 is the left half")
                     ->expected(4)
                     ->type_name("X0 X1 Y0 Y1");
    command
        ->add_option("--region", o->region, "Render this part of the film only, in pixels from the upper left corner")
        ->expected(4)
        ->type_name("X Y WIDTH HEIGHT")
        ->excludes(crop);
    command->add_option("--statistics", o->statistics, "Write time, rays, samples and error as JSON (- = stdout)")
        ->type_name("FILE");
    command->add_flag("--strict", o->strict, strict_help);
    // For tests/bench/needs.py, not for users: not in --help.
    command->add_flag("--all-features", o->renderer.all_features)->group("");
    add_render_options(*command, *o);
    resume->excludes(command->get_option("--error"));
    command
        ->add_option("--aov", o->picture.aovs,
                     fmt::format("Layers of an .exr: all, none, or some of {}", fmt::join(view::aov_names(), ",")))
        ->capture_default_str();
    command->add_option("--exposure", o->picture.exposure_stops, "Brighten a .png or .jpg [stops]")
        ->check(CLI::Range(-64.f, 64.f))
        ->capture_default_str();
    add_background_option(*command, o->development);
    add_development_options(*command, o->development, "the project's, or srgb");
    add_example(*command, "restage render room.pbrt -o room.exr -o room.png --spp 256 --denoise");
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
