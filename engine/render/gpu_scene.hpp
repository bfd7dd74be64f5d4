// SPDX-License-Identifier: Apache-2.0
// GpuScene: the scene for tracers, derived from a scene::Scene by comparing version counters. Moving one of many
// instances rewrites one record. World space is relative to origin(), the camera's position when the scene was opened.
// One thread at a time; no work that reads it may be running during sync().
#pragma once

#include "base/jobs.hpp"
#include "gpu/device.hpp"
#include "render/environment_map.hpp"
#include "render/gpu_array.hpp"
#include "render/grey.hpp"
#include "render/light_table.hpp"
#include "render/material_composer.hpp"
#include "render/renderer_options.hpp"
#include "render/spectral_colors.hpp"
#include "render/table_store.hpp"
#include "render/texture_program.hpp"
#include "scene/emission.hpp"
#include "scene/quadric.hpp"
#include "scene/scene.hpp"
#include "shared/wave_data.h"

#include <map>
#include <memory>
#include <tuple>
#include <unordered_map>

namespace restage::render {

// A mesh in memory shared by Embree, kernels and acceleration structure builds.
struct GpuMesh {
    gpu::Buffer buffer; // positions, normals, uvs, indices, tangents, uvs2, each 16-byte aligned
    std::uint64_t positions = 0, normals = 0, uvs = 0, indices = 0, tangents = 0, uvs2 = 0; // addresses; 0 = none
    std::size_t positions_offset = 0, indices_offset = 0;           // in the buffer, for Embree
    std::uint32_t vertex_count = 0, triangle_count = 0;
    std::optional<scene::Quadric> quadric; // if set, there are no triangles: `positions` is a QuadricData
    scene::Version version = 0;
};

// Changes found by a sync; tracers update themselves from it.
struct SceneChanges {
    bool image = false;    // anything that changes the picture: the film restarts
    bool shaders = false;  // material types or features: pipelines
    std::vector<scene::Id<scene::Mesh>> meshes;         // new or replaced
    std::vector<scene::Id<scene::Instance>> instances;  // moved, added, removed, shown, hidden; mesh replaced
    bool film = false;     // size or crop
    std::vector<std::string> warnings; // about replaced values: non-finite texels, unreadable tables
};

class GpuScene {
  public:
    GpuScene(gpu::Device& device, Jobs& jobs, MaterialLookup lookup, Strategy strategy = Strategy::mis);

    // Returns the changes. After an error the GpuScene must not be traced.
    Result<SceneChanges> sync(const scene::Scene& scene);

    std::uint64_t address() const { return scene_data_.address(); } // of shared::SceneData
    const shared::SceneData& data() const { return scene_data_[0]; }
    const glm::dvec3& origin() const { return origin_; }
    const SceneFeatures& features() const { return features_; }

    // By index into types(), as in shared::MaterialData::type. Indices are stable for the scene's lifetime.
    const std::vector<MaterialType>& types() const { return types_; }
    // The types that the scene's textures have, or had; index + 1 is the kind of an operation.
    const TextureTypes& texture_types() const { return texture_types_; }
    const std::vector<shared::MaterialData>& materials() const { return materials_.host(); }
    const std::vector<shared::InstanceData>& instances() const { return instances_.host(); } // by Id::value
    bool all_caustics() const { return all_caustics_; } // photons start from every light, not just where it pays
    bool sunny() const { return environment_.focus > 0.5f; } // paths rarely find most of the environment's light
    const std::vector<shared::LightData>& lights() const { return lights_.host(); }
    const std::vector<shared::LightNode>& light_nodes() const { return light_nodes_.host(); }
    const GpuMesh* mesh(scene::Id<scene::Mesh> id) const;
    const scene::MeshData* mesh_data(scene::Id<scene::Mesh> id) const { return mesh_data_[id.value].get(); }
    // Whether rays can hit this instance.
    bool traced(std::uint32_t instance) const { return traced_[instance] != 0; }
    bool any_traced() const { return counts_.traced > 0; }
    // No query needs to know its ray: no cut-outs, quadrics, ...
    bool plain_hits() const { return counts_.not_plain == 0; }
    // Whether it blocks shadow rays: true for everything that rays can hit, except lamps without a surface.
    bool opaque(std::uint32_t instance) const {
        return traced(instance) && !(instances()[instance].flags & INSTANCE_PASSES);
    }
    // Whether it is, or part of it is, a border of media that rays pass.
    bool border(std::uint32_t instance) const { return border_[instance] != 0; }
    scene::Id<scene::Mesh> mesh_of(std::uint32_t instance) const { return mesh_of_[instance]; }
    bool is_quadric(std::uint32_t instance) const { return instances()[instance].flags & INSTANCE_QUADRIC; }
    // The transform of its geometry: of the mesh, or for a quadric of the box [-1, 1]^3 that encloses it with a margin.
    glm::mat4x3 placement(std::uint32_t instance) const;

