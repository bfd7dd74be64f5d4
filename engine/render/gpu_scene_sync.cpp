// SPDX-License-Identifier: Apache-2.0
// GpuScene's derivation of materials, instances, lights and the root record.
#include "render/filter_table.hpp"
#include "render/gpu_scene.hpp"
#include "render/light_tree.hpp"
#include "scene/projection.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace restage::render {

using scene::Id;
using scene::Scene;

static_assert(CAMERA_ORTHOGRAPHIC == std::uint32_t(scene::Projection::orthographic) &&
              CAMERA_SPHERICAL == std::uint32_t(scene::Projection::spherical) &&
              CAMERA_EQUAL_AREA == std::uint32_t(scene::Projection::spherical_equal_area));

std::uint32_t GpuScene::type_index(const std::string& type) {
    for (std::uint32_t i = 0; i < types_.size(); ++i)
        if (types_[i].type == type) return i;
    MaterialType t;
    t.type = type;
    if (const auto plugin = lookup_(type)) t.plugin = *plugin;
    types_.push_back(t);
    return std::uint32_t(types_.size() - 1);
}

// Plugins may have been reloaded or added; see MaterialLookup.
bool GpuScene::refresh_types() {
    bool changed = false;
    for (MaterialType& t : types_) {
        const MaterialPlugin now = lookup_(t.type).value_or(MaterialPlugin{});
        if (now.table == t.plugin.table && now.revision() == t.plugin.revision()) continue;
        const auto reader = [](const MaterialPlugin& p) { return p.source ? p.source->table_reader() : nullptr; };
        changed |=
            now.revision() != t.plugin.revision() || !now.table != !t.plugin.table || reader(now) != reader(t.plugin);
        t.plugin = now;
    }
    return changed;
}

