// SPDX-License-Identifier: Apache-2.0
#include "render/pipeline_store.hpp"

#include "base/file.hpp"

namespace restage::render {
namespace {

std::uint64_t add(std::uint64_t hash, const gpu::ShaderSource& source) {
    hash = hash64(source.name, hash);
    hash = hash64(source.text, hash);
    for (const auto& dir : source.include_dirs)
        hash = hash64(dir.string(), hash);
    for (const auto& folder : source.plugin_folders)
        hash = hash64(folder.string(), hash);
    return hash;
}
template <class T>
std::uint64_t add(std::uint64_t hash, const std::vector<T>& values) {
    return hash64(values.data(), values.size() * sizeof(T), hash64(std::to_string(values.size()), hash));
}

} // namespace

std::uint64_t request_key(const gpu::ComputeRequest& r) {
    return add(add(r.push_constant_bytes, r.shader), r.constants);
}

std::uint64_t request_key(const gpu::RayTracingRequest& r) {
    std::uint64_t hash = add(add(r.push_constant_bytes, r.callables), r.constants);
    for (const auto& source : r.shaders)
        hash = add(hash, source);
    for (const auto& constants : r.callable_constants)
        hash = add(hash, constants);
    return hash;
}

} // namespace restage::render
