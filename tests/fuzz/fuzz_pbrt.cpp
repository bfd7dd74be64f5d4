// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the pbrt importer, with a host that takes everything. Run: fuzz_pbrt tests/data/pbrt -rss_limit_mb=2048

#include <unistd.h>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <load.hpp>
#include <string>

namespace {

RestageHandle handles = 0;
template <class T>
RestageHandle take(void*, const T*) {
    return ++handles;
}
template <class T>
void ignore(void*, const T*) {}

RestageSceneWriter1 host() {
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
            }};
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    static const std::string path = "/tmp/restage-fuzz-" + std::to_string(getpid()) + ".pbrt"; // one file a process
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) std::abort();
    std::fwrite(data, 1, size, file);
    std::fclose(file);
    handles = 0;
    const RestageSceneWriter1 writer = host();
    restage::pbrt::load(path.c_str(), &writer);
    return 0;
}
