// SPDX-License-Identifier: Apache-2.0
// The C functions are thin: each turns a C struct into the engine's, checks it and pushes it. Exceptions (memory) stop
// at the border.
#include "io/scene_writer.hpp"

#include "scene/bounds.hpp"
#include "scene/tables.hpp"
#include "scene/validate.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

namespace restage::io {

using namespace scene;

namespace {

std::string text(const char* c) { return c ? c : ""; }

glm::dmat4 matrix(const double m[16]) {
    glm::dmat4 result;
    for (int i = 0; i < 16; ++i)
        result[i / 4][i % 4] = m[i];
    return result;
}

template <class... X>
bool finite(X... x) {
    return (std::isfinite(x) && ...);
}
bool finite3(const float* v) { return finite(v[0], v[1], v[2]); }
glm::vec3 vec3(const float* v) { return {v[0], v[1], v[2]}; }

bool affine(const glm::dmat4& m) {
    return is_finite(m) && m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
}

FilterKind filter_kind(const std::string& name) {
    return name == "triangle"   ? FilterKind::triangle
           : name == "gaussian" ? FilterKind::gaussian
           : name == "mitchell" ? FilterKind::mitchell
           : name == "sinc"     ? FilterKind::sinc
                                : FilterKind::box;
}

} // namespace

void SceneWriter::refuse(const std::string& what, const std::string& why) { report.add(RESTAGE_DROPPED, what, why); }

Origin SceneWriter::origin(const RestageText& t) {
    Origin result{text(t.verbatim), text(t.verbatim_format)};
    if (scene.format.empty()) scene.format = result.format;
    return result;
}

std::string SceneWriter::unique_name(const char* kind, const std::string& wanted) {
    auto& taken = names_[kind];
    if (!wanted.empty() && taken.insert(wanted).second) return wanted;
    const std::string base = wanted.empty() ? kind : wanted;
    unsigned& number = numbers_[std::string(kind) + '\n' + base];
    if (number == 0 && !wanted.empty()) number = 1; // the second "chair" is "chair 2"
    std::string name;
    do
        name = base + " " + std::to_string(++number);
    while (!taken.insert(name).second);
    return name;
}

template <class T>
RestageHandle SceneWriter::push(T item) {
    auto& slots = scene::table<T>(scene);
    const Id<T> id = slots.next();
    slots.set(id, std::move(item), scene.clock);
    return id.value;
}

template <class T>
bool SceneWriter::known(RestageHandle handle, const char* who_kind, const std::string& who, bool needed) {
    if (handle == 0 ? !needed : scene::table<T>(scene).find({handle}) != nullptr) return true;
    refuse(std::string(who_kind) + " \"" + who + "\"",
           handle == 0 ? std::string("it has no ") + kind_name<T>
                       : std::string("there is no ") + kind_name<T> + " " + std::to_string(handle));
    return false;
}

ParamSet SceneWriter::params(const RestageValue* values, std::uint32_t count, const std::string& who) {
    ParamSet result;
    for (std::uint32_t i = 0; values && i < count; ++i) {
        const RestageValue& in = values[i];
        const std::string id = text(in.id);
        const auto drop = [&](const char* why) { refuse(who + ": parameter \"" + id + "\"", why); };
        if (id.empty() || in.type < RESTAGE_FLOAT || in.type > RESTAGE_TEXTURE) {
            drop("it has no id or an unknown type");
            continue;
        }
        if (!finite(in.v[0], in.v[1], in.v[2], in.v[3])) {
            drop("not a finite number; the default stands for it");
            continue;
        }
        Value value{.type = static_cast<RestageType>(in.type),
                    .v = {in.v[0], in.v[1], in.v[2], in.v[3]},
                    .text = text(in.text)};
        if (value.type == RESTAGE_COLOR) value.v[3] = 0; // a colour has three; equal colours compare equal
        if (in.ref && value.type == RESTAGE_MATERIAL) {
            value.material = {in.ref};
            if (!scene.materials.find(value.material)) {
                drop("there is no such material");
                continue;
            }
        } else if (in.ref) {
            value.texture = {in.ref};
            if (!scene.textures.find(value.texture)) {
                drop("there is no such texture");
                continue;
            }
        }
        result.set(id, std::move(value));
    }
    return result;
}

struct SceneWriter::Calls {
    static SceneWriter& self(void* ctx) { return *static_cast<SceneWriter*>(ctx); }

    // f(writer) -> handle; no exception gets through.
    template <class F>
    static RestageHandle guarded(void* ctx, const char* what, F&& f) noexcept {
        try {
            return f(self(ctx));
        } catch (const std::exception& e) {
            try {
                self(ctx).refuse(what, std::string("no memory for it (") + e.what() + ")");
            } catch (...) { // no memory for the report either
            }
            return 0;
        }
    }