// Material records: 0 is the placeholder, then one per Id<Material>. Only types used by visible instances count.
Result<void> GpuScene::sync_materials(const Scene& scene, SceneChanges& changes) {
    std::vector<char> used(scene.materials.size() + 1);
    const auto use = [&](auto&& self, Id<scene::Material> id, int depth) -> void {
        const auto* m = scene.materials.find(id);
        if (!m || depth > 8 || used[id.value]) return;
        used[id.value] = 1;
        for (const auto& e : m->params.entries())
            if (e.value.type == model::ParamType::material) self(self, e.value.material, depth + 1);
    };
    used_material_.assign(scene.instances.size() + 1, 0);
    scene.instances.each([&](Id<scene::Instance> id, const scene::Instance& i) {
        if (i.hidden) return;
        used_material_[id.value] = i.material.value;
        use(use, i.material, 0);
    });

    const auto old_types = types_;
    for (auto& t : types_) {
        t.textured.clear();
        t.bump = t.used = t.curves = false;
    }
    const std::uint32_t fallback = type_index("diffuse"); // replaces materials whose plugin is missing
    if (!types_[fallback].plugin.table)
        return fail(
            "no plugin for the material type \"diffuse\": Restage's own plugins were not found; see "
            "`restage plugins`");
    types_[fallback].used = true;
    std::vector<shared::MaterialData> records(scene.materials.size() + 1);
    std::vector<std::uint32_t> words;
    mix_amount_.assign(records.size(), 0.5f);
    mix_texture_.assign(records.size(), 0);
    std::vector<std::optional<scene::MaterialEmission>> emission(records.size());
    reads_files_ = false;
    tables_.begin();
    const auto pack = [&](shared::MaterialData& record, const scene::ParamSet& params, const scene::Origin& origin,
                          std::uint32_t type, std::span<const DeviceTable> tables = {}) {
        record.type = type;
        const auto store = value_store(origin, types_[type].curves);
        glm::vec3 color = stand_in_color(*types_[type].plugin.table, params);
        if (colors_) color = colors_->reflectance(color);
        for (int k = 0; k < 3; ++k)
            words.push_back(std::bit_cast<std::uint32_t>(color[k]));
        record.params = std::uint32_t(words.size());
        const auto packed = pack_material(*types_[type].plugin.table, params, tables, colors_ ? &store : nullptr);
        words.insert(words.end(), packed.begin(), packed.end());
    };
    std::map<std::uint32_t, std::string> said;
    scene::ParamSet pink;
    pink.set("reflectance", scene::Value::color(0.8f, 0.1f, 0.5f));
    pack(records[0], pink, {}, fallback);

    scene.materials.each([&](Id<scene::Material> id, const scene::Material& m) {
        shared::MaterialData& record = records[id.value];
        record = records[0];
        record.id = id.value;
        if (!used[id.value]) return;
        const std::uint32_t index = type_index(m.type);
        MaterialType& type = types_[index];
        type.used = true;
        if (!type.plugin.table) return;
        if (type.mix()) {
            record.type = index;
            record.flags = MATERIAL_MIX;
            const auto child = [&](const char* param) {
                const auto* v = m.params.find(param);
                const auto* m2 = v ? scene.materials.find(v->material) : nullptr;
                if (m2 && types_[type_index(m2->type)].plugin.emits())
                    said[id.value] = "its component \"" + m2->name + "\" does not emit within a mix";
                if (m2 && types_[type_index(m2->type)].null_surface()) return MATERIAL_NOTHING;
                return m2 ? v->material.value : 0u;
            };
            record.mix_first = child("first");
            record.mix_second = child("second");
            mix_amount_[id.value] = m.params.number("amount", 0.5f);
            mix_texture_[id.value] = m.params.texture("amount").value;
            // words: amount, texture - for the tracer that resolves mixes in shaders
            record.params = std::uint32_t(words.size());
            words.push_back(std::bit_cast<std::uint32_t>(mix_amount_[id.value]));
            words.push_back(mix_texture_[id.value]);
            return;
        }
        if (type.null_surface()) {
            record.type = index;
            return;
        }
        reads_files_ |= type.plugin.source && type.plugin.source->table_reader();
        const auto tables = tables_.find(type.plugin, m.params);
        if (!tables) { // its file is missing or broken: grey, until fixed
            pack(record, {}, {}, fallback);
            said[id.value] = tables.error().message + "; shown as grey";
            return;
        }
        pack(record, m.params, m.origin, index, *tables);
        if (type.plugin.emits()) emission[id.value] = scene::emission_of(*type.plugin.table, m.params);
        record.bump = m.params.texture("bump").value;
        record.normal_map = m.params.texture("normalmap").value;
        type.bump |= record.bump || record.normal_map;
        const model::Material& table = *type.plugin.table;
        for (std::uint32_t i = 0; i < table.params.size(); ++i) {
            if (!table.params[i].texturable || !m.params.texture(table.params[i].id)) continue;
            if (type.textured.size() <= i) type.textured.resize(i + 1);
            type.textured[i] = true;
        }
    });
    tables_.sweep();
    for (const auto& [id, text] : said) // once, and again if it was fixed in between
        if (const auto before = said_.find(id); before == said_.end() || before->second != text)
            changes.warnings.push_back("material \"" + scene.materials[{id}].name + "\": " + text);
    said_ = std::move(said);
    emission_.resize(records.size());
    emission_changed_.resize(records.size());
    for (std::size_t i = 0; i < records.size(); ++i)
        emission_changed_[i] = emission_[i] != emission[i];
    emission_ = std::move(emission);
    has_gaps_.assign(records.size(), 0);
    for (int depth = 0; depth < 8; ++depth) // the depth to which mixes are resolved
        for (std::size_t i = 0; i < records.size(); ++i)
            if (records[i].flags & MATERIAL_MIX)
                for (const auto child : {records[i].mix_first, records[i].mix_second})
                    if (child == MATERIAL_NOTHING || has_gaps_[child]) has_gaps_[i] = 1;
    changes.shaders |= old_types.size() != types_.size();
    for (std::size_t i = 0; i < old_types.size() && !changes.shaders; ++i)
        changes.shaders = old_types[i].textured != types_[i].textured || old_types[i].bump != types_[i].bump ||
                          old_types[i].used != types_[i].used || old_types[i].curves != types_[i].curves;
    materials_.assign(std::move(records));
    params_.assign(std::move(words));
    RESTAGE_CHECK(materials_.flush(*device_));
    return params_.flush(*device_);
}

std::optional<scene::MaterialEmission> GpuScene::emission_of(const Scene& scene, const scene::Instance& in) const {
    if (in.emission)
        return scene::MaterialEmission{.radiance = in.emission->radiance, .two_sided = in.emission->two_sided};
    return scene.materials.find(in.material) ? emission_[in.material.value] : std::nullopt;
}