    // Ray-quadric intersection in double precision, with the shaders' matrices: hits within (t_min, t_max)
    // and their (u, v), nearest first. Returns their number.
    struct QuadricHit {
        float t = 0;
        glm::vec2 uv{0};
        std::uint32_t leaves = 0; // 1: leaving; alpha choices treat entry and exit as different surfaces
    };
    int meet_quadric(std::uint32_t instance, const glm::vec3& origin, const glm::vec3& direction, glm::vec2 range,
                     QuadricHit (&hits)[2]) const;

    // Resolved on the CPU at a hit (thread-safe).
    bool alpha_passes(std::uint32_t instance, std::uint32_t prim, glm::vec2 bary, const float* org,
                      const float* dir) const;
    // The material of a hit, through mixes; MATERIAL_NOTHING if there is no surface.
    std::uint32_t resolve_material(std::uint32_t instance, std::uint32_t prim, glm::vec2 bary) const;
    // Whether a texture that decides its hits (alpha, mixes) has no native code. For these, the two functions above use
    // the texture's average; wave_decide.comp is exact.
    bool undecided(std::uint32_t instance) const { return !undecided_.empty() && undecided_[instance]; }
    bool any_undecided() const { return !undecided_.empty(); }
    // Whether it stops a ray here, given its alpha and its material. `choice`: the primitive; of quadrics, see
    // QuadricHit.
    bool stops(std::uint32_t instance, std::uint32_t choice, const shared::HitDecided&, const glm::vec3& origin,
               const glm::vec3& direction) const;
    // The medium that a ray enters at a border.
    std::uint32_t medium_behind(std::uint32_t instance, std::uint32_t prim, glm::vec2 bary,
                                const glm::vec3& direction) const;
    // Its absorption in RGB (x, y, z), or in spectral mode at the wavelengths that `hero` chooses.
    glm::vec4 absorption(std::uint32_t medium, float hero) const {
        const glm::vec3& stored = media_[medium].sigma_a;
        return features_.spectral ? spectrum_at(stored, hero, curves_.entries()) : glm::vec4(stored, 0);
    }

    std::size_t bytes() const; // of device memory
    std::size_t uploaded_bytes() const;

  private:
    struct Pixels {
        gpu::Buffer buffer;
        scene::Version version = 0;
        std::shared_ptr<const scene::PixelData> data; // of the scene
        std::shared_ptr<const scene::PixelData> clean; // the same, or a copy with non-finite values set to 0
    };
    bool change_colors(const scene::Scene&); // true: the mode changed, and with it all stored colours
    Result<void> sync_spectral();
    glm::vec3 stored_absorption(const scene::Medium&);
    ValueStore value_store(const scene::Origin&, bool& curves); // curves: set if it stores one
    glm::vec3 stored_light(const scene::Origin&, std::string_view id, const glm::vec3& rgb);
    Result<void> sync_meshes(const scene::Scene&, SceneChanges&);
    Result<void> sync_textures(const scene::Scene&, SceneChanges&);
    Result<void> sync_materials(const scene::Scene&, SceneChanges&);
    bool same_materials_in_use(const scene::Scene&) const; // although instances changed
    Result<void> sync_instances(const scene::Scene&, SceneChanges&, bool all);
    Result<void> flush_lights();
    Result<void> sync_lights(const scene::Scene&, SceneChanges&, bool all);
    void find_undecided();
    Result<void> sync_root(const scene::Scene&, SceneChanges&, bool colors);
    Result<void> upload_image(const scene::Image&, Pixels&, SceneChanges&);
    void count(std::uint32_t instance, std::uint32_t by);
    std::uint32_t type_index(const std::string& type);
    bool refresh_types();
    // An instance's effective emission: its own, else its material's.
    std::optional<scene::MaterialEmission> emission_of(const scene::Scene&, const scene::Instance&) const;
    double mean_emission(std::uint32_t instance, const glm::vec3& radiance, std::uint32_t triangle,
                         int points) const; // luminance
    float alpha_at(const shared::InstanceData&, const scene::MeshData&, std::uint32_t prim, glm::vec2 bary) const;
    std::optional<Emitter> emitter_of(const scene::Scene&, scene::Id<scene::Instance>) const;
    shared::InstanceData make_instance(const scene::Scene&, std::uint32_t id, const scene::Instance&);
    // Both sets, like hit_uv in shaders/lib/scene.glsl.
    glm::vec4 uv_at(const shared::InstanceData&, const scene::MeshData&, std::uint32_t prim, glm::vec2 bary) const;

