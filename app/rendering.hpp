// SPDX-License-Identifier: Apache-2.0
// Shared by the commands that render: options of the renderer, opening a scene with progress, rendering to a target,
// and writing the picture.
#pragma once

#include "context.hpp"
#include "document/isolate.hpp"
#include "io/import.hpp"
#include "render/denoise.hpp"
#include "render/renderer.hpp"
#include "view/picture.hpp"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace restage::document {
struct Looks;
}

namespace restage::app {

struct RenderOptions {
    render::RendererOptions renderer;
    std::uint32_t spp = 0; // 0 = the scene's
    double seconds = 0; // > 0: stop then
    bool strict = false; // nothing approximated or dropped
    double error = 0; // > 0: stop at this relative error
    std::string size; // WxH
    std::string denoise; // "", fast, balanced, high
    std::string denoiser; // type or plugin id; "" = the one shipped with the program
    std::string strategy = "mis";
    int max_depth = -1;
    std::string roulette; // "", on, off
    bool spectral = false, adaptive = false; // or the scene's
    std::string guiding, caustics; // "", or one of scene::technique_names
    std::optional<float> clamp_direct, clamp_indirect; // biased; none = the scene's
    std::optional<float> ray_epsilon; // 0 = error bounds
    bool reference = false; // nothing biased
    std::string camera; // its name or number; "" = the active one
    bool studio = false; // add studio light
};

// --tracer, --device, --threads, --validation.
void add_device_options(CLI::App& command, render::RendererOptions& options);
// Those, and all other options of the renderer and targets of a command.
void add_render_options(CLI::App& command, RenderOptions& options);

// For tests: the environment variable RESTAGE_TEST_DEVICE_LOST=AFTER,TIMES, see gpu::DeviceFault; null if unset.
std::shared_ptr<gpu::DeviceFault> device_fault();

// With a progress bar; logs the report's counts.
// According to `--isolate` and its limits; null = scenes are read in this process.
Result<std::shared_ptr<const document::IsolateOptions>> isolate_options(const Context& context);
// `strict`: anything that the import approximates or drops is an error (io/strict.hpp).
// `import_options`: of its importer; for a project they replace the saved ones.
// `looks`: gets those of a project; null = not wanted.
Result<io::ImportedScene> open_scene(Context& context, const std::string& path, bool strict = false,
                                     const std::optional<scene::ParamSet>& import_options = {},
                                     document::Looks* looks = nullptr);
inline constexpr const char* strict_help =
    "Fail if something in the file is approximated or dropped: a missing file, an undefined name ...";

// "640x360" as width and height in pixels; `option` is named in the error.
Result<glm::uvec2> parse_size(const std::string& text, const char* option);

// Applies camera, studio, size, depth and roulette of the options to the scene; reports a scene without light.
Result<void> apply_options(Context& context, const RenderOptions& options, scene::Scene& scene);

double cpu_seconds(); // of all threads of this process, since its start
// The most memory that this program has had at a time [bytes]; 0 = unknown. Not getrusage's, which counts what the
// process was before it became this program.
std::size_t peak_memory();

struct CpuSeconds {
    double first = 0, all = 0; // until the end of the first sample, which waits for shaders; of the last one
    double denoising = 0;
};
// Renders until the target is met or Ctrl-C. `label` precedes the progress.
Result<void> render_to_target(Context& context, const RenderOptions& options, const scene::Scene& scene,
                              render::Renderer& renderer, const std::string& label = "", CpuSeconds* spent = nullptr);

using view::Picture;
// If requested (a missing denoiser is an error).
Result<void> denoise_picture(Context& context, const RenderOptions& options, Picture& picture);
// Reads the film, and denoises it likewise.
Result<Picture> take_picture(Context& context, const RenderOptions& options, const scene::Scene& scene,
                             const render::Renderer& renderer);

using view::check_picture_path;
using view::PictureOptions;
using view::write_picture;

} // namespace restage::app