// At points spread over the triangle: the Kronecker lattice of the plastic number (Roberts 2018). Parts
// removed by alpha do not emit.
double GpuScene::mean_emission(std::uint32_t id, const glm::vec3& radiance, std::uint32_t triangle, int points) const {
    const auto& instance = instances_[id];
    const auto& mesh = *mesh_data_[mesh_of_[id].value];
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        glm::vec2 b = glm::fract(glm::vec2(0.5) + float(i) * glm::vec2(0.7548777f, 0.5698403f));
        if (!(instance.flags & INSTANCE_QUADRIC) && b.x + b.y > 1) b = 1.f - b;
        glm::vec3 c = radiance;
        if (instance.emission_texture)
            c *= glm::max(glm::vec3(0), evaluate_texture(textures_, cpu_images_, instance.emission_texture,
                                                         uv_at(instance, mesh, triangle, b)));
        if ((instance.flags & INSTANCE_HAS_ALPHA) && !(instance.flags & INSTANCE_EMITS_UNSEEN))
            c *= alpha_at(instance, mesh, triangle, b);
        sum += 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
    }
    return sum / points;
}

shared::InstanceData GpuScene::make_instance(const Scene& scene, std::uint32_t id, const scene::Instance& in) {
    shared::InstanceData out{};
    glm::dmat4 m = in.object_to_world;
    m[3] -= glm::dvec4(origin_, 0);
    out.object_to_world = glm::mat4x3(m);
    out.normal_to_world = glm::mat3(glm::transpose(glm::inverse(glm::dmat3(in.object_to_world))));
    out.material = scene.materials.find(in.material) ? in.material.value : 0;
    if (out.material && types_[materials_[out.material].type].null_surface()) out.material = 0;
    if (has_gaps_[out.material]) out.flags |= INSTANCE_HAS_GAPS;
    out.light_base = NONE;
    out.object_id = id;
    out.alpha_texture = scene.textures.find(in.alpha_texture) ? in.alpha_texture.value : 0;
    out.alpha = in.alpha;
    if (in.reverse_orientation) out.flags |= INSTANCE_FLIP_NORMAL;
    if (out.alpha_texture || !(in.alpha >= 1)) out.flags |= INSTANCE_HAS_ALPHA;
    if (in.alpha_mask) {
        out.flags |= INSTANCE_ALPHA_MASK;
        if (!out.alpha_texture && in.alpha > 0) out.flags &= ~INSTANCE_HAS_ALPHA;
    }
    if (in.emission && in.emission->unseen) out.flags |= INSTANCE_EMITS_UNSEEN;
    if (const auto emission = emission_of(scene, in)) {
        out.flags |= INSTANCE_EMITS | (emission->two_sided ? INSTANCE_TWO_SIDED : 0);
        out.emission_texture = scene.textures.find(emission->texture) ? emission->texture.value : 0;
        out.emission =
            out.emission_texture ? emission->radiance : stored_light(in.origin, "emission", emission->radiance);
    }
    if (in.media) {
        out.flags |= INSTANCE_HAS_MEDIA;
        out.interior = in.media->interior.value;
        out.exterior = in.media->exterior.value;
    }
    if (const GpuMesh* g = mesh(in.mesh)) {
        if (g->quadric) out.flags |= INSTANCE_QUADRIC;
        out.positions = g->positions;
        out.normals = g->normals;
        out.uvs = g->uvs;
        out.indices = g->indices;
        out.tangents = g->tangents;
        out.uvs2 = g->uvs2;
        out.flags |= (g->normals ? INSTANCE_HAS_NORMALS : 0) | (g->uvs ? INSTANCE_HAS_UVS : 0);
    }
    return out;
}

namespace {

// Rays are transformed to object space: without an inverse, or with one out of float range (Embree takes coordinates
// below 1.8e18), there is no ray. 1e9: an object a billionth of its mesh's size. 1e-6: for skewed axes floats cannot
// distinguish less from 0.
bool traceable(const glm::dmat4& object_to_world) {
    const glm::dmat3 linear(object_to_world);
    const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    if (!(std::abs(glm::determinant(linear)) > 1e-6 * volume)) return false;
    const glm::dmat3 inverse = glm::inverse(linear);
    const glm::dvec3 origin = inverse * glm::dvec3(object_to_world[3]);
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (!(std::abs(inverse[c][r]) <= 1e9)) return false;
    return glm::dot(origin, origin) <= 1e34;
}

} // namespace

