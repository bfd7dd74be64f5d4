// SPDX-License-Identifier: Apache-2.0
#include "render/gpu_scene.hpp"

#include "render/filter_table.hpp"
#include "shared/hash.h"
#include "shared/normal.h"

#include <glm/gtc/packing.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace restage::render {

using scene::Id;
using scene::Scene;

static_assert(sizeof(shared::InstanceData) == 184);
static_assert(sizeof(shared::QuadricData) == 40);
static_assert(sizeof(shared::MaterialData) == 32);
static_assert(sizeof(shared::LightData) == 72);
static_assert(sizeof(shared::LightNode) == 60);
static_assert(sizeof(shared::ImageData) == 24);

GpuScene::GpuScene(gpu::Device& device, Jobs& jobs, MaterialLookup lookup, Strategy strategy)
    : device_(&device), jobs_(&jobs), lookup_(std::move(lookup)), strategy_(strategy), tables_(device) {
    scene_data_.resize(1, {});
}

const GpuMesh* GpuScene::mesh(Id<scene::Mesh> id) const {
    const auto it = meshes_.find(id.value);
    return it == meshes_.end() ? nullptr : &it->second;
}

Result<SceneChanges> GpuScene::sync(const Scene& scene) {
    SceneChanges changes;
    const std::size_t uploaded_before = uploaded_bytes();
    if (!have_origin_) {
        if (const auto* camera = scene.cameras.find(scene.active_camera.value))
            origin_ = glm::dvec3(camera->camera_to_world[3]);
        have_origin_ = true;
    }
    const bool colors = change_colors(scene);
    if (colors) seen_.instances = 0; // their emission is stored differently
    const bool meshes = first_ || scene.meshes.version() != seen_.meshes;
    const bool images = first_ || scene.images.version() != seen_.images;
    bool other_words = false; // of texture plugins
    const bool texture_plugins = refresh_texture_types(texture_types_, lookup_.textures, other_words);
    const bool textures = images || scene.textures.version() != seen_.textures || other_words;
    const bool plugins = refresh_types() || texture_plugins;
    const bool materials = first_ || colors || scene.materials.version() != seen_.materials || textures || plugins;
    const bool instances = first_ || meshes || scene.instances.version() != seen_.instances;
    const bool lights = instances || colors || images || scene.lights.version() != seen_.lights ||
                        scene.environment.version != seen_.environment || scene.meshes.version() != seen_.meshes;
    if (meshes) RESTAGE_CHECK(sync_meshes(scene, changes));
    if (textures) RESTAGE_CHECK(sync_textures(scene, changes));
    // An instance may add a type. Otherwise only changes are processed.
    const bool all = meshes || materials || !same_materials_in_use(scene);
    if (instances && !all)
        std::ranges::fill(emission_changed_, char(0));
    else if (materials || instances)
        RESTAGE_CHECK(sync_materials(scene, changes));
    if (instances || materials) RESTAGE_CHECK(sync_instances(scene, changes, all));
    if (textures || instances || materials) find_undecided();
    if (lights || !changes.instances.empty() || (textures && (features_.emission_textures || features_.light_alpha)))
        RESTAGE_CHECK(sync_lights(
            scene, changes,
            all || colors || scene.lights.version() != seen_.lights || scene.environment.version != seen_.environment));
    RESTAGE_CHECK(sync_root(scene, changes, colors));
    changes.shaders |= plugins;
    changes.film = first_ || scene.film.version != seen_.film;
    // A name, a group, an inactive camera: not on the device, and invisible.
    changes.image = changes.image || changes.film || changes.shaders || !changes.meshes.empty() ||
                    !changes.instances.empty() || uploaded_bytes() != uploaded_before;
    seen_ = {.meshes = scene.meshes.version(),
             .images = scene.images.version(),
             .textures = scene.textures.version(),
             .materials = scene.materials.version(),
             .instances = scene.instances.version(),
             .lights = scene.lights.version(),
             .media = scene.media.version(),
             .cameras = scene.cameras.version(),
             .environment = scene.environment.version,
             .active_camera = scene.active_camera.version,
             .film = scene.film.version};
    first_ = false;
    return changes;
}

