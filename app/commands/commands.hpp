// SPDX-License-Identifier: Apache-2.0
// The commands of the program, one file each: add_<name> declares a subcommand with its options, whose callback passes
// the work to Context::choose. To add one: a new file, a declaration here, a line in the list below.
#pragma once

#include "context.hpp"

namespace CLI {
class App;
}

namespace restage::app {

void add_edit(CLI::App& program, Context& context);
void add_demo(CLI::App& program, Context& context);
void add_render(CLI::App& program, Context& context);
void add_merge(CLI::App& program, Context& context);
void add_info(CLI::App& program, Context& context);
void add_convert(CLI::App& program, Context& context);
void add_pack(CLI::App& program, Context& context);
void add_compare(CLI::App& program, Context& context);
void add_plugins(CLI::App& program, Context& context);
void add_check(CLI::App& program, Context& context);
void add_new_plugin(CLI::App& program, Context& context);
void add_bench(CLI::App& program, Context& context);
void add_import_child(CLI::App& program, Context& context);

// `compare` for two scenes instead of two pictures (compare_scenes.cpp).
bool is_scene_file(const std::string& path);
Result<int> compare_scenes(Context& context, const std::string& a, const std::string& b, bool json);

// The end of `restage COMMAND --help`, before inherited options.
void add_example(CLI::App& command, const char* example);

// In the order of `restage --help`.
inline constexpr void (*all_commands[])(CLI::App&, Context&) = {
    add_edit,    add_demo,    add_render, add_merge,      add_info,  add_convert,      add_pack,
    add_compare, add_plugins, add_check,  add_new_plugin, add_bench, add_import_child,
};

} // namespace restage::app
