// SPDX-License-Identifier: Apache-2.0
// restage import-child IN OUT: what `--isolate` runs in a process of its own (document/isolate.hpp). Not for users.
#include "commands.hpp"
#include "document/isolate.hpp"

#include <CLI/CLI.hpp>
#include <memory>

namespace restage::app {

void add_import_child(CLI::App& program, Context& context) {
    auto in = std::make_shared<std::string>(), out = std::make_shared<std::string>();
    auto* command = program.add_subcommand("import-child", "")->group("");
    command->add_option("IN", *in)->required();
    command->add_option("OUT", *out)->required();
    command->callback([&context, in, out] {
        context.choose([&context, in, out]() -> Result<int> {
            RESTAGE_CHECK(document::import_child(*in, *out, context.registry()));
            return int(exit_ok);
        });
    });
}

} // namespace restage::app
