// SPDX-License-Identifier: Apache-2.0
// restage pack PROJECT -o OUT: a project with all files that it needs, in a folder or a zip file.
#include "document/pack.hpp"
#include "commands.hpp"
#include "document/session.hpp"
#include "progress.hpp"
#include "reading.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <memory>

namespace restage::app {
namespace {

struct Options {
    std::string input, output;
};

Result<int> run(Context& context, const Options& o) {
    ProgressBar bar(context.quiet);
    RESTAGE_TRY(document::ReadOptions read, reading_with(context, bar));
    document::Session session(context.registry());
    RESTAGE_CHECK(session.open(o.input, read));
    RESTAGE_TRY(const document::Packed packed,
                document::pack_project(session.recovery_text({}), o.output, context.registry(), read));
    bar.finish();
    for (const std::string& problem : packed.problems)
        context.log.warning(problem);
    context.log.info(fmt::format("{}: written, with {} file{} of {:.1f} MB", packed.project.string(), packed.files,
                                 packed.files == 1 ? "" : "s", static_cast<double>(packed.bytes) * 1e-6));
    return int(exit_ok);
}

} // namespace

void add_pack(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    auto* command =
        program.add_subcommand("pack", "Put a project and all files that it needs into a folder or a zip file");
    command->add_option("PROJECT", o->input, "Project or scene file")->required();
    command
        ->add_option("-o,--output", o->output,
                     "New or empty folder; or a file .zip, which opens like a project: it is unpacked beside itself")
        ->required();
    add_example(*command, "restage pack kitchen.restage -o kitchen-for-ann.zip");
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