namespace {

shared::QuadricData quadric_data(const scene::Quadric& q) {
    const bool sphere = q.kind == scene::Quadric::Kind::sphere;
    return {.kind = sphere                                 ? QUADRIC_SPHERE
                    : q.kind == scene::Quadric::Kind::disk ? QUADRIC_DISK
                                                           : QUADRIC_CYLINDER,
            .whole = q.whole_sphere() ? 1u : 0u,
            .radius = float(q.radius),
            .z_min = float(q.z_min),
            .z_max = float(q.z_max),
            .inner = float(q.inner),
            .phi_max = float(q.phi_max),
            .theta_min = sphere ? float(std::acos(q.z_min / q.radius)) : 0,
            .theta_max = sphere ? float(std::acos(q.z_max / q.radius)) : 0,
            .area = float(q.area())};
}

} // namespace

Result<void> GpuScene::sync_meshes(const Scene& scene, SceneChanges& changes) {
    mesh_data_.resize(scene.meshes.size() + 1);
    for (std::uint32_t i = 1; i <= scene.meshes.size(); ++i) {
        const Id<scene::Mesh> id{i};
        const auto* mesh = scene.meshes.find(id);
        if (!mesh || !mesh->data || mesh->data->triangles.empty()) {
            if (meshes_.erase(i)) changes.meshes.push_back(id);
            mesh_data_[i].reset();
            continue;
        }
        if (mesh_data_[i] == mesh->data && meshes_.contains(i)) continue; // e.g. a rename
        const scene::MeshData& data = *mesh->data;
        GpuMesh g;
        g.version = scene.meshes.version(id);
        g.quadric = scene::quadric_of(*mesh);
        if (g.quadric) {
            // A shader made before the scene had quadrics takes it for a triangle until its successor is compiled: it
            // finds one, of whatever the record holds.
            const struct {
                shared::QuadricData quadric;
                std::uint32_t unused[2], corners[4];
            } record{quadric_data(*g.quadric), {}, {0, 1, 2, 0}};
            RESTAGE_TRY(g.buffer, device_->create_buffer(sizeof record, gpu::BufferKind::host, mesh->name.c_str()));
            RESTAGE_CHECK(device_->upload(g.buffer, 0, std::as_bytes(std::span(&record, 1))));
            g.positions = g.buffer.address();
            g.indices = g.positions + offsetof(decltype(record), corners);
            meshes_[i] = std::move(g);
            mesh_data_[i] = mesh->data;
            changes.meshes.push_back(id);
            continue;
        }
        std::size_t at = 0;
        const auto place = [&](std::size_t bytes) {
            const std::size_t here = at;
            at = (at + bytes + 16 + 15) & ~std::size_t(15); // Embree reads up to 16 bytes past the end
            return bytes ? here : std::size_t(-1);
        };
        const auto positions = place(std::span(data.positions).size_bytes());
        const auto indices = place(std::span(data.triangles).size_bytes());
        const auto normals = place(std::span(data.normals).size_bytes());
        const auto uvs = place(std::span(data.uvs).size_bytes());
        const auto uvs2 = place(std::span(data.uvs2).size_bytes());
        const auto tangents = place(std::span(data.tangents).size_bytes());
        RESTAGE_TRY(g.buffer, device_->create_buffer(at, gpu::BufferKind::host, mesh->name.c_str()));
        const auto put = [&](std::size_t offset, std::span<const std::byte> bytes,
                             std::uint64_t& address) -> Result<void> {
            if (bytes.empty()) return {};
            address = g.buffer.address() + offset;
            return device_->upload(g.buffer, offset, bytes);
        };
        RESTAGE_CHECK(put(positions, std::as_bytes(std::span(data.positions)), g.positions));
        RESTAGE_CHECK(put(indices, std::as_bytes(std::span(data.triangles)), g.indices));
        RESTAGE_CHECK(put(normals, std::as_bytes(std::span(data.normals)), g.normals));
        RESTAGE_CHECK(put(uvs, std::as_bytes(std::span(data.uvs)), g.uvs));
        RESTAGE_CHECK(put(uvs2, std::as_bytes(std::span(data.uvs2)), g.uvs2));
        RESTAGE_CHECK(put(tangents, std::as_bytes(std::span(data.tangents)), g.tangents));
        g.positions_offset = positions;
        g.indices_offset = indices;
        g.vertex_count = std::uint32_t(data.positions.size());
        g.triangle_count = std::uint32_t(data.triangles.size());
        meshes_[i] = std::move(g);
        mesh_data_[i] = mesh->data;
        changes.meshes.push_back(id);
    }
    return {};
}