void GpuScene::count(std::uint32_t instance, std::uint32_t by) {
    const std::uint32_t flags = instances_[instance].flags;
    if (border_[instance]) counts_.border += by;
    if (!traced_[instance]) return;
    counts_.traced += by;
    if (flags & INSTANCE_PASSES) counts_.glow += by;
    if (flags & INSTANCE_CATCHES) counts_.catchers += by;
    if (flags & (INSTANCE_HAS_ALPHA | INSTANCE_HAS_GAPS | INSTANCE_PASSES | INSTANCE_QUADRIC)) counts_.not_plain += by;
}

bool GpuScene::same_materials_in_use(const Scene& scene) const {
    if (first_ || reads_files_) return false;
    bool same = true;
    scene.instances.each_changed(seen_.instances, [&](Id<scene::Instance> id, const scene::Instance* in) {
        const std::uint32_t used = in && !in->hidden ? in->material.value : 0;
        same &= used == (id.value < used_material_.size() ? used_material_[id.value] : 0);
    });
    return same;
}

// all: including those of which only the mesh or material changed.
Result<void> GpuScene::sync_instances(const Scene& scene, SceneChanges& changes, bool all) {
    const std::uint32_t n = scene.instances.size() + 1;
    const std::uint32_t old = std::uint32_t(traced_.size());
    if (instances_.size() != n) {
        for (std::uint32_t i = n; i < old; ++i) {
            count(i, -1u);
            counts_.quadric -= std::uint32_t(quadric_[i]);
        }
        instances_.resize(n, {});
        traced_.resize(n, 0);
        border_.resize(n, 0);
        flat_.resize(n, 0);
        quadric_.resize(n, 0);
        mesh_of_.resize(n);
        used_material_.resize(n, 0);
    }
    lights_touched_ = false;
    moved_emitters_.clear();
    std::vector<char> replaced(scene.meshes.size() + 1);
    for (auto id : changes.meshes)
        replaced[id.value] = 1;
    const auto sync_one = [&](Id<scene::Instance> id) {
        const std::uint32_t i = id.value;
        const auto* in = scene.instances.find(id);
        const auto* material = in ? scene.materials.find(in->material) : nullptr;
        // `interface`: rays pass; it may be a border of media, or a lamp (pbrt-v3's; pbrt-v4 has none)
        const std::uint32_t m = material ? in->material.value : 0;
        const bool nothing = types_[materials_[m].type].null_surface(), gaps = has_gaps_[m] != 0;
        if (in && (i >= old || scene.instances.version(id) > seen_.instances)) {
            const bool flat = !traceable(in->object_to_world);
            if (flat && !flat_[i] && !in->hidden)
                changes.warnings.push_back(
                    fmt::format("instance \"{}\": its transform flattens it, or makes it too "
                                "small for rays; it is not rendered",
                                in->name));
            flat_[i] = flat;
        }
        const bool there = in && !in->hidden && !flat_[i] && mesh(in->mesh);
        const bool quadric = there && mesh(in->mesh)->quadric;
        counts_.quadric += std::uint32_t(quadric) - std::uint32_t(quadric_[i]);
        quadric_[i] = quadric;
        const bool invisible = in && !scene.textures.find(in->alpha_texture) && !(in->alpha > 0);
        const bool traced = there && !invisible && (!nothing || in->emission);
        const bool border = there && (gaps || nothing) && in->media && in->media->interior != in->media->exterior;
        const bool catches = traced && in->catcher;
        const bool moved_in_or_out = i >= old || catches != ((instances_[i].flags & INSTANCE_CATCHES) != 0) ||
                                     traced != (traced_[i] != 0) || border != (border_[i] != 0) ||
                                     (in && replaced[in->mesh.value]);
        if (!moved_in_or_out && scene.instances.version(id) <= seen_.instances &&
            instances_[i].material == (nothing ? 0 : m) && !emission_changed_[m] &&
            gaps == ((instances_[i].flags & INSTANCE_HAS_GAPS) != 0))
            return; // the common case
        auto record = in ? make_instance(scene, i, *in) : shared::InstanceData{};
        if (traced && nothing) record.flags |= INSTANCE_PASSES;
        if (catches) record.flags |= INSTANCE_CATCHES | INSTANCE_PASSES;
        record.light_base = i < light_table_.light_base.size() ? light_table_.light_base[i] : NONE;
        const Id<scene::Mesh> its_mesh = in ? in->mesh : Id<scene::Mesh>{};
        if ((record.flags | instances_[i].flags) & (INSTANCE_EMITS | INSTANCE_PASSES)) {
            const bool same = !moved_in_or_out && record.flags == instances_[i].flags && mesh_of_[i] == its_mesh;
            if (same && record.light_base != NONE)
                moved_emitters_.push_back(id);
            else
                lights_touched_ = true;
        }
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): the GPU sees bits; uploading another zero is harmless
        if (!moved_in_or_out && mesh_of_[i] == its_mesh && std::memcmp(&record, &instances_[i], sizeof(record)) == 0)
            return; // just renamed
        count(i, -1u);
        instances_.set(i, record);
        traced_[i] = traced;
        border_[i] = border;
        count(i, 1);
        mesh_of_[i] = its_mesh;
        changes.instances.push_back(id);
    };
    if (all)
        for (std::uint32_t i = 1; i < n; ++i)
            sync_one({i});
    else
        scene.instances.each_changed(seen_.instances,
                                     [&](Id<scene::Instance> id, const scene::Instance*) { sync_one(id); });
    return instances_.flush(*device_);
}

