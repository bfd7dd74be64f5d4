// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets of importers share: a host that takes everything, and one file a process.
#pragma once

#include <restage/scene_io.h>
#include <unistd.h>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

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
                        if (mesh->indices[i] >= mesh->vertex_count) std::abort(); // what every host relies on
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
            },
            .decode_image =
                [](void*, const void*, size_t, const char*, RestageDecodedImage* out) {
                    // Four texels, whatever the bytes: the decoders have a target of their own (fuzz_image).
                    static constexpr uint8_t texels[16] = {0, 255, 128, 1, 255, 255, 255, 255,
                                                           9, 9,   9,   0, 130, 120, 250, 255};
                    *out = {2, 2, 4, 8, texels, "", nullptr};
                    return 1;
                },
            .release_image = [](void*, RestageDecodedImage* image) { *image = {}; }};
}

// Writes the bytes to a file with that extension and hands it to the importer.
inline void import(const uint8_t* data, std::size_t size, const char* extension,
                   int (*load)(const char*, const RestageSceneWriter1*)) {
    static const std::string path = "/tmp/restage-fuzz-" + std::to_string(getpid()) + extension;
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) std::abort();
    std::fwrite(data, 1, size, file);
    std::fclose(file);
    handles = 0;
    const RestageSceneWriter1 writer = host();
    load(path.c_str(), &writer);
}

} // namespace restage::fuzz
