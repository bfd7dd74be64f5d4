// SPDX-License-Identifier: Apache-2.0
#include "plugin/manifest.hpp"

#include "base/file.hpp"
#include "base/json.hpp"
#include "plugin/library.hpp"
#include "plugin/manifest_keys.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

namespace restage::plugin {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t longest_manifest = 1 << 20;

constexpr std::string_view known_keys[] = {"id",      "version", "licence",   "provides", "needs",
                                           "library", "files",   "materials", "textures", "exceptions"};

// The offset of a key of the outermost object: the byte of its opening quote. `text` is a JSON object.
std::size_t place_of_key(const std::string& text, const std::string& key) {
    int depth = 0;
    bool is_key = false; // the next string at depth 1
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '{' || c == '[') {
            is_key = ++depth == 1;
        } else if (c == '}' || c == ']') {
            --depth;
        } else if (c == ',') {
            is_key = depth == 1;
        } else if (c == '"') {
            const std::size_t start = i;
            for (++i; i < text.size() && text[i] != '"'; ++i)
                if (text[i] == '\\') ++i;
            const auto string = json::parse(text.substr(start, i + 1 - start), nullptr, false);
            if (std::exchange(is_key, false) && string.is_string() && string.get_ref<const std::string&>() == key)
                return start;
        }
    }
    return 0;
}

Result<> check_keys(const json& object, const std::string& text, const std::string& file) {
    const auto key = unknown_key(object, known_keys);
    if (!key) return {};
    return fail(file + ":" + line_and_column(text, place_of_key(text, *key)) + ": " +
                unknown_key_text(*key, known_keys));
}

Result<std::string> text_of(const json& object, const char* key, const std::string& file) {
    const auto it = object.find(key);
    if (it == object.end()) return fail(file + ": \"" + key + "\" is missing");
    if (!it->is_string() || it->get_ref<const std::string&>().empty())
        return fail(file + ": \"" + key + "\" must be a non-empty string");
    return it->get<std::string>();
}

bool is_reverse_dns(const std::string& id) { // org.example.velvet
    bool dot = false, start = true;
    for (const char c : id) {
        if (c == '.') {
            if (start) return false;
            dot = start = true;
            continue;
        }
        if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_')) return false;
        start = false;
    }
    return dot && !start;
}

// A path confined to the plugin's folder.
Result<fs::path> inner_path(const std::string& text, const char* key, const std::string& file) {
    const fs::path path = fs::path(text).lexically_normal();
    if (path.empty() || path.is_absolute() || path.has_root_name() || *path.begin() == ".." || path == ".")
        return fail(file + ": \"" + key + "\": \"" + text + "\" is not a path inside the plugin's folder");
    return path;
}

Result<std::vector<std::string>> list_of_texts(const json& value, const std::string& what) {
    const auto is_text = [](const json& v) { return v.is_string() && !v.get_ref<const std::string&>().empty(); };
    if (!value.is_array() || !std::all_of(value.begin(), value.end(), is_text))
        return fail(what + " must be a list of strings");
    return value.get<std::vector<std::string>>();
}

bool is_interface(std::string_view id) { // restage.material/1
    const std::size_t slash = id.rfind('/');
    return slash != std::string_view::npos && id.substr(0, slash).find('.') != std::string_view::npos &&
           slash + 1 < id.size() && id.find_first_not_of("0123456789", slash + 1) == std::string_view::npos &&
           id[slash + 1] != '0';
}

Result<std::vector<std::string>> interfaces_of(const json& value, const std::string& what) {
    RESTAGE_TRY(auto list, list_of_texts(value, what));
    for (const std::string& id : list)
        if (!is_interface(id))
            return fail(what + ": \"" + id + "\" is not an interface; they look like \"restage.material/1\"");
    return list;
}

// Parts of "0.2.1", missing ones 0; nullopt = not a version.
std::optional<std::array<int, 3>> version_of(std::string_view text) {
    std::array<int, 3> out{};
    for (int& part : out) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), part);
        if (error != std::errc() || part < 0) return std::nullopt;
        text.remove_prefix(std::size_t(end - text.data()));
        if (text.empty()) return out;
        if (text[0] != '.') return std::nullopt;
        text.remove_prefix(1);
    }
    return std::nullopt;
}

