// SPDX-License-Identifier: Apache-2.0
#include "io/scene_reader.hpp"

#include "plugin/abi.hpp"
#include "plugin/adapters.hpp"
#include "scene/projection.hpp"

#include <algorithm>

namespace restage::io {

using namespace scene;

std::vector<RestageValue> give_values(const ParamSet& params) {
    std::vector<RestageValue> list;
    for (const auto& [id, value] : params.entries()) {
        RestageValue out{};
        out.id = id.c_str();
        out.type = plugin::abi_type(value.type);
        out.ref = value.type == ParamType::material ? value.material.value : value.texture.value;
        out.i = value.i;
        std::copy(value.v.begin(), value.v.end(), out.v);
        out.text = value.has_text() ? value.text.c_str() : nullptr;
        list.push_back(out);
    }
    return list;
}

template <class Description>
bool SceneReader::give_values(const ParamSet& params, Description& out) {
    const auto& list = values_.emplace_back(io::give_values(params));
    out.values = list.data();
    out.value_count = static_cast<std::uint32_t>(list.size());
    return true;
}

const RestageOrigin* SceneReader::origin(const Origin& origin) {
    static constexpr RestageOrigin nothing{.format = "", .verbatim = ""};
    if (origin == Origin{}) return &nothing;
    auto& given = origins_[&origin];
    if (given.second.format) return &given.second;
    for (const OriginValue& value : origin.values)
        given.first.push_back({.id = value.id.c_str(), .text = value.text.c_str()});
    given.second = {.value_count = static_cast<std::uint32_t>(given.first.size()),
                    .format = origin.format.c_str(),
                    .verbatim = origin.verbatim.c_str(),
                    .values = given.first.data()};
    return &given.second;
}

struct SceneReader::Calls {
    static SceneReader& self(void* ctx) { return *static_cast<SceneReader*>(ctx); }
    static const Scene& scene(void* ctx) { return self(ctx).scene_; }

    static std::uint32_t count(void* ctx, std::uint32_t kind) {
        const Scene& s = scene(ctx);
        switch (kind) {
            case RESTAGE_KIND_MESH:
                return s.meshes.size();
            case RESTAGE_KIND_IMAGE:
                return s.images.size();
            case RESTAGE_KIND_TEXTURE:
                return s.textures.size();
            case RESTAGE_KIND_MATERIAL:
                return s.materials.size();
            case RESTAGE_KIND_MEDIUM:
                return s.media.size();
            case RESTAGE_KIND_GROUP:
                return s.groups.size();
            case RESTAGE_KIND_INSTANCE:
                return s.instances.size();
            case RESTAGE_KIND_LIGHT:
                return s.lights.size();
            case RESTAGE_KIND_CAMERA:
                return s.cameras.size();
            default:
                return 0;
        }
    }

    static bool fill(SceneReader& r, RestageHandle handle, RestageMesh& out) {
        const Mesh* m = r.scene_.meshes.find({handle});
        if (!m || !m->data) return false;
        const MeshData& d = *m->data;
        out = {.name = m->name.c_str(),
               .origin = r.origin(m->origin),
               .vertex_count = static_cast<std::uint32_t>(d.positions.size()),
               .triangle_count = static_cast<std::uint32_t>(d.triangles.size()),
               .positions = d.positions.empty() ? nullptr : &d.positions[0].x,
               .normals = d.normals.empty() ? nullptr : &d.normals[0].x,
               .uvs = d.uvs.empty() ? nullptr : &d.uvs[0].x,
               .indices = d.triangles.empty() ? nullptr : &d.triangles[0].x,
               .source_file = m->source_file.c_str(),
               .primitive = m->primitive.c_str(),
               .tangents = d.tangents.empty() ? nullptr : &d.tangents[0].x,
               .uvs2 = d.uvs2.empty() ? nullptr : &d.uvs2[0].x};
        return true;
    }

    static bool fill(SceneReader& r, RestageHandle handle, RestageImage& out) {
        const Image* i = r.scene_.images.find({handle});
        if (!i) return false;
        out = {.name = i->name.c_str(),
               .origin = r.origin(i->origin),
               .path = i->path.c_str(),
               .encoding = static_cast<std::uint32_t>(i->encoding),
               .gamma = i->gamma,
               .width = 0,
               .height = 0,
               .channels = 0,
               .pixels = nullptr};
        if (i->data) { // even if the file exists: an exporter may have to convert it
            out.width = i->data->width;
            out.height = i->data->height;
            out.channels = i->data->channels;
            out.pixels = i->data->values.data();
        }
        return true;
    }

