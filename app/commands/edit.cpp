// SPDX-License-Identifier: Apache-2.0
// restage edit [SCENE]: the desktop editor. `restage SCENE` and plain `restage` start it as well if there is a
// display.
#include "base/file.hpp"
#include "commands.hpp"
#include "editor/run_editor.hpp"
#include "rendering.hpp"

#include <memory>

namespace restage::app {

void add_edit(CLI::App& program, Context& context) {
    auto o = std::make_shared<editor::RunOptions>();
    auto size = std::make_shared<std::string>();
    auto* command = program.add_subcommand("edit", "Open the desktop editor");
    command->add_option("SCENE", o->scene, "Scene file or project");
    command->add_option("--scale", o->scale, "Size of text and widgets, 1 = 100 % (default: the monitor's)")
        ->check(CLI::Range(0.5, 4.0));
    command->add_option("--window", *size, "Size of the window WxH [pixel], for example 1280x720");
    command->add_option("--config", o->config_dir,
                        "Folder for layout, preferences and recovery files (default: ~/.config/restage)");
    command->add_option("--probe", o->probe,
                        "For tests: write the editor's state as JSON to this file when it changes");
    command->add_option("--autosave", o->autosave_seconds, "Interval between recovery copies of unsaved work [s]")
        ->check(CLI::Range(0.2, 86400.0))
        ->capture_default_str();
    add_device_options(*command, o->renderer);
    add_example(*command, "restage edit room.pbrt");
    command->callback([&context, o, size] {
        context.choose([&context, o, size]() -> Result<int> {
            if (!o->scene.empty()) RESTAGE_CHECK(RegularFile::open(o->scene));
            o->plugins = {.safe_mode = context.safe_mode, .paths = search_paths(context.plugin_paths)};
            RESTAGE_TRY(o->isolate, isolate_options(context));
            o->renderer.fault = device_fault();
            if (!size->empty()) {
                RESTAGE_TRY(const auto parsed, parse_size(*size, "--window"));
                o->size = parsed;
            }
            return editor::run_editor(*o);
        });
    });
}

} // namespace restage::app