    static RestageHandle mesh(void* ctx, const RestageMesh* in) {
        return guarded(ctx, "mesh", [&](SceneWriter& w) -> RestageHandle {
            const std::string who = "mesh \"" + text(in->text.name) + "\"";
            if (!in->positions || !in->indices || in->vertex_count == 0 || in->triangle_count == 0) {
                w.refuse(who, "it has no triangles");
                return 0;
            }
            auto data = std::make_shared<MeshData>();
            const auto copy = [n = std::size_t{in->vertex_count}](auto& to, const float* from) {
                to.resize(n);
                std::memcpy(static_cast<void*>(to.data()), from, n * sizeof to[0]);
            };
            copy(data->positions, in->positions);
            data->triangles.resize(in->triangle_count);
            std::memcpy(static_cast<void*>(data->triangles.data()), in->indices,
                        data->triangles.size() * sizeof(glm::uvec3));
            if (const std::string problem = check_mesh(*data); !problem.empty()) {
                w.refuse(who, problem);
                return 0;
            }
            const auto optional = [&](auto& to, const float* from) { // worth less than the mesh itself
                if (!from) return;
                copy(to, from);
                if (const std::string problem = check_mesh(*data); !problem.empty()) {
                    w.report.add(RESTAGE_APPROXIMATED, who, problem + "; done without");
                    to.clear();
                }
            };
            optional(data->normals, in->normals);
            optional(data->uvs, in->uvs);
            compute_bounds(*data);
            return w.push(Mesh{.name = w.unique_name("mesh", text(in->text.name)),
                               .data = std::move(data),
                               .source_file = text(in->source_file),
                               .primitive = text(in->primitive),
                               .origin = w.origin(in->text)});
        });
    }

    static RestageHandle image(void* ctx, const RestageImage* in) {
        return guarded(ctx, "image", [&](SceneWriter& w) -> RestageHandle {
            Image image{
                .path = text(in->path), .encoding = static_cast<RestageEncoding>(in->encoding), .gamma = in->gamma};
            std::string name = text(in->text.name);
            if (name.empty()) name = image.path.substr(image.path.find_last_of("/\\") + 1);
            const std::string who = "image \"" + name + "\"";
            const auto key = std::tuple(image.path, in->encoding, in->gamma);
            if (!image.path.empty()) {
                if (const auto it = w.image_files_.find(key); it != w.image_files_.end()) return it->second;
            } else if (in->pixels) {
                if (in->width == 0 || in->height == 0 || in->width > 65536 || in->height > 65536 ||
                    (in->channels != 1 && in->channels != 3 && in->channels != 4)) {
                    w.refuse(who, "its size or its channels cannot be");
                    return 0;
                }
                auto data = std::make_shared<PixelData>();
                *data = {in->width, in->height, in->channels, {}};
                data->values.assign(in->pixels, in->pixels + std::size_t{in->width} * in->height * in->channels);
                image.data = std::move(data);
            } else {
                w.refuse(who, "it has neither a file nor pixels");
                return 0;
            }
            image.name = w.unique_name("image", name);
            image.origin = w.origin(in->text);
            const bool file = !image.path.empty();
            const RestageHandle handle = w.push(std::move(image));
            if (file) w.image_files_[key] = handle;
            return handle;
        });
    }

    static RestageHandle texture(void* ctx, const RestageTexture* in) {
        return guarded(ctx, "texture", [&](SceneWriter& w) -> RestageHandle {
            const std::string name = text(in->text.name);
            if (!w.known<Image>(in->image, "texture", name)) return 0;
            return w.push(Texture{.name = w.unique_name("texture", name),
                                  .type = text(in->type),
                                  .is_float = in->is_float != 0,
                                  .image = {in->image},
                                  .params = w.params(in->values, in->value_count, "texture \"" + name + "\""),
                                  .origin = w.origin(in->text)});
        });
    }

    static RestageHandle material(void* ctx, const RestageMaterialDesc* in) {
        return guarded(ctx, "material", [&](SceneWriter& w) -> RestageHandle {
            const std::string name = text(in->text.name);
            return w.push(Material{.name = w.unique_name("material", name),
                                   .type = text(in->type),
                                   .params = w.params(in->values, in->value_count, "material \"" + name + "\""),
                                   .origin = w.origin(in->text)});
        });
    }