Result<void> GpuScene::upload_image(const scene::Image& image, Pixels& out, SceneChanges& changes) {
    changes.image = true;
    out.clean = image.data;
    float largest = 0;
    std::size_t bad = 0;
    for (float v : image.data->values)
        if (std::isfinite(v))
            largest = std::max(largest, std::abs(v));
        else
            ++bad;
    if (bad > 0) { // filtering would spread them to neighbours, and clamps in materials would hide them
        auto mended = std::make_shared<scene::PixelData>(*image.data);
        for (float& v : mended->values)
            if (!std::isfinite(v)) v = 0;
        out.clean = mended;
        changes.warnings.push_back(fmt::format("image \"{}\": {} of {} values are not finite numbers; replaced by 0",
                                               image.name, bad, image.data->values.size()));
    }
    const scene::PixelData& pixels = *out.clean;
    const std::size_t n = std::size_t(pixels.width) * pixels.height;
    const bool half = largest < 65504.f; // the largest half
    RESTAGE_TRY(out.buffer, device_->create_buffer(n * (half ? 8 : 16), gpu::BufferKind::host, image.name.c_str()));
    std::vector<std::byte> staging;
    std::byte* target = out.buffer.mapped();
    if (!target) {
        staging.resize(out.buffer.size());
        target = staging.data();
    }
    jobs_->parallel_for(n, 1 << 14, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const float* v = &pixels.values[i * pixels.channels];
            const glm::vec4 c = pixels.channels == 1   ? glm::vec4(v[0], v[0], v[0], 1)
                                : pixels.channels == 3 ? glm::vec4(v[0], v[1], v[2], 1)
                                                       : glm::vec4(v[0], v[1], v[2], v[3]);
            if (half) {
                const std::uint32_t h[2] = {glm::packHalf2x16({c.x, c.y}), glm::packHalf2x16({c.z, c.w})};
                std::memcpy(target + i * 8, h, 8);
            } else {
                std::memcpy(target + i * 16, &c.x, 16);
            }
        }
    });
    if (!staging.empty()) RESTAGE_CHECK(device_->upload(out.buffer, 0, staging));
    out.data = image.data;
    return {};
}

Result<void> GpuScene::sync_textures(const Scene& scene, SceneChanges& changes) {
    pixels_.resize(scene.images.size() + 1);
    cpu_images_.resize(pixels_.size());
    std::vector<char> used(pixels_.size());
    scene.textures.each([&](Id<scene::Texture>, const scene::Texture& t) {
        if (t.image) used[t.image.value] = 1;
    });
    images_.resize(pixels_.size(), {});
    for (std::uint32_t i = 1; i < pixels_.size(); ++i) {
        const auto* image = scene.images.find({i});
        if (!image || !image->data || !used[i]) {
            pixels_[i] = {};
            cpu_images_[i] = {};
            continue;
        }
        if (pixels_[i].data == image->data) continue;
        RESTAGE_CHECK(upload_image(*image, pixels_[i], changes));
        cpu_images_[i].pixels = pixels_[i].clean.get();
        const std::size_t n = std::size_t(image->data->width) * image->data->height;
        images_.set(i, {pixels_[i].buffer.address(), image->data->width, image->data->height,
                        pixels_[i].buffer.size() == n * 8 ? TEXEL_HALF4 : TEXEL_FLOAT4, 0});
    }
    const std::size_t types = texture_types_.size();
    textures_ = compile_textures(scene, texture_types_, lookup_.textures);
    for (std::size_t i = types; i < texture_types_.size(); ++i)
        changes.shaders |= texture_types_[i].composed();
    programs_.assign(textures_.programs);
    texture_words_.assign(textures_.words);
    RESTAGE_CHECK(images_.flush(*device_));
    RESTAGE_CHECK(programs_.flush(*device_));
    return texture_words_.flush(*device_);
}

