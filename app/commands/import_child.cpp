// SPDX-License-Identifier: Apache-2.0
// restage import-child IN OUT: the separate process of `--isolate` (document/isolate.hpp). Not for users.
#include "commands.hpp"
#include "document/isolate.hpp"
#include "io/options.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

namespace restage::app {

void add_import_child(CLI::App& program, Context& context) {
    auto in = std::make_shared<std::string>(), out = std::make_shared<std::string>();
    auto* command = program.add_subcommand("import-child", "")->group("");
    command->add_option("IN", *in)->required();
    command->add_option("OUT", *out)->required();
    auto format = std::make_shared<std::string>();
    auto assignments = std::make_shared<std::vector<std::string>>();
    command->add_option("--format", *format);
    command->add_option("--set", *assignments)->allow_extra_args(false);
    command->callback([&context, in, out, format, assignments] {
        context.choose([&context, in, out, format, assignments]() -> Result<int> {
            io::ImportOptions reading{.progress = {}, .format = *format};
            for (const std::string& assignment : *assignments)
                RESTAGE_CHECK(io::set_text_option(assignment, reading.values));
            RESTAGE_CHECK(document::import_child(*in, *out, context.registry(), std::move(reading)));
            return int(exit_ok);
        });
    });
}

} // namespace restage::app