// The conditions of ">=0.2 <0.4": {"at least?", version}. nullopt = malformed.
std::optional<std::vector<std::pair<bool, std::array<int, 3>>>> conditions_of(std::string_view text) {
    std::vector<std::pair<bool, std::array<int, 3>>> out;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string_view word = text.substr(0, end);
        const bool least = word.starts_with(">=");
        const auto version = version_of(word.substr(std::min<std::size_t>(least ? 2 : 1, word.size())));
        if ((!least && !word.starts_with("<")) || !version) return std::nullopt;
        out.emplace_back(least, *version);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return out.empty() ? std::nullopt : std::optional(out);
}

Result<> read_needs(const json& object, const std::string& file, Manifest& out) {
    const auto needs = object.find("needs");
    if (needs == object.end()) return {};
    const std::string what = file + ": \"needs\"";
    if (!needs->is_object()) return fail(what + " must be an object, for example {\"host\": \">=0.2\"}");
    constexpr std::string_view keys[] = {"host", "interfaces"};
    if (const auto key = unknown_key(*needs, keys)) return fail(what + ": " + unknown_key_text(*key, keys));
    if (needs->contains("host")) {
        RESTAGE_TRY(out.needs_host, text_of(*needs, "host", what));
        if (!conditions_of(out.needs_host))
            return fail(what + ": \"host\": \"" + out.needs_host +
                        "\" is not a version range, such as \">=0.2\" or \">=0.2 <0.4\"");
    }
    if (const auto list = needs->find("interfaces"); list != needs->end()) {
        RESTAGE_TRY(out.needs_interfaces, interfaces_of(*list, what + ": \"interfaces\""));
    }
    return {};
}

// Read by `restage check`, which verifies that its steps know the exceptions.
Result<> check_exceptions(const json& object, const std::string& file) {
    const auto list = object.find("exceptions");
    if (list == object.end()) return {};
    const std::string what = file + ": \"exceptions\"";
    if (!list->is_array()) return fail(what + " must be a list of objects { \"step\", \"limit\", \"why\" }");
    constexpr std::string_view keys[] = {"step", "limit", "why"};
    for (std::size_t i = 0; i < list->size(); ++i) {
        const json& one = (*list)[i];
        const std::string where = what + "[" + std::to_string(i) + "]";
        if (!one.is_object()) return fail(where + " must be an object { \"step\", \"limit\", \"why\" }");
        if (const auto key = unknown_key(one, keys)) return fail(where + ": " + unknown_key_text(*key, keys));
        for (const char* key : {"step", "why"})
            RESTAGE_CHECK(text_of(one, key, where));
        if (!one.contains("limit") || !one["limit"].is_number()) return fail(where + ": \"limit\" must be a number");
    }
    return {};
}

} // namespace

bool Manifest::provides_any(std::string_view interface_name) const {
    return std::any_of(provides.begin(), provides.end(), [&](const std::string& provided) {
        return std::string_view(provided).substr(0, provided.rfind('/')) == interface_name;
    });
}

std::vector<std::string> Manifest::kinds() const {
    std::vector<std::string> out;
    for (const std::string& provided : provides) {
        std::string name = provided.substr(0, provided.rfind('/'));
        if (name.starts_with("restage.")) name.erase(0, 8);
        // Interfaces that belong to a material are not a separate kind.
        if (name != "emission" && name != "table" && name != "inspector" &&
            std::find(out.begin(), out.end(), name) == out.end())
            out.push_back(std::move(name));
    }
    return out;
}

std::string Manifest::kind() const {
    std::string text;
    for (const std::string& k : kinds())
        text += (text.empty() ? "" : ", ") + k;
    return text;
}

std::span<const std::string_view> known_interfaces() {
    static constexpr std::string_view all[] = {"restage.material/1",  "restage.emission/1", "restage.table/1",
                                               "restage.inspector/1", "restage.importer/1", "restage.exporter/1",
                                               "restage.denoiser/1",  "restage.action/1",   "restage.panel/1",
                                               "restage.sky/1",       "restage.texture/1"};
    return all;
}

