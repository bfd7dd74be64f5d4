// SPDX-License-Identifier: Apache-2.0
// Shared by the fuzz targets of importers: a host that accepts everything, and one file per process.
#pragma once

#include "common/picture.hpp"

#include <restage/image.h>
#include <restage/scene_io.h>
#include <unistd.h>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace restage::fuzz {

inline RestageHandle handles = 0;
template <class T>
RestageHandle take(void*, const T*) {
    return ++handles;
}
template <class T>
void ignore(void*, const T*) {}

inline RestageSceneWriter1 host() {
    return {.size = sizeof(RestageSceneWriter1),
            .ctx = nullptr,
            .mesh =
                [](void*, const RestageMesh* mesh) {
                    for (std::size_t i = 0; i < std::size_t{3} * mesh->triangle_count; ++i)
                        if (mesh->indices[i] >= mesh->vertex_count) std::abort(); // every host relies on this
                    return ++handles;
                },
            .image = take<RestageImage>,
            .texture = take<RestageTexture>,
            .material = take<RestageMaterialDesc>,
            .medium = take<RestageMedium>,
            .group = take<RestageGroup>,
            .instance = take<RestageInstance>,
            .light = take<RestageLight>,
            .environment = ignore<RestageEnvironment>,
            .camera = take<RestageCamera>,
            .camera_medium = [](void*, RestageHandle) {},
            .film = ignore<RestageFilm>,
            .settings = ignore<RestageSettings>,
            .report = [](void*, int, const char*, uint32_t, const char*, const char*) {},
            .error = [](void*, const char*, uint32_t, uint32_t, const char*) {},
            .progress = [](void*, float, const char*) { return 1; },
            .material_table = [](void*, const char*, uint32_t* count) -> const RestageParam* {
                *count = 0;
                return nullptr;
            }};
}

// Four texels for any bytes: the decoders have their own target (fuzz_image).
inline const RestageHost& services() {
    static constexpr uint8_t texels[16] = {0, 255, 128, 1, 255, 255, 255, 255, 9, 9, 9, 0, 130, 120, 250, 255};
    static const RestageImageService1 images{
        .size = sizeof(RestageImageService1),
        .decode =
            [](const RestageHost*, const void*, uint64_t, const char*, RestageDecodedImage* out) {
                *out = {.width = 2, .height = 2, .channels = 4, .bits = 8, .texels = texels, .problem = ""};
                return 1;
            },
        .release = [](const RestageHost*, RestageDecodedImage* image) { *image = {}; }};
    static const RestageHost host{RESTAGE_ABI, sizeof(RestageHost), "fuzz",
                                  [](const RestageHost*, const char* id) -> const void* {
                                      return std::string_view(id) == RESTAGE_IMAGE_SERVICE ? &images : nullptr;
                                  }};
    return host;
}

// Writes the bytes to a file with that extension and passes it to the importer. Text after a line "@@" goes into a
// second file, which the first can reference: "beside.mtl" or "beside.bin".
inline void import(const uint8_t* data, std::size_t size, const std::string& extension,
                   int (*load)(const char*, const RestageSceneWriter1*)) {
    static const std::filesystem::path folder = "/tmp/restage-fuzz-" + std::to_string(getpid());
    std::filesystem::create_directories(folder);
    const auto write = [](const std::filesystem::path& path, std::string_view text) {
        std::ofstream file(path, std::ios::binary);
        if (!file.write(text.data(), std::streamsize(text.size())).flush()) std::abort();
    };
    constexpr std::string_view mark = "\n@@\n";
    const std::string_view all(reinterpret_cast<const char*>(data), size);
    const std::size_t cut = all.find(mark);
    const std::string path = folder / ("model" + extension);
    write(path, all.substr(0, cut));
    write(folder / (extension == ".obj" ? "beside.mtl" : "beside.bin"),
          cut == all.npos ? std::string_view() : all.substr(cut + mark.size()));
    handles = 0;
    importing::use_host_pictures(&services());
    const RestageSceneWriter1 writer = host();
    load(path.c_str(), &writer);
}

} // namespace restage::fuzz
