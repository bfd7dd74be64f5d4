// SPDX-License-Identifier: Apache-2.0
#include "assets.hpp"

#include "base/file.hpp"
#include "base/json.hpp"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

constexpr int deepest = 3;
constexpr std::size_t most_files = 5000; // of one folder

struct Section {
    const char* key;
    AssetKind kind;
};
constexpr Section sections[] = {{"scenes", AssetKind::scene},
                                {"skies", AssetKind::sky},
                                {"textures", AssetKind::texture},
                                {"meshes", AssetKind::mesh}};

fs::path from(const fs::path& config, const std::string& path) {
    const fs::path p(path);
    return (p.is_absolute() ? p : config.parent_path() / p).lexically_normal();
}

void add_once(std::vector<Asset>& all, Asset asset) {
    if (std::none_of(all.begin(), all.end(), [&](const Asset& a) { return a.path == asset.path; }))
        all.push_back(std::move(asset));
}

} // namespace

bool kind_of_file(const fs::path& file, AssetKind& kind) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    const auto is = [&](std::initializer_list<const char*> list) {
        return std::any_of(list.begin(), list.end(), [&](const char* e) { return extension == e; });
    };
    if (is({".pbrt", ".gltf", ".glb", ".restage"}))
        kind = AssetKind::scene;
    else if (is({".hdr", ".exr", ".pfm"}))
        kind = AssetKind::sky;
    else if (is({".png", ".jpg", ".jpeg", ".tga", ".bmp"}))
        kind = AssetKind::texture;
    else if (is({".ply", ".obj", ".stl"}))
        kind = AssetKind::mesh;
    else
        return false;
    return true;
}

bool plausible_sky(const fs::path& file, std::uint32_t width, std::uint32_t height) {
    const auto lower = [](std::string text) {
        std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
        return text;
    };
    const std::string extension = lower(file.extension().string()), stem = lower(file.stem().string());
    const auto says = [&](const std::string& where, std::initializer_list<const char*> words) {
        return std::any_of(words.begin(), words.end(), [&](const char* w) { return where.find(w) != where.npos; });
    };
    // Suffixes that mark surface maps, behind a separator: "brick_bump", "Brick-NormalGL".
    for (const char* map : {"bump", "normal", "nrm", "disp", "displacement", "height", "rough", "roughness", "metal",
                            "spec", "alpha", "mask", "opacity", "ao"})
        for (const char* before : {"_", "-", ".", " "})
            if (stem == map || says(stem, {(std::string(before) + map).c_str()})) return false;
    const bool wide_range = extension == ".hdr" || extension == ".exr" || extension == ".pfm";
    const bool named = says(stem + " " + lower(file.parent_path().filename().string()),
                            {"sky", "skies", "hdri", "env", "pano", "equirect", "studio", "infinite"});
    if (width == 0 || height == 0) return wide_range || named;
    const double aspect = double(width) / height;
    if (aspect > 1.9 && aspect < 2.1) return wide_range || named || width >= 2048;
    return width == height && wide_range && named;
}

std::vector<Asset> assets_in(const fs::path& folder) {
    std::vector<Asset> found;
    std::error_code error;
    std::size_t seen = 0;
    for (auto it = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
         !error && it != fs::recursive_directory_iterator() && seen < most_files; it.increment(error), ++seen) {
        if (it.depth() >= deepest) it.disable_recursion_pending();
        AssetKind kind{};
        if (it->is_regular_file(error) && kind_of_file(it->path(), kind))
            found.push_back({kind, it->path().string(), it->path().stem().string()});
    }
    std::sort(found.begin(), found.end(), [](const Asset& a, const Asset& b) { return a.path < b.path; });
    return found;
}

Result<std::vector<Asset>> read_assets(const fs::path& config, std::vector<std::string>* folders) {
    std::vector<Asset> all;
    std::error_code none;
    if (!fs::exists(config, none)) return all;
    RESTAGE_TRY(const std::string text, read_file(config.string()));
    const auto json = parse_json<nlohmann::json>(text).value_or(nlohmann::json());
    if (!json.is_object()) return fail(config.string() + ": not a JSON object; README.md describes the format");
    const auto list = [&](const char* key, auto&& add) -> Result<void> {
        const auto found = json.find(key);
        if (found == json.end()) return {};
        if (!found->is_array()) return fail(config.string() + ": \"" + key + "\" must be a list of paths");
        for (const auto& entry : *found) {
            if (!entry.is_string()) return fail(config.string() + ": \"" + key + "\" must be a list of paths");
            add(from(config, entry.get<std::string>()));
        }
        return {};
    };
    for (const Section& section : sections)
        RESTAGE_CHECK(list(section.key, [&](const fs::path& path) {
            if (fs::exists(path, none)) add_once(all, {section.kind, path.string(), path.stem().string()});
        }));
    RESTAGE_CHECK(list("folders", [&](const fs::path& folder) {
        if (folders) folders->push_back(folder.string());
        for (Asset& asset : assets_in(folder))
            add_once(all, std::move(asset));
    }));
    return all;
}

Result<void> add_asset_folder(const fs::path& config, const fs::path& folder) {
    nlohmann::json json = nlohmann::json::object();
    std::error_code none;
    if (fs::exists(config, none)) {
        RESTAGE_TRY(const std::string text, read_file(config.string()));
        json = parse_json<nlohmann::json>(text).value_or(nlohmann::json());
        if (!json.is_object()) return fail(config.string() + ": not a JSON object; not changed");
    }
    if (!json["folders"].is_array()) json["folders"] = nlohmann::json::array();
    if (std::find(json["folders"].begin(), json["folders"].end(), folder.string()) != json["folders"].end()) return {};
    json["folders"].push_back(folder.string());
    return write_file_atomic(config.string(), json.dump(2) + "\n");
}

} // namespace restage::editor
