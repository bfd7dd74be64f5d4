// SPDX-License-Identifier: Apache-2.0
// restage new-plugin NAME --kind KIND: writes a working plugin to start from, which passes `restage check`. Its files
// are those of share/restage/templates/KIND/common and KIND/LANGUAGE, with @NAME@, @LABEL@ and @ID@ replaced. A kind
// without such a folder is not offered.
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

using plugin::Catalogue;
using plugin::Entry;

struct Options {
    std::string name, kind = "material", language, label, id, folder;
};

struct Language {
    const char* name;
    const char* written_in; // as in the printed sentence
};
constexpr Language json{"json", "JSON and GLSL, without native code"}, c{"c", "C"}, cpp{"cpp", "C++"},
    c_glsl{"c", "C and GLSL"}, cpp_glsl{"cpp", "C++ and GLSL"};

// The plugin that already provides this name in one of the catalogue's lists; null if none.
template <auto List, auto Name>
const Entry* provider(const Catalogue& catalogue, const std::string& name) {
    for (const auto& entry : catalogue.*List)
        if (entry.table->*Name == name) return entry.plugin.get();
    return nullptr;
}

struct Kind {
    const char* name; // "importer": also its folder of templates
    const char* article;
    std::vector<Language> languages; // the first is the default
    bool glsl;                       // its name becomes the prefix of GLSL functions
    const Entry* (*provider)(const Catalogue&, const std::string& name);
};

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = {
        {"material", "a", {json, c_glsl, cpp_glsl}, true, provider<&Catalogue::materials, &model::Material::type>},
        {"texture", "a", {json, c_glsl, cpp_glsl}, true, provider<&Catalogue::textures, &model::Texture::type>},
        {"importer", "an", {c, cpp}, false, provider<&Catalogue::importers, &model::Importer::format>},
        {"exporter", "an", {c, cpp}, false, provider<&Catalogue::exporters, &model::Exporter::format>},
        {"denoiser", "a", {c, cpp}, false, provider<&Catalogue::denoisers, &plugin::Denoiser::type>},
        {"sky", "a", {c, cpp}, false, provider<&Catalogue::skies, &model::Sky::type>},
        {"action", "an", {c, cpp}, false, provider<&Catalogue::actions, &model::Action::id>},
        {"panel", "a", {c, cpp}, false, provider<&Catalogue::panels, &model::Panel::id>},
    };
    return all;
}

fs::path templates_folder() {
    const auto bin = executable_dir();
    return bin ? bin->parent_path() / "share/restage/templates" : fs::path();
}

bool has_templates(const Kind& kind, const Language& language) {
    std::error_code code;
    return fs::is_directory(templates_folder() / kind.name / language.name, code);
}

// "json, c or cpp"
std::string list(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
        text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    return text;
}

std::vector<std::string> languages_of(const Kind& kind) {
    std::vector<std::string> names;
    for (const Language& language : kind.languages)
        if (has_templates(kind, language)) names.emplace_back(language.name);
    return names;
}

std::vector<std::string> kinds_offered() {
    std::vector<std::string> names;
    for (const Kind& kind : kinds())
        if (!languages_of(kind).empty()) names.emplace_back(kind.name);
    return names;
}