    static RestageHandle medium(void* ctx, const RestageMedium* in) {
        return guarded(ctx, "medium", [&](SceneWriter& w) -> RestageHandle {
            if (!finite3(in->sigma_a) || !finite3(in->sigma_s) || !finite(in->g)) {
                w.refuse("medium \"" + text(in->text.name) + "\"", "it holds a value that is not a finite number");
                return 0;
            }
            return w.push(Medium{.name = w.unique_name("medium", text(in->text.name)),
                                 .sigma_a = vec3(in->sigma_a),
                                 .sigma_s = vec3(in->sigma_s),
                                 .g = in->g,
                                 .origin = w.origin(in->text)});
        });
    }

    static RestageHandle group(void* ctx, const RestageGroup* in) {
        return guarded(ctx, "group", [&](SceneWriter& w) -> RestageHandle {
            if (!w.known<Group>(in->parent, "group", text(in->text.name))) return 0;
            return w.push(Group{.name = w.unique_name("group", text(in->text.name)),
                                .parent = {in->parent},
                                .origin = w.origin(in->text)});
        });
    }

    static RestageHandle instance(void* ctx, const RestageInstance* in) {
        return guarded(ctx, "instance", [&](SceneWriter& w) -> RestageHandle {
            const std::string name = text(in->text.name);
            if (!w.known<Mesh>(in->mesh, "instance", name, true) ||
                !w.known<Material>(in->material, "instance", name, true) ||
                !w.known<Group>(in->group, "instance", name) ||
                !w.known<Texture>(in->alpha_texture, "instance", name) ||
                !w.known<Medium>(in->interior, "instance", name) || !w.known<Medium>(in->exterior, "instance", name))
                return 0;
            const glm::dmat4 to_world = matrix(in->object_to_world);
            if (!affine(to_world) || !finite3(in->emission) || !finite(in->alpha)) {
                w.refuse("instance \"" + name + "\"", "its transform, emission or alpha is not finite, or not affine");
                return 0;
            }
            Instance instance{.name = w.unique_name("object", name),
                              .mesh = {in->mesh},
                              .material = {in->material},
                              .group = {in->group},
                              .object_to_world = to_world,
                              .alpha_texture = {in->alpha_texture},
                              .alpha = in->alpha,
                              .reverse_orientation = (in->flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) != 0,
                              .hidden = (in->flags & RESTAGE_INSTANCE_HIDDEN) != 0,
                              .origin = w.origin(in->text)};
            if (in->flags & RESTAGE_INSTANCE_EMITS)
                instance.emission = Emission{vec3(in->emission), (in->flags & RESTAGE_INSTANCE_TWO_SIDED) != 0};
            if (in->has_medium_interface) instance.media = MediumInterface{{in->interior}, {in->exterior}};
            return w.push(std::move(instance));
        });
    }

    static RestageHandle light(void* ctx, const RestageLight* in) {
        return guarded(ctx, "light", [&](SceneWriter& w) -> RestageHandle {
            const glm::dmat4 to_world = matrix(in->light_to_world);
            const std::string who = "light \"" + text(in->text.name) + "\"";
            if (in->kind < RESTAGE_LIGHT_POINT || in->kind > RESTAGE_LIGHT_DISTANT) {
                w.refuse(who, "a light of unknown kind");
                return 0;
            }
            if (!affine(to_world) || !finite3(in->value) || !finite(in->cone_angle, in->cone_delta)) {
                w.refuse(who, "it holds a value that is not a finite number, or its transform is not affine");
                return 0;
            }
            return w.push(Light{.name = w.unique_name("light", text(in->text.name)),
                                .kind = static_cast<RestageLightKind>(in->kind),
                                .value = vec3(in->value),
                                .light_to_world = to_world,
                                .cone_angle = in->cone_angle,
                                .cone_delta = in->cone_delta,
                                .origin = w.origin(in->text)});
        });
    }

    static void environment(void* ctx, const RestageEnvironment* in) {
        guarded(ctx, "environment", [&](SceneWriter& w) -> RestageHandle {
            const glm::dmat4 to_world = matrix(in->light_to_world);
            if (!w.known<Image>(in->image, "environment", text(in->text.name))) return 0;
            if (!affine(to_world) || !finite3(in->scale)) {
                w.refuse("the environment", "its scale or transform is not finite, or not affine");
                return 0;
            }
            if (w.scene.environment.value)
                w.refuse("environment \"" + w.scene.environment.value->name + "\"",
                         "another one follows; the last one counts");
            const std::string name = text(in->text.name);
            w.scene.environment = {Environment{.name = name.empty() ? "environment" : name,
                                               .image = {in->image},
                                               .mapping = static_cast<RestageMapping>(in->mapping),
                                               .scale = vec3(in->scale),
                                               .light_to_world = to_world,
                                               .origin = w.origin(in->text)},
                                   w.scene.clock};
            return 1;
        });
    }