glm::vec4 GpuScene::uv_at(const shared::InstanceData& instance, const scene::MeshData& mesh, std::uint32_t prim,
                          glm::vec2 b) const {
    if (!(instance.flags & INSTANCE_HAS_UVS) && !instance.uvs2) return {b, b};
    const auto t = mesh.triangles[prim];
    const auto mix = [&](const std::vector<glm::vec2>& uvs) {
        return (1 - b.x - b.y) * uvs[t.x] + b.x * uvs[t.y] + b.y * uvs[t.z];
    };
    const glm::vec2 first = instance.flags & INSTANCE_HAS_UVS ? mix(mesh.uvs) : b;
    return {first, instance.uvs2 ? mix(mesh.uvs2) : first};
}

// See hit_alpha in shaders/lib/texture.glsl.
float GpuScene::alpha_at(const shared::InstanceData& instance, const scene::MeshData& mesh, std::uint32_t prim,
                         glm::vec2 bary) const {
    float alpha = instance.alpha;
    if (instance.alpha_texture)
        alpha = evaluate_texture(textures_, cpu_images_, instance.alpha_texture, uv_at(instance, mesh, prim, bary)).x;
    if (instance.flags & INSTANCE_ALPHA_MASK) return alpha > 0 ? 1.f : 0.f;
    return alpha > 0 ? std::min(alpha, 1.f) : 0.f;
}

void GpuScene::find_undecided() {
    undecided_.clear();
    const auto open = [&](std::uint32_t texture) {
        return texture < textures_.native.size() && textures_.native[texture].count > 0 &&
               !textures_.native[texture].there;
    };
    bool some = false;
    for (std::uint32_t t = 1; t < textures_.native.size(); ++t)
        some |= open(t);
    if (!some) return;
    std::vector<char> mixes(materials_.size());
    for (int depth = 0; depth < 8; ++depth) // as deep as mixes are resolved
        for (std::size_t m = 0; m < mixes.size(); ++m) {
            if (!(materials_[m].flags & MATERIAL_MIX)) continue;
            mixes[m] = open(mix_texture_[m]);
            for (const auto child : {materials_[m].mix_first, materials_[m].mix_second})
                if (child != MATERIAL_NOTHING && mixes[child]) mixes[m] = 1;
        }
    undecided_.resize(instances_.size());
    some = false;
    for (std::size_t i = 0; i < undecided_.size(); ++i)
        some |= undecided_[i] = open(instances_[i].alpha_texture) || mixes[instances_[i].material];
    if (!some) undecided_.clear();
}

bool GpuScene::stops(std::uint32_t id, std::uint32_t choice, const shared::HitDecided& hit, const glm::vec3& origin,
                     const glm::vec3& direction) const {
    if (hit.material == MATERIAL_NOTHING) return false;
    if (hit.alpha >= 1) return true;
    return hit.alpha > 0 && shared::alpha_choice(origin, direction, id, choice) < hit.alpha;
}

bool GpuScene::alpha_passes(std::uint32_t id, std::uint32_t prim, glm::vec2 bary, const float* o,
                            const float* d) const {
    const float alpha = alpha_at(instances_[id], *mesh_data_[mesh_of_[id].value], prim, bary);
    if (alpha >= 1) return true;
    return alpha > 0 && shared::alpha_choice({o[0], o[1], o[2]}, {d[0], d[1], d[2]}, id, prim) < alpha;
}