std::string replace_all(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

// Used as the name of files, of a build target, and in scene files and commands.
Result<> check_name(const Kind& kind, const std::string& name, const Catalogue& catalogue) {
    const std::string sentence = "\"" + name + "\" cannot be the name of " + kind.article + " " + kind.name + ": ";
    const bool lower = std::all_of(name.begin(), name.end(),
                                   [](unsigned char ch) { return std::islower(ch) || std::isdigit(ch) || ch == '_'; });
    if (!lower || !std::isalpha(static_cast<unsigned char>(name.front())) || name.back() == '_' ||
        name.find("__") != std::string::npos || name.size() > 64)
        return fail(sentence + "lower case letters, digits and single _, a letter first");
    if (kind.glsl && !plugin::is_glsl_identifier(name))
        return fail(sentence + "it is a reserved word of GLSL, and is used as the prefix of its functions");
    if (kind.glsl && plugin::is_taken_prefix(name)) return fail(sentence + "Restage's own functions begin with it");
    if (const Entry* taken = kind.provider(catalogue, name))
        return fail(std::string("the ") + kind.name + " \"" + name + "\" exists already, in " + taken->name());
    return {};
}

Result<int> run(Context& context, Options o) {
    const Kind& kind = *std::find_if(kinds().begin(), kinds().end(), [&](const Kind& k) { return k.name == o.kind; });
    const std::vector<std::string> languages = languages_of(kind);
    if (languages.empty())
        return fail(templates_folder().string() + ": the templates are missing; the installation is incomplete");
    if (o.language.empty()) o.language = languages.front();
    if (std::find(languages.begin(), languages.end(), o.language) == languages.end())
        return fail("--language " + o.language + ": " + kind.article + " " + kind.name + " is written in " +
                    list(languages));
    const Language& language = *std::find_if(kind.languages.begin(), kind.languages.end(),
                                             [&](const Language& l) { return l.name == o.language; });
    RESTAGE_CHECK(check_name(kind, o.name, *context.registry().catalogue()));
    if (o.label.empty()) {
        o.label = replace_all(o.name, "_", " ");
        o.label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(o.label[0])));
    }
    const bool plain = std::none_of(o.label.begin(), o.label.end(), [](unsigned char ch) {
        return ch < ' ' || ch == '"' || ch == '\\'; // it is inserted into JSON, C and comments
    });
    if (!plain || o.label.find("*/") != std::string::npos)
        return fail("--label: quotes, backslashes, line breaks and */ cannot be in a label: " + o.label);
    if (o.id.empty()) o.id = "org.example." + o.kind + "." + o.name;
    const fs::path folder = o.folder.empty() ? fs::path(o.name) : fs::path(o.folder);
    std::error_code code, ignored;
    if (fs::exists(folder, code) && !fs::is_directory(folder, code))
        return fail(folder.string() + ": exists already and is not a folder; choose another with --folder");
    if (fs::exists(folder, code) && !fs::is_empty(folder, code))
        return fail(folder.string() + ": exists already and is not empty; choose another with --folder");
    const fs::path templates = templates_folder() / kind.name;
    std::vector<std::pair<fs::path, std::string>> files; // all of them, before the first is written
    for (const std::string& part : {std::string("common"), o.language}) {
        if (!fs::is_directory(templates / part, ignored)) continue; // nothing in common
        for (const auto& file : fs::recursive_directory_iterator(templates / part, code)) {
            if (file.is_directory(ignored)) continue;
            RESTAGE_TRY(std::string text, read_file(file.path()));
            text = replace_all(replace_all(replace_all(text, "@NAME@", o.name), "@LABEL@", o.label), "@ID@", o.id);
            const std::string name =
                replace_all(fs::relative(file.path(), templates / part, ignored).string(), "NAME", o.name);
            if (name == "plugin.json") RESTAGE_CHECK(plugin::parse_manifest(text, name)); // an invalid --id
            files.emplace_back(folder / name, std::move(text));
        }
    }
    if (code || files.empty())
        return fail(templates.string() + ": the templates are missing; the installation is incomplete");
    fs::create_directories(folder, code);
    if (code) return fail(folder.string() + ": cannot be created: " + code.message());
    for (const auto& [path, text] : files) {
        fs::create_directories(path.parent_path(), code);
        RESTAGE_CHECK(write_file_atomic(path, text));
    }
    std::printf("%s: %s %s plugin in %s; %s says how to build, check and use it\n", folder.string().c_str(),
                kind.article, kind.name, language.written_in, (folder / "README.md").string().c_str());
    return int(exit_ok);
}

} // namespace

void add_new_plugin(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    auto* command = program.add_subcommand("new-plugin", "Write a plugin to start from");
    command
        ->add_option("NAME", o->name,
                     "Name of the material, format, denoiser, ... in scene files and commands, for example velvet")
        ->required();
    command->add_option("--kind", o->kind, "Kind of plugin")
        ->check(CLI::IsMember(kinds_offered()))
        ->capture_default_str();
    command
        ->add_option("--language", o->language,
                     "json: a table and GLSL, nothing to build, for materials and textures; c or cpp: a library "
                     "(default: the first of these that the kind supports)")
        ->check(CLI::IsMember({"json", "c", "cpp"}));
    command->add_option("--label", o->label, "Name shown to users (default: NAME with a capital)");
    command->add_option("--id", o->id, "Id of the plugin, in reverse-DNS form (default: org.example.KIND.NAME)");
    command->add_option("--folder", o->folder,
                        "Folder to write it into; new or empty (default: NAME, in the current folder)");
    add_example(*command, "restage new-plugin velvet; restage check velvet");
    add_example(*command, "restage new-plugin tris --kind importer --language c");
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
