// SPDX-License-Identifier: Apache-2.0
// restage new-plugin NAME: writes a material plugin to begin with, that loads, passes `restage check` and renders. The
// files are those of share/restage/templates, with @NAME@, @LABEL@ and @ID@ replaced.
#include "base/file.hpp"
#include "commands.hpp"
#include "plugin/manifest.hpp"
#include "plugin/tables.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace restage::app {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string name, label, id, language = "json", folder;
};

std::string replace_all(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

Result<int> run(Context& context, Options o) {
    const bool lower = std::all_of(o.name.begin(), o.name.end(),
                                   [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_'; });
    if (!lower || !plugin::is_glsl_identifier(o.name) || o.name.back() == '_' || !std::isalpha(o.name[0]))
        return fail("\"" + o.name +
                    "\" cannot be the name of a material: lower case letters, digits and _, a letter first, no word of "
                    "GLSL (it becomes the prefix of its functions)");
    if (plugin::is_taken_prefix(o.name))
        return fail("\"" + o.name + "\" cannot be the name of a material: functions of Restage's own begin with it");
    if (const auto taken = context.registry().find_material(o.name))
        return fail("there is a material \"" + o.name + "\" already, of " + taken->plugin->name());
    if (o.label.empty()) {
        o.label = replace_all(o.name, "_", " ");
        o.label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(o.label[0])));
    }
    const bool plain = std::none_of(o.label.begin(), o.label.end(), [](unsigned char c) {
        return c < ' ' || c == '"' || c == '\\'; // it is written into JSON, C and comments
    });
    if (!plain || o.label.find("*/") != std::string::npos)
        return fail("--label: quotes, backslashes, line breaks and */ cannot be in a label: " + o.label);
    if (o.id.empty()) o.id = "org.example.material." + o.name;
    const fs::path folder = o.folder.empty() ? fs::path(o.name) : fs::path(o.folder);
    std::error_code code;
    if (fs::exists(folder, code) && !fs::is_directory(folder, code))
        return fail(folder.string() + ": is there already, and no folder; name another place with --folder");
    if (fs::exists(folder, code) && !fs::is_empty(folder, code))
        return fail(folder.string() + ": is there already, and not empty; name another place with --folder");
    RESTAGE_TRY(const auto bin, executable_dir());
    const fs::path templates = bin.parent_path() / "share/restage/templates";
    std::vector<std::pair<fs::path, std::string>> files; // all of them, before the first is written
    for (const std::string& part : {std::string("common"), o.language})
        for (const auto& file : fs::directory_iterator(templates / part, code)) {
            RESTAGE_TRY(std::string text, read_file(file.path()));
            text = replace_all(replace_all(replace_all(text, "@NAME@", o.name), "@LABEL@", o.label), "@ID@", o.id);
            const std::string name = replace_all(file.path().filename().string(), "NAME", o.name);
            if (name == "plugin.json") RESTAGE_CHECK(plugin::parse_manifest(text, name)); // an --id that is none
            files.emplace_back(folder / name, std::move(text));
        }
    if (code || files.empty())
        return fail(templates.string() + ": the templates are not there; the installation is incomplete");
    fs::create_directories(folder, code);
    if (code) return fail(folder.string() + ": cannot be made: " + code.message());
    for (const auto& [path, text] : files)
        RESTAGE_CHECK(write_file_atomic(path, text));
    std::printf("%s: a material plugin in %s; %s says how to build, check and render it\n", folder.string().c_str(),
                o.language == "json" ? "JSON and GLSL, without native code"
                : o.language == "c"  ? "C and GLSL"
                                     : "C++ and GLSL",
                (folder / "README.md").string().c_str());
    return int(exit_ok);
}

} // namespace

void add_new_plugin(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    auto* command = program.add_subcommand("new-plugin", "Write a material plugin to begin with");
    command->add_option("NAME", o->name, "Of the material, as scene files will call it, for example velvet")
        ->required();
    command->add_option("--language", o->language, "json: a table and GLSL, nothing to build; c or cpp: a library")
        ->check(CLI::IsMember({"json", "c", "cpp"}))
        ->capture_default_str();
    command->add_option("--label", o->label, "Name that people read (default: NAME with a capital)");
    command->add_option("--id", o->id, "Id of the plugin, in reverse-DNS form (default: org.example.material.NAME)");
    command->add_option("--folder", o->folder,
                        "Folder to write it into; new or empty (default: NAME, in the current folder)");
    add_example(*command, "restage new-plugin velvet; restage check velvet");
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