std::uint32_t GpuScene::resolve_material(std::uint32_t id, std::uint32_t prim, glm::vec2 bary) const {
    const auto& instance = instances_[id];
    std::uint32_t m = instance.material;
    for (int depth = 0; depth < 8 && types_[materials_[m].type].mix(); ++depth) {
        float amount = mix_amount_[m];
        if (mix_texture_[m])
            amount = evaluate_texture(textures_, cpu_images_, mix_texture_[m],
                                      uv_at(instance, *mesh_data_[mesh_of_[id].value], prim, bary))
                         .x;
        const bool second = shared::mix_choice(bary, prim, std::uint32_t(depth)) < amount;
        m = second ? materials_[m].mix_second : materials_[m].mix_first;
        if (m == MATERIAL_NOTHING) return m;
    }
    return types_[materials_[m].type].mix() ? 0 : m; // deeper than 8: the placeholder
}

std::uint32_t GpuScene::medium_behind(std::uint32_t id, std::uint32_t prim, glm::vec2 b,
                                      const glm::vec3& direction) const {
    const auto& instance = instances_[id];
    if (is_quadric(id)) {
        const auto& q = *mesh(mesh_of_[id])->quadric;
        const glm::vec3 n = instance.normal_to_world * glm::vec3(q.normal(q.at(b)));
        const bool out = glm::dot(direction, n) > 0;
        return out == !(instance.flags & INSTANCE_FLIP_NORMAL) ? instance.exterior : instance.interior;
    }
    const auto& mesh = *mesh_data_[mesh_of_[id].value];
    const auto t = mesh.triangles[prim];
    const glm::vec3 p0 = mesh.positions[t.x];
    glm::vec3 n = instance.normal_to_world * glm::cross(mesh.positions[t.y] - p0, mesh.positions[t.z] - p0);
    float along = 0;
    if (!mesh.normals.empty()) {
        const glm::vec3 s = (1 - b.x - b.y) * mesh.normals[t.x] + b.x * mesh.normals[t.y] + b.y * mesh.normals[t.z];
        along = glm::dot(instance.normal_to_world * s, n);
    }
    if (shared::points_inward(along, instance.flags & INSTANCE_FLIP_NORMAL)) n = -n;
    return glm::dot(direction, n) > 0 ? instance.exterior : instance.interior;
}

std::size_t GpuScene::bytes() const {
    std::size_t sum = instances_.size() * sizeof(shared::InstanceData) + lights_.size() * sizeof(shared::LightData) +
                      env_texels_.size() * sizeof(glm::vec4) +
                      (env_rows_.size() + env_columns_.size() + light_cdf_.size()) * sizeof(shared::CdfEntry) +
                      light_nodes_.size() * sizeof(shared::LightNode);
    sum += color_cells_.size() * sizeof(glm::uvec2) + color_film_.size() * sizeof(glm::vec4) +
           curve_entries_.size() * sizeof(glm::vec2);
    for (const auto& [id, mesh] : meshes_)
        sum += mesh.buffer.size();
    for (const auto& p : pixels_)
        sum += p.buffer.size();
    return sum + tables_.bytes();
}

std::size_t GpuScene::uploaded_bytes() const {
    return instances_.uploaded_bytes() + materials_.uploaded_bytes() + params_.uploaded_bytes() +
           programs_.uploaded_bytes() + texture_words_.uploaded_bytes() + images_.uploaded_bytes() +
           lights_.uploaded_bytes() + light_cdf_.uploaded_bytes() + light_nodes_.uploaded_bytes() +
           media_.uploaded_bytes() + env_texels_.uploaded_bytes() + env_rows_.uploaded_bytes() +
           env_columns_.uploaded_bytes() + filter_.uploaded_bytes() + scene_data_.uploaded_bytes() +
           color_cells_.uploaded_bytes() + color_film_.uploaded_bytes() + curve_entries_.uploaded_bytes() +
           tables_.uploaded_bytes();
}

} // namespace restage::render
