// SPDX-License-Identifier: Apache-2.0
// restage convert IN OUT: a scene, or a picture, from one format to another.
#include "commands.hpp"
#include "import_options.hpp"
#include "io/exr.hpp"
#include "io/image_file.hpp"
#include "io/strict.hpp"
#include "rendering.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>

namespace restage::app {
namespace {

struct Options {
    std::string input, output, format;
    std::vector<std::string> assignments, import_options;
    bool strict = false;
    float exposure = 0; // of a picture [stops]
};

bool is_picture(const std::string& path) {
    static constexpr std::string_view known[] = {".exr", ".png", ".jpg", ".jpeg", ".pfm",
                                                 ".hdr", ".tga", ".bmp", ".webp"};
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return std::find(std::begin(known), std::end(known), extension) != std::end(known);
}

// Layers of an EXR besides the picture itself, which conversion omits.
std::string other_layers(const std::string& path) {
    const auto image = io::read_exr(path);
    std::string names;
    for (const io::ExrLayer& layer : image ? image->layers : std::vector<io::ExrLayer>())
        if (!layer.name.empty()) names += (names.empty() ? "" : ", ") + layer.name;
    return names;
}

Result<int> convert_picture(Context& context, const Options& o) {
    if (!o.format.empty() || !o.assignments.empty() || !o.import_options.empty() || o.strict)
        return fail("--format, --set, --import-set and --strict are for scenes, not for pictures");
    if (!is_picture(o.output)) return fail(o.output + ": a picture is written as .exr, .png, .jpg, .pfm or .hdr");
    RESTAGE_CHECK(check_picture_path(o.output));
    std::string warning;
    RESTAGE_TRY(scene::PixelData image, io::read_image(o.input, scene::Encoding::srgb, 2.2f, &warning));
    if (!warning.empty()) context.log.warning(warning);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        if (image.channels != 4 || i % 4 != 3) image.values[i] *= std::exp2(o.exposure); // alpha is not radiance
    RESTAGE_CHECK(io::write_image(o.output, image));
    if (const std::string others = other_layers(o.input); !others.empty())
        context.log.warning(fmt::format("{}: lacks the layers {} of {}", o.output, others, o.input));
    context.log.info(fmt::format("{}: written", o.output));
    return int(exit_ok);
}

Result<int> run(Context& context, const Options& o) {
    std::error_code code;
    if (std::filesystem::equivalent(o.input, o.output, code))
        return fail(o.output +
                    ": is the input file; data that the format cannot hold would be lost, so choose another name");
    if (is_picture(o.input)) return convert_picture(context, o);
    if (o.exposure != 0) return fail("--exposure is for pictures; the exposure of a scene is that of its film");
    if (is_picture(o.output) && o.format.empty())
        return fail(o.output + ": use `restage render` to make a picture of a scene");
    RESTAGE_TRY(const auto exporter, io::find_exporter(o.output, o.format, context.registry()));
    io::ExportOptions options{.format = o.format};
    for (const auto& assignment : o.assignments)
        RESTAGE_CHECK(io::set_option(*exporter.table, assignment, options.values));
    RESTAGE_TRY(const auto imported, open_scene_with(context, o.input, false, o.import_options));
    RESTAGE_TRY(const auto report, o.strict ? io::convert_strictly(imported, o.output, context.registry(), options)
                                            : io::export_scene(imported.scene, o.output, context.registry(), options));
    for (const auto& entry : report.entries)
        if (entry.fate != io::Fate::kept) context.log.warning(io::to_string(entry));
    const auto approximated = report.count(io::Fate::approximated), dropped = report.count(io::Fate::dropped);
    if (approximated + dropped > 0)
        context.log.warning(fmt::format("{}: written; {} approximated, {} dropped", o.output, approximated, dropped));
    else
        context.log.info(fmt::format("{}: written", o.output));
    return int(exit_ok);
}

} // namespace

void add_convert(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    auto* command = program.add_subcommand("convert", "Read a scene or a picture and write it in another format");
    command->add_option("IN", o->input, "Scene, project or picture to read")->required();
    command
        ->add_option(
            "OUT", o->output,
            "File to write; its extension selects the format: .pbrt for a scene; for a picture .exr, .png, .jpg, "
            ".pfm or .hdr")
        ->required();
    command->add_option("--format", o->format,
                        "Format of a scene to write, as `restage plugins` lists them (default: by the extension)");
    command
        ->add_option("--set", o->assignments,
                     "Option of the exporter: of pbrt, version=v4|v3, textures=copy|relative|absolute and "
                     "meshes=write|reference (may be repeated)")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
    add_import_options(*command, o->import_options);
    command->add_flag(
        "--strict", o->strict,
        "Write nothing if the written file would lack part of IN. Things that are only rendered differently "
        "(some textures, for example) but are written unchanged do not count");
    command->add_option("--exposure", o->exposure, "Brighten a picture by this number of stops (default: 0)")
        ->check(CLI::Range(-64.f, 64.f));
    add_example(
        *command,
        "restage convert room.pbrt room-v3.pbrt --set version=v3; restage convert room.exr room.jpg --exposure 1");
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