// Even what cannot be hit (alpha 0) may emit; but not what rays cannot be transformed to.
std::optional<Emitter> GpuScene::emitter_of(const Scene& scene, Id<scene::Instance> id) const {
    const auto* in = scene.instances.find(id);
    const auto& instance = instances_[id.value];
    const auto flags = instance.flags;
    if (!in || in->hidden || flat_[id.value] || !mesh(in->mesh)) return std::nullopt;
    if (!(flags & INSTANCE_EMITS) || (flags & INSTANCE_HAS_GAPS)) return std::nullopt;
    const bool alpha = (flags & INSTANCE_HAS_ALPHA) != 0, unseen = (flags & INSTANCE_EMITS_UNSEEN) != 0;
    if (alpha && !unseen && !instance.alpha_texture && !(instance.alpha > 0)) return std::nullopt;
    Emitter out{.radiance = emission_of(scene, *in)->radiance,
                .stored = instance.emission,
                .two_sided = (flags & INSTANCE_TWO_SIDED) != 0,
                .varies = instance.emission_texture || alpha,
                .mean = {}};
    if (instance.emission_texture || (alpha && !unseen)) { // 16,384 lookups at most, unless there are more triangles
        const auto triangles = is_quadric(id.value) ? 64 : mesh_data_[mesh_of_[id.value].value]->triangles.size();
        const int points = int(std::clamp<std::size_t>(16384 / triangles, 1, 32));
        out.mean = [this, id, points, radiance = out.radiance](std::uint32_t t) {
            return mean_emission(id.value, radiance, t, points);
        };
    }
    return out;
}