    static RestageHandle camera(void* ctx, const RestageCamera* in) {
        return guarded(ctx, "camera", [&](SceneWriter& w) -> RestageHandle {
            const float* sw = in->screen_window;
            const glm::dmat4 to_world = matrix(in->camera_to_world);
            if (!affine(to_world) ||
                !finite(in->fov, sw[0], sw[1], sw[2], sw[3], in->lens_radius, in->focal_distance, in->frame_aspect)) {
                w.refuse("camera \"" + text(in->text.name) + "\"",
                         "it holds a value that is not a finite number, or its transform is not affine");
                return 0;
            }
            Camera camera{.name = w.unique_name("camera", text(in->text.name)),
                          .camera_to_world = to_world,
                          .fov = in->fov,
                          .lens_radius = in->lens_radius,
                          .focal_distance = in->focal_distance,
                          .frame_aspect = in->frame_aspect,
                          .origin = w.origin(in->text)};
            if (sw[0] != 0 || sw[1] != 0 || sw[2] != 0 || sw[3] != 0)
                camera.screen_window = glm::vec4(sw[0], sw[1], sw[2], sw[3]);
            const RestageHandle handle = w.push(std::move(camera));
            if (!w.scene.active_camera.value) w.scene.active_camera = {{handle}, w.scene.clock};
            return handle;
        });
    }

    static void camera_medium(void* ctx, RestageHandle medium) {
        guarded(ctx, "camera medium", [&](SceneWriter& w) -> RestageHandle {
            if (w.known<Medium>(medium, "medium of", "the camera")) w.scene.settings.value.camera_medium = {medium};
            return 0;
        });
    }

    static void film(void* ctx, const RestageFilm* in) {
        guarded(ctx, "film", [&](SceneWriter& w) -> RestageHandle {
            w.scene.film = {Film{.width = in->width,
                                 .height = in->height,
                                 .crop = {in->crop[0], in->crop[1], in->crop[2], in->crop[3]},
                                 .filter = {.kind = filter_kind(text(in->filter)),
                                            .radius = {in->filter_radius[0], in->filter_radius[1]},
                                            .params = {in->filter_params[0], in->filter_params[1]}},
                                 .exposure = in->exposure,
                                 .filename = text(in->filename)},
                            w.scene.clock};
            return 0;
        });
    }

    static void settings(void* ctx, const RestageSettings* in) {
        guarded(ctx, "settings", [&](SceneWriter& w) -> RestageHandle {
            Settings& s = w.scene.settings.value;
            s.max_depth = in->max_depth;
            if (in->samples) s.samples = in->samples;
            s.origin = w.origin(in->text);
            return 0;
        });
    }

    static void report(void* ctx, int fate, const char* file, std::uint32_t line, const char* what, const char* note) {
        guarded(ctx, "report", [&](SceneWriter& w) -> RestageHandle {
            w.report.add(static_cast<RestageFate>(std::clamp(fate, 0, 2)), text(what), text(note), text(file), line);
            return 0;
        });
    }

    static void error(void* ctx, const char* file, std::uint32_t line, std::uint32_t column, const char* message) {
        guarded(ctx, "error", [&](SceneWriter& w) -> RestageHandle {
            if (w.error_.empty()) {
                w.error_ = text(file);
                if (line) w.error_ += ":" + std::to_string(line) + (column ? ":" + std::to_string(column) : "");
                w.error_ += (w.error_.empty() ? "" : ": ") + text(message);
            }
            return 0;
        });
    }

    static int progress(void* ctx, float done, const char* what) {
        return static_cast<int>(guarded(ctx, "progress", [&](SceneWriter& w) -> RestageHandle {
            if (!w.cancelled_ && w.progress_ && !w.progress_(done, text(what))) w.cancelled_ = true;
            return !w.cancelled_;
        }));
    }

    static const RestageParam* material_table(void* ctx, const char* type, std::uint32_t* count) {
        const auto* entry = self(ctx).registry_.find_material(type ? type : "");
        if (count) *count = entry ? entry->table->param_count : 0;
        return entry ? entry->table->params : nullptr;
    }
};

SceneWriter::SceneWriter(const plugin::Registry& registry, Progress progress)
    : registry_(registry), progress_(std::move(progress)) {
    scene.clock = 1;
    table_ = {.size = sizeof(RestageSceneWriter1),
              .ctx = this,
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
              .camera_medium = Calls::camera_medium,
              .film = Calls::film,
              .settings = Calls::settings,
              .report = Calls::report,
              .error = Calls::error,
              .progress = Calls::progress,
              .material_table = Calls::material_table};
}

} // namespace restage::io