    static bool fill(SceneReader& r, RestageHandle handle, RestageTexture& out) {
        const Texture* t = r.scene_.textures.find({handle});
        if (!t) return false;
        out = {.name = t->name.c_str(),
               .origin = r.origin(t->origin),
               .type = t->type.c_str(),
               .is_float = t->is_float,
               .image = t->image.value,
               .values = nullptr,
               .value_count = 0};
        return r.give_values(t->params, out);
    }

    static bool fill(SceneReader& r, RestageHandle handle, RestageMaterialDesc& out) {
        const Material* m = r.scene_.materials.find({handle});
        if (!m) return false;
        out = {.name = m->name.c_str(),
               .origin = r.origin(m->origin),
               .type = m->type.c_str(),
               .values = nullptr,
               .value_count = 0};
        return r.give_values(m->params, out);
    }

    static bool fill(SceneReader& r, RestageHandle handle, RestageMedium& out) {
        const Medium* m = r.scene_.media.find({handle});
        if (!m) return false;
        out = {.name = m->name.c_str(), .origin = r.origin(m->origin), .sigma_a = {}, .sigma_s = {}, .g = m->g};
        copy(m->sigma_a, out.sigma_a);
        copy(m->sigma_s, out.sigma_s);
        return true;
    }

    static bool fill(SceneReader& r, RestageHandle handle, RestageGroup& out) {
        const Group* g = r.scene_.groups.find({handle});
        if (!g) return false;
        out = {.name = g->name.c_str(), .origin = r.origin(g->origin), .parent = g->parent.value};
        return true;
    }

    static bool fill(SceneReader& r, RestageHandle handle, RestageInstance& out) {
        const Instance* i = r.scene_.instances.find({handle});
        if (!i) return false;
        out = {.name = i->name.c_str(),
               .origin = r.origin(i->origin),
               .mesh = i->mesh.value,
               .material = i->material.value,
               .group = i->group.value,
               .alpha_texture = i->alpha_texture.value,
               .interior = i->media ? i->media->interior.value : 0,
               .exterior = i->media ? i->media->exterior.value : 0,
               .has_medium_interface = i->media.has_value(),
               .flags = 0,
               .alpha = i->alpha,
               .emission = {},
               .object_to_world = {}};
        if (i->reverse_orientation) out.flags |= RESTAGE_INSTANCE_REVERSE_ORIENTATION;
        if (i->hidden) out.flags |= RESTAGE_INSTANCE_HIDDEN;
        if (i->alpha_mask) out.flags |= RESTAGE_INSTANCE_ALPHA_MASK;
        if (i->emission) {
            out.flags |= RESTAGE_INSTANCE_EMITS;
            if (i->emission->unseen) out.flags |= RESTAGE_INSTANCE_EMITS_UNSEEN;
            if (i->emission->two_sided) out.flags |= RESTAGE_INSTANCE_TWO_SIDED;
            copy(i->emission->radiance, out.emission);
        } else if (const auto by_material = r.shine_.of(i->material)) {
            out.flags |= RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_EMITS_BY_MATERIAL;
            if (by_material->two_sided) out.flags |= RESTAGE_INSTANCE_TWO_SIDED;
            const auto [mean, unknown] = r.means_.try_emplace(by_material->texture.value);
            if (unknown) mean->second = mean_of(r.scene_, by_material->texture);
            copy(by_material->radiance * mean->second, out.emission);
        }
        copy(i->object_to_world, out.object_to_world);
        return true;
    }

    static bool fill(SceneReader& r, RestageHandle handle, RestageLight& out) {
        const Light* l = r.scene_.lights.find({handle});
        if (!l) return false;
        out = {.name = l->name.c_str(),
               .origin = r.origin(l->origin),
               .kind = static_cast<std::uint32_t>(l->kind) + RESTAGE_LIGHT_POINT,
               .value = {},
               .light_to_world = {},
               .cone_angle = l->cone_angle,
               .cone_delta = l->cone_delta,
               .falloff = static_cast<std::uint32_t>(l->falloff),
               .flags = l->hidden ? static_cast<std::uint32_t>(RESTAGE_LIGHT_HIDDEN) : 0u};
        copy(l->value, out.value);
        copy(l->light_to_world, out.light_to_world);
        return true;
    }

    static bool fill(SceneReader& r, RestageHandle, RestageEnvironment& out) {
        const auto& e = r.scene_.environment.value;
        if (!e) return false;
        out = {.name = e->name.c_str(),
               .origin = r.origin(e->origin),
               .image = e->image.value,
               .mapping = static_cast<std::uint32_t>(e->mapping),
               .scale = {},
               .light_to_world = {},
               .hidden_from_camera = e->hidden_from_camera,
               .sky_value_count = 0,
               .sky = e->sky.c_str(),
               .sky_values = nullptr};
        copy(e->scale, out.scale);
        copy(e->light_to_world, out.light_to_world);
        const auto& list = r.values_.emplace_back(io::give_values(e->sky_params));
        out.sky_values = list.data();
        out.sky_value_count = static_cast<std::uint32_t>(list.size());
        return true;
    }