// all: including those not changed themselves.
Result<void> GpuScene::sync_lights(const Scene& scene, SceneChanges& changes, bool all) {
    const auto& env = scene.environment.value;
    // Shadow catchers are lit by light sampling alone.
    const bool compensate = strategy_ == Strategy::mis && counts_.catchers == 0;
    if (first_ || scene.environment.version != seen_.environment || scene.images.version() != seen_.images ||
        compensated_ != compensate) {
        const auto* image = env ? scene.images.find(env->image) : nullptr;
        environment_ = make_environment_map(image ? image->data.get() : nullptr,
                                            env ? env->mapping : scene::Mapping::equirect, compensate);
        compensated_ = compensate;
        if (environment_.mended > 0)
            changes.warnings.push_back(
                fmt::format("environment \"{}\": {} values of its image are negative or not finite; replaced by 0",
                            env->name, environment_.mended));
        env_texels_.assign(environment_.texels);
        env_rows_.assign(environment_.rows);
        env_columns_.assign(environment_.columns);
        RESTAGE_CHECK(env_texels_.flush(*device_));
        RESTAGE_CHECK(env_rows_.flush(*device_));
        RESTAGE_CHECK(env_columns_.flush(*device_));
    }
    constexpr std::size_t few = 64;
    if (!all && !lights_touched_ && moved_emitters_.size() <= few) {
        const auto replace = [&](Id<scene::Instance> id) {
            const auto replaced = replace_emitter(light_table_, scene, origin_, id, emitter_of(scene, id));
            if (!replaced) return false;
            for (std::uint32_t k = replaced->first; k < replaced->first + replaced->count; ++k) {
                lights_.set(k, light_table_.lights[k]);
                light_cdf_.set(k, light_table_.cdf[k]);
            }
            for (const std::uint32_t node : replaced->nodes)
                light_nodes_.set(node, light_table_.nodes[node]);
            return true;
        };
        if (std::ranges::all_of(moved_emitters_, replace)) return flush_lights();
    }

    light_alpha_ = false;
    const auto emitter = [&](Id<scene::Instance> id) {
        auto out = emitter_of(scene, id);
        light_alpha_ |= out && (instances_[id.value].flags & INSTANCE_HAS_ALPHA);
        return out;
    };
    const auto lamp = [&](const scene::Light& light) { return stored_light(light.origin, "value", light.value); };
    light_table_ = make_light_table(scene, origin_, env ? environment_.mean * env->scale : glm::vec3(0), emitter, lamp);
    for (std::uint32_t i = 1; i < instances_.size(); ++i)
        if (instances_[i].light_base != light_table_.light_base[i]) {
            auto record = instances_[i];
            record.light_base = light_table_.light_base[i];
            instances_.set(i, record);
        }
    lights_.assign(light_table_.lights);
    light_cdf_.assign(light_table_.cdf);
    light_nodes_.assign(light_table_.nodes);
    RESTAGE_CHECK(instances_.flush(*device_));
    return flush_lights();
}

Result<void> GpuScene::flush_lights() {
    RESTAGE_CHECK(lights_.flush(*device_));
    RESTAGE_CHECK(light_cdf_.flush(*device_));
    return light_nodes_.flush(*device_);
}

namespace {

void set_camera(const Scene& scene, const glm::dvec3& origin, shared::CameraData& out) {
    const scene::Film& film = scene.film.value;
    out.width = film.width;
    out.height = film.height;
    const scene::Camera* found = scene.cameras.find(scene.active_camera.value);
    const scene::Camera camera = found ? *found : scene::Camera{};
    glm::dmat4 m = camera.camera_to_world;
    m[3] -= glm::dvec4(origin, 0);
    out.camera_to_world = glm::mat4x3(m);
    const glm::dvec4 window = scene::film_window(camera, double(film.width) / film.height);
    out.screen_min = {window.x, window.w};
    out.screen_max = {window.y, window.z};
    out.lens_radius = camera.lens_radius;
    out.focal_distance = camera.focal_distance;
}

} // namespace