    gpu::Device* device_;
    Jobs* jobs_;
    MaterialLookup lookup_;
    Strategy strategy_;
    glm::dvec3 origin_{0};
    bool have_origin_ = false;
    SceneFeatures features_;

    std::unordered_map<std::uint32_t, GpuMesh> meshes_;
    std::vector<std::shared_ptr<const scene::MeshData>> mesh_data_; // by Id<Mesh>::value
    std::vector<Pixels> pixels_; // by Id<Image>::value
    std::vector<CpuImage> cpu_images_;
    TextureTypes texture_types_;
    TexturePrograms textures_;
    TableStore tables_;
    std::map<std::uint32_t, std::string> said_; // current warnings by material id
    std::vector<MaterialType> types_;
    std::vector<float> mix_amount_; // constants by MaterialData index
    std::vector<std::uint32_t> mix_texture_;
    std::vector<std::optional<scene::MaterialEmission>> emission_; // by MaterialData index
    std::vector<char> emission_changed_; // likewise, since the last sync
    std::vector<char> has_gaps_; // by MaterialData index: a mix with a null component
    // By Id<Instance>::value:
    std::vector<char> traced_, border_, flat_; // flat: rays cannot be transformed to its object space
    std::vector<char> quadric_; // and shown
    std::vector<char> undecided_; // empty: none is
    std::vector<scene::Id<scene::Mesh>> mesh_of_;
    std::vector<std::uint32_t> used_material_; // of visible instances; 0 = none
    EnvironmentMap environment_;

    const SpectralColors* colors_ = nullptr; // in spectral mode
    SpectralCurves curves_;
    GreyTest grey_;
    bool light_curves_ = false; // of SceneFeatures

    GpuArray<glm::uvec2> color_cells_{"coefficients of spectra"};
    GpuArray<glm::vec4> color_film_{"film of spectra"};
    GpuArray<glm::vec2> curve_entries_{"measured spectra"};
    GpuArray<shared::InstanceData> instances_{"instances"};
    GpuArray<shared::MaterialData> materials_{"materials"};
    GpuArray<std::uint32_t> params_{"material parameters"};
    GpuArray<shared::TextureProgram> programs_{"textures"};
    GpuArray<std::uint32_t> texture_words_{"texture operations"};
    GpuArray<shared::ImageData> images_{"images"};
    GpuArray<shared::LightData> lights_{"lights"};
    GpuArray<shared::CdfEntry> light_cdf_{"distributions over emitters"};
    GpuArray<shared::LightNode> light_nodes_{"light tree"};
    GpuArray<shared::MediumData> media_{"media"};
    GpuArray<glm::vec4> env_texels_{"environment"};
    GpuArray<shared::CdfEntry> env_rows_{"distribution of the environment's rows"};
    GpuArray<shared::CdfEntry> env_columns_{"distributions of the environment's columns"};
    GpuArray<float> filter_{"pixel filter"};
    GpuArray<shared::SceneData> scene_data_{"scene"};
    LightTable light_table_;
    struct Counts { // of instances
        std::uint32_t traced = 0, glow = 0, not_plain = 0; // that rays can hit; of these
        std::uint32_t border = 0, quadric = 0; // quadric: that is shown, though maybe not hit
        std::uint32_t catchers = 0; // that rays can hit
    } counts_;
    bool compensated_ = false; // the environment's density: MIS compensation
    bool lights_touched_ = false; // by the last sync_instances: emitters that came or went
    std::vector<scene::Id<scene::Instance>> moved_emitters_; // likewise: those that only moved
    bool reads_files_ = false; // some material in use does; the files may have changed
    glm::vec2 filter_weight_{1};
    std::uint32_t filter_entries_ = 0;
    bool all_caustics_ = false;
    std::tuple<bool, scene::Technique, scene::Technique> techniques_; // adaptive, guiding, caustics: not on the device
    bool light_alpha_ = false; // of SceneFeatures

    struct Versions {
        scene::Version meshes = 0, images = 0, textures = 0, materials = 0, instances = 0, lights = 0, media = 0,
                       cameras = 0, environment = 0, active_camera = 0, film = 0;
    } seen_;
    bool first_ = true;
};

} // namespace restage::render
