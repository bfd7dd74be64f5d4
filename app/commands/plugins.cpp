// SPDX-License-Identifier: Apache-2.0
// restage plugins: lists loaded plugins and their folders, and why others are not loaded.
#include "commands.hpp"

#include "plugin/provides.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

namespace restage::app {
namespace {

Result<int> run(Context& context, bool json) {
    auto& registry = context.registry();
    nlohmann::json list = nlohmann::json::array();
    for (const auto* entry : registry.entries()) {
        const bool loaded = entry->state == plugin::State::loaded;
        const auto names = plugin::provides(registry, *entry);
        if (json) {
            list.push_back({{"id", entry->manifest.id},
                            {"version", entry->manifest.version},
                            {"loaded", loaded},
                            {"folder", entry->folder.string()},
                            {"provides", names},
                            {"own", entry->own},
                            {"quarantined", entry->quarantined},
                            {"reason", entry->reason}});
            continue;
        }
        std::printf("%s  %-40s %-8s %s\n", loaded ? "loaded " : "REFUSED", entry->name().c_str(),
                    entry->manifest.version.c_str(), entry->folder.string().c_str());
        for (const auto& name : names)
            std::printf("         %s\n", name.c_str());
        if (!loaded) std::printf("         %s\n", entry->reason.c_str());
    }
    if (json)
        std::printf("%s\n", list.dump(2).c_str());
    else if (registry.entries().empty())
        std::printf("no plugins found; folders searched:\n");
    if (!json && registry.entries().empty())
        for (const auto& path : plugin::Registry::default_paths())
            std::printf("  %s\n", path.folder.string().c_str());
    return int(exit_ok);
}

Result<int> enable(Context& context, const std::string& id) {
    const plugin::Quarantine quarantine(plugin::Registry::default_quarantine());
    RESTAGE_TRY(const bool was_in, quarantine.release(id));
    if (!was_in)
        return fail("\"" + id + "\" has not crashed: there is nothing to enable. `restage plugins` lists ids.");
    context.log.info(id + " will be loaded again");
    return int(exit_ok);
}

} // namespace

void add_plugins(CLI::App& program, Context& context) {
    auto json = std::make_shared<bool>(false);
    auto id = std::make_shared<std::string>();
    auto* command =
        program.add_subcommand("plugins", "List plugins: loaded ones and their folders, and why others are not loaded");
    command->add_flag("--json", *json, "Print the list as JSON");
    command->add_option("--enable", *id, "Enable the plugin with this id again after a crash")->type_name("ID");
    add_example(*command, "restage plugins");
    command->callback([&context, json, id] {
        context.choose([&context, json, id] { return id->empty() ? run(context, *json) : enable(context, *id); });
    });
}

} // namespace restage::app
