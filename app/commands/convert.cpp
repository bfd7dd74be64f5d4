// SPDX-License-Identifier: Apache-2.0
// restage convert IN OUT: a scene, or a picture, from one format to another.
#include "commands.hpp"
#include "io/image_file.hpp"
#include "io/strict.hpp"
#include "rendering.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

namespace restage::app {
namespace {

struct Options {
    std::string input, output, format;
    std::vector<std::string> assignments;
    bool strict = false;
    float exposure = 0; // of a picture [stops]
};

bool is_picture(const std::string& path) {
    static constexpr std::string_view known[] = {".exr", ".png", ".jpg", ".jpeg", ".pfm",
                                                 ".hdr", ".tga", ".bmp", ".webp"};
    const std::string extension = std::filesystem::path(path).extension().string();
    return std::find(std::begin(known), std::end(known), extension) != std::end(known);
}

Result<int> convert_picture(Context& context, const Options& o) {
    RESTAGE_CHECK(check_picture_path(o.output));
    if (!o.format.empty() || !o.assignments.empty()) return fail("--format and --set are for scenes, not for pictures");
    std::string warning;
    RESTAGE_TRY(scene::PixelData image, io::read_image(o.input, RESTAGE_SRGB, 2.2f, &warning));
    if (!warning.empty()) context.log.warning(warning);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        if (image.channels != 4 || i % 4 != 3) image.values[i] *= std::exp2(o.exposure); // alpha is no light
    RESTAGE_CHECK(io::write_image(o.output, image));
    context.log.info(fmt::format("{}: written", o.output));
    return int(exit_ok);
}

Result<int> run(Context& context, const Options& o) {
    if (is_picture(o.input)) return convert_picture(context, o);
    RESTAGE_TRY(const auto exporter, io::find_exporter(o.output, o.format, context.registry()));
    io::ExportOptions options{.format = o.format};
    for (const auto& assignment : o.assignments)
        RESTAGE_CHECK(io::set_option(*exporter.table, assignment, options.values));
    RESTAGE_TRY(const auto imported, open_scene(context, o.input));
    RESTAGE_TRY(const auto report, o.strict ? io::convert_strictly(imported, o.output, context.registry(), options)
                                            : io::export_scene(imported.scene, o.output, context.registry(), options));
    for (const auto& entry : report.entries)
        if (entry.fate != RESTAGE_KEPT) context.log.warning(io::to_string(entry));
    const auto approximated = report.count(RESTAGE_APPROXIMATED), dropped = report.count(RESTAGE_DROPPED);
    if (approximated + dropped > 0)
        context.log.warning(
            fmt::format("{}: written with {} things approximated, {} dropped", o.output, approximated, dropped));
    else
        context.log.info(fmt::format("{}: written", o.output));
    return int(exit_ok);
}

} // namespace

void add_convert(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    auto* command = program.add_subcommand("convert", "Read a scene or a picture and write it in another format");
    command->add_option("IN", o->input, "Scene or picture to read")->required();
    command->add_option("OUT", o->output, "Scene or picture to write")->required();
    command->add_option("--format", o->format, "Format to write (default: by the extension)");
    command->add_option("--set", o->assignments,
                        "Option of the exporter, for example --set version=v3 (may be repeated)");
    command->add_flag("--strict", o->strict,
                      "Write nothing when the written file would not have all of IN. What is only rendered otherwise "
                      "than it is (a kind of texture, say), and written as it was, is no loss");
    command->add_option("--exposure", o->exposure, "Of a picture: stops that are added")
        ->check(CLI::Range(-64.f, 64.f));
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
