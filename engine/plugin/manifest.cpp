// SPDX-License-Identifier: Apache-2.0
#include "plugin/manifest.hpp"

#include "base/file.hpp"
#include "plugin/library.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace restage::plugin {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t longest_manifest = 1 << 20;

// "3:7" of a byte offset.
std::string line_and_column(const std::string& text, std::size_t byte) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
    const auto line = 1 + std::count(text.begin(), end, '\n');
    const auto start = std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
    return std::to_string(line) + ":" + std::to_string(std::max<std::ptrdiff_t>(end - start, 1));
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
    for (const char* key : {"min", "max"})
        if (!abi->contains(key)) return fail(file + ": \"abi\" has no \"" + key + "\"");
    RESTAGE_TRY(out.abi_min, revision((*abi)["min"], "\"abi\".\"min\"", file));
    RESTAGE_TRY(out.abi_max, revision((*abi)["max"], "\"abi\".\"max\"", file));
    if (out.abi_min > out.abi_max) return fail(file + ": \"abi\": min is greater than max");
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
    json object;
    try {
        object = json::parse(text);
    } catch (const json::parse_error& e) {
        const std::string what =
            e.what(); // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error ..."
        const std::size_t colon = what.find(": ");
        return fail(file + ":" + line_and_column(text, e.byte) +
                    ": not JSON: " + (colon == std::string::npos ? what : what.substr(colon + 2)));
    }
    if (!object.is_object()) return fail(file + ": the manifest must be one JSON object { ... }");
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
