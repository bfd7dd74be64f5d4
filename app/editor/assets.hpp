// SPDX-License-Identifier: Apache-2.0
// Assets: available scenes, skies, textures and meshes, from assets.json in the configuration folder and
// next to the program, and from folders:
//   { "folders": ["/data/textures"], "scenes": ["room.pbrt"], "skies": ["noon.exr"], "textures": [], "meshes":
//   ["cup.ply"] }
// Paths are relative to the file. The kind of a file in a folder follows from its name: HDR images are skies.
#pragma once

#include "base/result.hpp"
#include "texture.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace restage::editor {

enum class AssetKind { scene, sky, texture, mesh };

struct Asset {
    AssetKind kind = AssetKind::texture;
    std::string path, name;
};

// By the extension; false = not an asset.
bool kind_of_file(const std::filesystem::path& file, AssetKind& kind);
// Whether an image may be a sky: a panorama is twice as wide as high; a square one (octahedral) is distinguished from
// a texture by its range and by its name or folder. Sizes of 0 are not known yet.
bool plausible_sky(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height);
// The assets that the file lists, in order; folders are searched three levels deep. Missing files are omitted.
Result<std::vector<Asset>> read_assets(const std::filesystem::path& config,
                                       std::vector<std::string>* folders = nullptr);
std::vector<Asset> assets_in(const std::filesystem::path& folder);
// Adds a folder to the file, which is created if missing.
Result<void> add_asset_folder(const std::filesystem::path& config, const std::filesystem::path& folder);

struct AssetsState { // of the panel
    bool loaded = false;
    std::vector<Asset> entries;
    std::vector<std::string> folders;
    int kind = 0; // shown: 0 = all, else AssetKind + 1
    std::string search;
    struct Thumbnail {
        bool asked = false, failed = false;
        std::unique_ptr<Texture> texture;
        ImVec2 size{0, 0};
    };
    std::map<std::string, Thumbnail> thumbnails;

    std::vector<std::string> files_of(AssetKind wanted) const {
        std::vector<std::string> found;
        for (const Asset& asset : entries)
            if (asset.kind == wanted) found.push_back(asset.path);
        return found;
    }
};

} // namespace restage::editor