Result<> check_needs(const Manifest& manifest, const HostOffer& offer, const std::string& file) {
    if (const auto conditions = conditions_of(manifest.needs_host))
        for (const auto& [least, version] : *conditions) {
            const auto host = version_of(offer.version).value_or(std::array<int, 3>{});
            if (least ? host < version : host >= version)
                return fail(file + ": needs Restage " + manifest.needs_host + ", this is " + offer.version +
                            (least ? ": the plugin is too new; update the program"
                                   : ": the plugin is too old; update the plugin"));
        }
    const auto has = [](const std::vector<std::string_view>& list, const std::string& id) {
        return std::find(list.begin(), list.end(), id) != list.end();
    };
    for (const std::string& id : manifest.needs_interfaces)
        if (!has(offer.services, id) && !has(offer.interfaces, id))
            return fail(file + ": needs " + id + ", which this program does not have: update the program");
    if (std::none_of(manifest.provides.begin(), manifest.provides.end(),
                     [&](const std::string& id) { return has(offer.interfaces, id); }))
        return fail(file + ": provides " + manifest.provides[0] +
                    ", which this program cannot use: the plugin is too new; update the program");
    return {};
}

Result<Manifest> parse_manifest(const std::string& text, const std::string& file) {
    const auto parsed = parse_json<json>(text);
    if (!parsed) return fail(file + ":" + parsed.error().message);
    const json& object = *parsed;
    if (!object.is_object()) return fail(file + ": the manifest must be one JSON object { ... }");
    if (object.contains("kind") || object.contains("abi"))
        return fail(file +
                    ": \"kind\" and \"abi\" belong to Restage 0.1: write, for example, \"provides\": "
                    "[\"restage.material/1\"], \"needs\": {\"host\": \">=0.2\"}, and rebuild the library");
    RESTAGE_CHECK(check_keys(object, text, file));
    Manifest out;
    RESTAGE_TRY(out.id, text_of(object, "id", file));
    if (!is_reverse_dns(out.id))
        return fail(file + ": \"id\": \"" + out.id + "\" is not in reverse-DNS form, such as \"org.example.velvet\"");
    RESTAGE_TRY(out.version, text_of(object, "version", file));
    RESTAGE_TRY(out.licence, text_of(object, "licence", file));
    const auto provides = object.find("provides");
    if (provides == object.end())
        return fail(file + ": \"provides\" is missing: list the interfaces, for example [\"restage.material/1\"]");
    RESTAGE_TRY(out.provides, interfaces_of(*provides, file + ": \"provides\""));
    if (out.provides.empty()) return fail(file + ": \"provides\" is empty: the plugin provides nothing");
    RESTAGE_CHECK(read_needs(object, file, out));
    RESTAGE_CHECK(check_exceptions(object, file));
    out.has_materials = object.contains("materials"); // material_json.cpp reads them
    if (out.has_materials && !out.provides_any("restage.material"))
        return fail(file + ": has \"materials\", but \"provides\" does not list restage.material/1");
    const bool has_textures = object.contains("textures"); // texture_json.cpp
    if (has_textures && !out.provides_any("restage.texture"))
        return fail(file + ": has \"textures\", but \"provides\" does not list restage.texture/1");
    if (object.contains("library") || !(out.has_materials || has_textures)) {
        RESTAGE_TRY(const std::string library, text_of(object, "library", file));
        RESTAGE_TRY(out.library, inner_path(library, "library", file));
        if (!out.library.has_extension()) out.library += Library::extension();
    }
    if (const auto files = object.find("files"); files != object.end()) {
        if (!files->is_array()) return fail(file + ": \"files\" must be a list of paths");
        for (const json& entry : *files) {
            if (!entry.is_string()) return fail(file + ": \"files\" must contain paths only");
            RESTAGE_TRY(fs::path path, inner_path(entry.get<std::string>(), "files", file));
            out.files.push_back(std::move(path));
        }
    }
    return out;
}

Result<Manifest> read_manifest(const fs::path& file) {
    std::error_code code;
    if (const auto size = fs::file_size(file, code); !code && size > longest_manifest)
        return fail(file.string() + ": " + std::to_string(size) + " bytes are too many for a manifest");
    RESTAGE_TRY(const std::string text, read_file(file));
    return parse_manifest(text, file.string());
}

} // namespace restage::plugin
