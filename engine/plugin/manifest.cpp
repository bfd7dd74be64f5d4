// SPDX-License-Identifier: Apache-2.0
#include "plugin/manifest.hpp"

#include "base/file.hpp"
#include "base/json.hpp"
#include "plugin/library.hpp"
#include "plugin/manifest_keys.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace restage::plugin {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t longest_manifest = 1 << 20;

constexpr std::string_view known_keys[] = {"id",      "version", "kind",      "abi",       "licence",
                                           "library", "files",   "materials", "exceptions"};

// Where a key of the outermost object stands: the byte of its opening quote. `text` is an object, and JSON.
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
        return fail(file + ": \"" + key + "\" must be a text that is not empty");
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

// A path that cannot leave the plugin's folder.
Result<fs::path> inner_path(const std::string& text, const char* key, const std::string& file) {
    const fs::path path = fs::path(text).lexically_normal();
    if (path.empty() || path.is_absolute() || path.has_root_name() || *path.begin() == ".." || path == ".")
        return fail(file + ": \"" + key + "\": \"" + text + "\" is not a path inside the plugin's folder");
    return path;
}

Result<std::uint32_t> revision(const json& value, const std::string& key, const std::string& file) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() == 0 || value.get<std::uint64_t>() > 0xffffffffull)
        return fail(file + ": " + key + " must be a whole number from 1 on");
    return value.get<std::uint32_t>();
}

Result<> read_abi(const json& object, const std::string& file, Manifest& out) {
    const auto abi = object.find("abi");
    if (abi == object.end())
        return fail(file + ": \"abi\" is missing: write the revision the plugin was built for, for example \"abi\": 1");
    if (!abi->is_object()) {
        RESTAGE_TRY(out.abi_min, revision(*abi, "\"abi\"", file));
        out.abi_max = out.abi_min;
        return {};
    }
    constexpr std::string_view keys[] = {"min", "max"};
    if (const auto key = unknown_key(*abi, keys)) return fail(file + ": \"abi\": " + unknown_key_text(*key, keys));
    for (const char* key : {"min", "max"})
        if (!abi->contains(key)) return fail(file + ": \"abi\" has no \"" + key + "\"");
    RESTAGE_TRY(out.abi_min, revision((*abi)["min"], "\"abi\".\"min\"", file));
    RESTAGE_TRY(out.abi_max, revision((*abi)["max"], "\"abi\".\"max\"", file));
    if (out.abi_min > out.abi_max) return fail(file + ": \"abi\": min is greater than max");
    return {};
}

// Read by `restage check`; whether its steps know exceptions is asked there.
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

const char* to_string(Kind kind) {
    switch (kind) {
        case Kind::material:
            return "material";
        case Kind::importer:
            return "importer";
        case Kind::exporter:
            return "exporter";
        case Kind::denoiser:
            return "denoiser";
    }
    return "";
}

Result<Manifest> parse_manifest(const std::string& text, const std::string& file) {
    const auto parsed = parse_json<json>(text);
    if (!parsed) return fail(file + ":" + parsed.error().message);
    const json& object = *parsed;
    if (!object.is_object()) return fail(file + ": the manifest must be one JSON object { ... }");
    RESTAGE_CHECK(check_keys(object, text, file));
    Manifest out;
    RESTAGE_TRY(out.id, text_of(object, "id", file));
    if (!is_reverse_dns(out.id))
        return fail(file + ": \"id\": \"" + out.id + "\" is not in reverse-DNS form, such as \"org.example.velvet\"");
    RESTAGE_TRY(out.version, text_of(object, "version", file));
    RESTAGE_TRY(out.licence, text_of(object, "licence", file));
    RESTAGE_TRY(const std::string kind, text_of(object, "kind", file));
    bool known = false;
    for (const Kind k : {Kind::material, Kind::importer, Kind::exporter, Kind::denoiser})
        if (kind == to_string(k)) {
            out.kind = k;
            known = true;
        }
    if (!known)
        return fail(file + ": \"kind\": \"" + kind +
                    "\" is unknown; material, importer, exporter and denoiser are known");
    RESTAGE_CHECK(read_abi(object, file, out));
    RESTAGE_CHECK(check_exceptions(object, file));
    if (object.contains("materials")) { // material_json.cpp reads them
        if (out.kind != Kind::material) return fail(file + ": only a plugin of kind material has \"materials\"");
        if (object.contains("library"))
            return fail(file + ": has both \"library\" and \"materials\": the tables come from one of them");
    } else {
        RESTAGE_TRY(const std::string library, text_of(object, "library", file));
        RESTAGE_TRY(out.library, inner_path(library, "library", file));
        if (!out.library.has_extension()) out.library += Library::extension();
    }
    if (const auto files = object.find("files"); files != object.end()) {
        if (!files->is_array()) return fail(file + ": \"files\" must be a list of paths");
        for (const json& entry : *files) {
            if (!entry.is_string()) return fail(file + ": \"files\" must hold paths only");
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
