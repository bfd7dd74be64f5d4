// SPDX-License-Identifier: Apache-2.0
// restage convert IN OUT: a scene from one format, or version, to another.
#include "commands.hpp"
#include "io/strict.hpp"
#include "rendering.hpp"

#include <fmt/format.h>
#include <memory>

namespace restage::app {
namespace {

struct Options {
    std::string input, output, format;
    std::vector<std::string> assignments;
    bool strict = false;
};

Result<int> run(Context& context, const Options& o) {
    RESTAGE_TRY(const auto exporter, io::find_exporter(o.output, o.format, context.registry()));
    io::ExportOptions options{.format = o.format};
    for (const auto& assignment : o.assignments)
        RESTAGE_CHECK(io::set_option(*exporter.table, assignment, options.values));
    RESTAGE_TRY(const auto imported, open_scene(context, o.input, o.strict));
    RESTAGE_TRY(const auto report, o.strict ? io::export_strictly(imported.scene, o.output, context.registry(), options)
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
    auto* command = program.add_subcommand("convert", "Read a scene and write it in another format or version");
    command->add_option("IN", o->input, "Scene file to read")->required();
    command->add_option("OUT", o->output, "Scene file to write")->required();
    command->add_option("--format", o->format, "Format to write (default: by the extension)");
    command->add_option("--set", o->assignments,
                        "Option of the exporter, for example --set version=v3 (may be repeated)");
    command->add_flag("--strict", o->strict,
                      "Write nothing when something is approximated or dropped, in reading or in writing");
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
