// SPDX-License-Identifier: Apache-2.0
// glTF files made in tests.
#pragma once

#include "model_files.hpp"

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace restage::tests {

using nlohmann::json;

inline std::string base64(const std::string& bytes) {
    static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
    return out;
}

template <class T>
std::string raw(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// A scene of one buffer: accessors are added with their bytes, the rest is JSON.
struct Builder {
    json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},  {"nodes", {{{"mesh", 0}, {"name", "thing"}}}},
                 {"accessors", json::array()},    {"bufferViews", json::array()}};
    std::string bytes;
    int view(const std::string& data) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
        bytes += data;
        return static_cast<int>(root["bufferViews"].size()) - 1;
    }
    int accessor(const std::string& data, int component, const char* type, std::size_t count) {
        root["accessors"].push_back(
            {{"bufferView", view(data)}, {"componentType", component}, {"type", type}, {"count", count}});
        return static_cast<int>(root["accessors"].size()) - 1;
    }
    int floats(const std::vector<float>& v, const char* type, std::size_t width) {
        return accessor(raw(v), 5126, type, v.size() / width);
    }
    Builder() { // a triangle with normals and texture coordinates
        const int p = floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3),
                  n = floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
        const int t = floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
        root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", t}}}}}}}};
    }
    std::string text() {
        root["buffers"] = {
            {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
        return root.dump(1);
    }
    io::ImportedScene load(const ModelFiles& files) {
        files.write("a.gltf", text());
        return files.load("a.gltf");
    }
    std::string error(const ModelFiles& files) {
        files.write("a.gltf", text());
        return files.error("a.gltf");
    }
};

inline const scene::Instance& thing(const io::ImportedScene& in, const char* name = "thing") {
    const auto id = scene::find_by_name<scene::Instance>(in.scene, name);
    if (!id) FAIL("there is no object " << name);
    return in.scene.instances[id];
}

} // namespace restage::tests
