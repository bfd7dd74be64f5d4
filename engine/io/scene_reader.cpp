// SPDX-License-Identifier: Apache-2.0
#include "io/scene_reader.hpp"

#include "plugin/adapters.hpp"
#include "scene/projection.hpp"

#include <algorithm>

namespace restage::io {

using namespace scene;

namespace {

template <class T>
RestageText text(const T& item) {
    return {item.name.c_str(), item.origin.verbatim.c_str(), item.origin.format.c_str()};
}

} // namespace

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
int SceneReader::give_values(const ParamSet& params, Description& out) {
    return guarded<SceneReader>(this, "parameters", [&](SceneReader& r) {
        const auto& list = r.values_.emplace_back(io::give_values(params));
        out.values = list.data();
        out.value_count = static_cast<std::uint32_t>(list.size());
        return 1;
    });
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

    static int mesh(void* ctx, RestageHandle handle, RestageMesh* out) {
        const Mesh* m = scene(ctx).meshes.find({handle});
        if (!m || !m->data) return 0;
        const MeshData& d = *m->data;
        *out = {.text = text(*m),
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
        return 1;
    }

    static int image(void* ctx, RestageHandle handle, RestageImage* out) {
        const Image* i = scene(ctx).images.find({handle});
        if (!i) return 0;
        *out = {.text = text(*i),
                .path = i->path.c_str(),
                .encoding = static_cast<std::uint32_t>(i->encoding),
                .gamma = i->gamma,
                .width = 0,
                .height = 0,
                .channels = 0,
                .pixels = nullptr};
        if (i->data) { // also where the file exists: an exporter may have to convert it
            out->width = i->data->width;
            out->height = i->data->height;
            out->channels = i->data->channels;
            out->pixels = i->data->values.data();
        }
        return 1;
    }

    static int texture(void* ctx, RestageHandle handle, RestageTexture* out) {
        const Texture* t = scene(ctx).textures.find({handle});
        if (!t) return 0;
        *out = {.text = text(*t),
                .type = t->type.c_str(),
                .is_float = t->is_float,
                .image = t->image.value,
                .values = nullptr,
                .value_count = 0};
        return self(ctx).give_values(t->params, *out);
    }

    static int material(void* ctx, RestageHandle handle, RestageMaterialDesc* out) {
        const Material* m = scene(ctx).materials.find({handle});
        if (!m) return 0;
        *out = {.text = text(*m), .type = m->type.c_str(), .values = nullptr, .value_count = 0};
        return self(ctx).give_values(m->params, *out);
    }

    static int medium(void* ctx, RestageHandle handle, RestageMedium* out) {
        const Medium* m = scene(ctx).media.find({handle});
        if (!m) return 0;
        *out = {.text = text(*m), .sigma_a = {}, .sigma_s = {}, .g = m->g};
        copy(m->sigma_a, out->sigma_a);
        copy(m->sigma_s, out->sigma_s);
        return 1;
    }

    static int group(void* ctx, RestageHandle handle, RestageGroup* out) {
        const Group* g = scene(ctx).groups.find({handle});
        if (!g) return 0;
        *out = {.text = text(*g), .parent = g->parent.value};
        return 1;
    }

    static int instance(void* ctx, RestageHandle handle, RestageInstance* out) {
        const Instance* i = scene(ctx).instances.find({handle});
        if (!i) return 0;
        *out = {.text = text(*i),
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
        if (i->reverse_orientation) out->flags |= RESTAGE_INSTANCE_REVERSE_ORIENTATION;
        if (i->hidden) out->flags |= RESTAGE_INSTANCE_HIDDEN;
        if (i->alpha_mask) out->flags |= RESTAGE_INSTANCE_ALPHA_MASK;
        if (i->emission) {
            out->flags |= RESTAGE_INSTANCE_EMITS;
            if (i->emission->unseen) out->flags |= RESTAGE_INSTANCE_EMITS_UNSEEN;
            if (i->emission->two_sided) out->flags |= RESTAGE_INSTANCE_TWO_SIDED;
            copy(i->emission->radiance, out->emission);
        } else if (const auto by_material = self(ctx).shine_.of(i->material)) {
            out->flags |= RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_EMITS_BY_MATERIAL;
            if (by_material->two_sided) out->flags |= RESTAGE_INSTANCE_TWO_SIDED;
            const auto [mean, unknown] = self(ctx).means_.try_emplace(by_material->texture.value);
            if (unknown) mean->second = mean_of(scene(ctx), by_material->texture);
            copy(by_material->radiance * mean->second, out->emission);
        }
        copy(i->object_to_world, out->object_to_world);
        return 1;
    }

    static int light(void* ctx, RestageHandle handle, RestageLight* out) {
        const Light* l = scene(ctx).lights.find({handle});
        if (!l) return 0;
        *out = {.text = text(*l),
                .kind = static_cast<std::uint32_t>(l->kind) + RESTAGE_LIGHT_POINT,
                .value = {},
                .light_to_world = {},
                .cone_angle = l->cone_angle,
                .cone_delta = l->cone_delta,
                .falloff = static_cast<std::uint32_t>(l->falloff),
                .flags = l->hidden ? static_cast<std::uint32_t>(RESTAGE_LIGHT_HIDDEN) : 0u};
        copy(l->value, out->value);
        copy(l->light_to_world, out->light_to_world);
        return 1;
    }

    static int environment(void* ctx, RestageEnvironment* out) {
        const auto& e = scene(ctx).environment.value;
        if (!e) return 0;
        *out = {.text = text(*e),
                .image = e->image.value,
                .mapping = static_cast<std::uint32_t>(e->mapping),
                .scale = {},
                .light_to_world = {},
                .hidden_from_camera = e->hidden_from_camera};
        copy(e->scale, out->scale);
        copy(e->light_to_world, out->light_to_world);
        return 1;
    }

    static int camera(void* ctx, RestageHandle handle, RestageCamera* out) {
        const Camera* c = scene(ctx).cameras.find({handle});
        if (!c) return 0;
        const Film& film = scene(ctx).film.value;
        *out = {.text = text(*c),
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
                out->screen_window[i] = (*c->screen_window)[i];
        copy(c->camera_to_world, out->camera_to_world);
        return 1;
    }

    static RestageHandle active_camera(void* ctx) { return scene(ctx).active_camera.value.value; }
    static RestageHandle camera_medium(void* ctx) { return scene(ctx).settings.value.camera_medium.value; }

    static void film(void* ctx, RestageFilm* out) {
        const Film& f = scene(ctx).film.value;
        *out = {.width = f.width,
                .height = f.height,
                .crop = {f.crop.x, f.crop.y, f.crop.z, f.crop.w},
                .filter = filter_name(f.filter.kind),
                .filter_radius = {f.filter.radius.x, f.filter.radius.y},
                .filter_params = {f.filter.params.x, f.filter.params.y},
                .exposure = f.exposure,
                .filename = f.filename.c_str(),
                .unexposed = 0};
    }

    static void settings(void* ctx, RestageSettings* out) {
        const Settings& s = scene(ctx).settings.value;
        *out = {.max_depth = s.max_depth,
                .samples = s.samples,
                .text = {"", s.origin.verbatim.c_str(), s.origin.format.c_str()}};
    }

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
              .mesh = Calls::mesh,
              .image = Calls::image,
              .texture = Calls::texture,
              .material = Calls::material,
              .medium = Calls::medium,
              .group = Calls::group,
              .instance = Calls::instance,
              .light = Calls::light,
              .environment = Calls::environment,
              .camera = Calls::camera,
              .active_camera = Calls::active_camera,
              .camera_medium = Calls::camera_medium,
              .film = Calls::film,
              .settings = Calls::settings,
              .report = Calls::report,
              .error = Calls::error,
              .progress = Calls::progress};
}

} // namespace restage::io