Result<void> GpuScene::sync_root(const Scene& scene, SceneChanges& changes, bool colors) {
    if (first_ || colors || scene.media.version() != seen_.media) {
        std::vector<shared::MediumData> media(scene.media.size() + 1);
        scene.media.each(
            [&](Id<scene::Medium> id, const scene::Medium& m) { media[id.value].sigma_a = stored_absorption(m); });
        media_.assign(std::move(media));
        RESTAGE_CHECK(media_.flush(*device_));
    }
    shared::SceneData d{};
    d.instances = instances_.address();
    d.materials = materials_.address();
    d.params = params_.address();
    d.textures = programs_.address();
    d.texture_words = texture_words_.address();
    d.images = images_.address();
    d.lights = lights_.address();
    d.light_nodes = light_nodes_.address();
    d.light_cdf = light_cdf_.address();
    d.media = media_.address();
    d.environment.light = light_table_.environment;
    if (const auto& env = scene.environment.value) {
        glm::dmat3 rotation(env->light_to_world); // directions are scale-free: a scale cancels
        rotation /= std::max(std::cbrt(std::abs(glm::determinant(rotation))), 1e-300);
        d.environment.world_from_env = glm::mat3(rotation);
        d.environment.env_from_world = glm::mat3(glm::inverse(rotation));
        d.environment.scale = environment_.texels.empty() ? stored_light(env->origin, "scale", env->scale) : env->scale;
        d.environment.hidden = env->hidden_from_camera;
        d.environment.mapping = environment_.texels.empty()                  ? ENV_CONSTANT
                                : env->mapping == scene::Mapping::octahedral ? ENV_OCTAHEDRAL
                                                                             : ENV_EQUIRECT;
        d.environment.width = environment_.width;
        d.environment.height = environment_.height;
        d.environment.texels = env_texels_.address();
        d.environment.rows = env_rows_.address();
        d.environment.columns = env_columns_.address();
    }
    RESTAGE_CHECK(sync_spectral());
    if (colors_) {
        d.spectral_coefficients = color_cells_.address();
        d.spectral_curves = curve_entries_.address();
        d.spectral_film = color_film_.address();
    }
    set_camera(scene, origin_, d.camera);
    const scene::Filter& filter = scene.film.value.filter;
    d.filter_.radius = filter.radius;
    d.filter_.weight = glm::vec2(1);
    d.filter_.kind = filter.kind == scene::FilterKind::box        ? FILTER_BOX
                     : filter.kind == scene::FilterKind::triangle ? FILTER_TRIANGLE
                                                                  : FILTER_TABLE;
    if (first_ || scene.film.version != seen_.film) {
        FilterTable table;
        if (d.filter_.kind == FILTER_TABLE) table = make_filter_table(filter);
        filter_.assign(std::move(table.data));
        RESTAGE_CHECK(filter_.flush(*device_));
        filter_weight_ = table.weight;
        filter_entries_ = table.entries;
    }
    d.filter_.table = filter_.address();
    d.filter_.table_size = filter_entries_;
    d.filter_.weight = filter_weight_;
    const scene::Settings& settings = scene.settings.value;
    d.max_depth = std::min(settings.max_depth, 0xfffeu);
    d.russian_roulette = settings.russian_roulette;
    d.camera_medium = settings.camera_medium.value;
    d.clamp_direct = settings.clamp_direct;
    d.clamp_indirect = settings.clamp_indirect;
    d.ray_epsilon = settings.ray_epsilon;
    d.world_origin = glm::vec3(origin_);
    scene_data_.set(0, d);
    RESTAGE_CHECK(scene_data_.flush(*device_));

    SceneFeatures f;
    f.environment = d.environment.light != NONE;
    f.lens = d.camera.lens_radius > 0; // spherical cameras have none
    f.media = scene.media.live() > 0;
    f.filter_table = d.filter_.kind == FILTER_TABLE;
    f.emission_textures = std::ranges::any_of(emission_, [](const auto& e) { return e && e->texture; });
    f.light_alpha = light_alpha_;
    f.glow = counts_.glow > 0;
    f.catchers = counts_.catchers > 0;
    f.quadrics = counts_.quadric > 0;
    const auto* camera = scene.cameras.find(scene.active_camera.value);
    f.camera = camera ? std::uint32_t(camera->projection) : CAMERA_PERSPECTIVE;
    f.lights = light_table_.kinds;
    const auto emitters = std::uint32_t(light_table_.nodes.size()), roots = light_table_.roots;
    f.light_roots = emitters > light_node_children ? 9 : roots > 1 ? std::bit_ceil(roots) : roots;
    f.spectral = colors_ != nullptr;
    f.curves = light_curves_;
    f.borders = counts_.border > 0;
    all_caustics_ = settings.caustics == scene::Technique::on;
    const std::tuple techniques(settings.adaptive, settings.guiding, settings.caustics);
    changes.image |= std::exchange(techniques_, techniques) != techniques;
    const bool sources = all_caustics_ ? emitters > 0
                                       : (light_table_.kinds & (LIGHTS_SURFACES | LIGHTS_LAMPS)) != 0 ||
                                             (light_table_.environment != NONE && sunny());
    f.caustics = settings.caustics != scene::Technique::off && sources && strategy_ == Strategy::mis &&
                 std::ranges::any_of(types_, [](const MaterialType& t) { return t.used && t.may_be_specular(); });
    changes.shaders |= f != features_ || first_;
    features_ = f;
    return {};
}

} // namespace restage::render