    static bool fill(SceneReader& r, RestageHandle handle, RestageCamera& out) {
        const Camera* c = r.scene_.cameras.find({handle});
        if (!c) return false;
        const Film& film = r.scene_.film.value;
        out = {.name = c->name.c_str(),
               .origin = r.origin(c->origin),
               .camera_to_world = {},
               .fov = static_cast<float>(camera_fov(*c, double(film.width) / film.height)),
               .screen_window = {},
               .lens_radius = c->lens_radius,
               .focal_distance = c->focal_distance,
               .frame_aspect = c->frame_aspect,
               .projection = static_cast<std::uint32_t>(c->projection),
               .fit_aspect = 0};
        if (c->screen_window)
            for (int i = 0; i < 4; ++i)
                out.screen_window[i] = (*c->screen_window)[i];
        copy(c->camera_to_world, out.camera_to_world);
        return true;
    }

    static bool fill(SceneReader& r, RestageHandle, RestageFilm& out) {
        const Film& f = r.scene_.film.value;
        out = {.width = f.width,
               .height = f.height,
               .crop = {f.crop.x, f.crop.y, f.crop.z, f.crop.w},
               .filter = filter_name(f.filter.kind),
               .filter_radius = {f.filter.radius.x, f.filter.radius.y},
               .filter_params = {f.filter.params.x, f.filter.params.y},
               .exposure = f.exposure,
               .filename = f.filename.c_str(),
               .unexposed = 0};
        return true;
    }

    static bool fill(SceneReader& r, RestageHandle, RestageSettings& out) {
        const Settings& s = r.scene_.settings.value;
        out = {.max_depth = s.max_depth, .samples = s.samples, .origin = r.origin(s.origin)};
        return true;
    }

    // Fills the members that the caller knows.
    template <class T>
    static int get(void* ctx, RestageHandle handle, T* out) {
        return guarded<SceneReader>(ctx, "an item of the scene", [&](SceneReader& r) {
            T full{};
            if (!fill(r, handle, full)) return 0;
            plugin::give(out, full);
            return 1;
        });
    }
    static int environment(void* ctx, RestageEnvironment* out) { return get(ctx, 0, out); }
    static void film(void* ctx, RestageFilm* out) { get(ctx, 0, out); }
    static void settings(void* ctx, RestageSettings* out) { get(ctx, 0, out); }
    static RestageHandle active_camera(void* ctx) { return scene(ctx).active_camera.value.value; }
    static RestageHandle camera_medium(void* ctx) { return scene(ctx).settings.value.camera_medium.value; }

    static void report(void* ctx, int fate, const char* what, const char* note) {
        guarded<SceneReader>(ctx, "report", [&](SceneReader& r) {
            r.tell(fate, what, note);
            return 0;
        });
    }

    static void error(void* ctx, const char* file, const char* message) {
        guarded<SceneReader>(ctx, "error", [&](SceneReader& r) {
            r.raise(file, 0, 0, message);
            return 0;
        });
    }

    static int progress(void* ctx, float done, const char* what) {
        return guarded<SceneReader>(ctx, "progress", [&](SceneReader& r) { return int(r.proceed(done, what)); });
    }
};

SceneReader::SceneReader(const Scene& scene, const plugin::Registry& registry, Progress progress)
    : Exchange(std::move(progress)), scene_(scene), shine_(registry, scene) {
    table_ = {.size = sizeof(RestageSceneReader1),
              .ctx = this,
              .count = Calls::count,
              .mesh = Calls::get<RestageMesh>,
              .image = Calls::get<RestageImage>,
              .texture = Calls::get<RestageTexture>,
              .material = Calls::get<RestageMaterialDesc>,
              .medium = Calls::get<RestageMedium>,
              .group = Calls::get<RestageGroup>,
              .instance = Calls::get<RestageInstance>,
              .light = Calls::get<RestageLight>,
              .environment = Calls::environment,
              .camera = Calls::get<RestageCamera>,
              .active_camera = Calls::active_camera,
              .camera_medium = Calls::camera_medium,
              .film = Calls::film,
              .settings = Calls::settings,
              .report = Calls::report,
              .error = Calls::error,
              .progress = Calls::progress};
}

} // namespace restage::io
