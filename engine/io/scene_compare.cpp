// SPDX-License-Identifier: Apache-2.0
// Every item is described by a text that equal items share; instances of one description are paired by place.
#include "io/scene_compare.hpp"

#include "base/file.hpp"
#include "scene/params.hpp"
#include "scene/projection.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace restage::io {

using namespace scene;

namespace {

std::string shown(float x) { // six digits: beyond the effects of text formats and operation order
    return fmt::format("{:.6g}", x == 0 ? 0.f : x);
}
std::string shown(glm::vec3 v) { return shown(v.x) + " " + shown(v.y) + " " + shown(v.z); }

bool close(const glm::dmat4& a, const glm::dmat4& b, double tolerance) {
    double size = 0, difference = 0;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) {
            size = std::max({size, std::abs(a[c][r]), std::abs(b[c][r])});
            difference = std::max(difference, std::abs(a[c][r] - b[c][r]));
        }
    return difference <= tolerance * std::max(size, 1.0);
}

template <class T>
std::uint64_t hash_of(const std::vector<T>& values, std::uint64_t seed) {
    return hash64(values.data(), values.size() * sizeof(T), seed ^ values.size());
}

class Describer {
  public:
    Describer(const Scene& scene, const plugin::Registry& registry, bool names)
        : scene_(scene), registry_(registry), names_(names) {
        scene.instances.each([&](auto, const Instance& i) { ++members_[i.group.value]; });
    }

    std::string mesh(Id<Mesh> id) {
        std::string& text = meshes_[id.value];
        const Mesh* m = scene_.meshes.find(id);
        if (text.empty() && m && m->data) {
            const MeshData& d = *m->data;
            std::uint64_t hash = hash_of(d.positions, hash_of(d.normals, hash_of(d.uvs, hash_of(d.triangles, 1))));
            hash = hash_of(d.tangents, hash_of(d.uvs2, hash));
            text = "mesh of " + std::to_string(d.triangles.size()) + " triangles, hash " + std::to_string(hash);
        }
        return text.empty() ? "no mesh" : text;
    }

    std::string image(Id<Image> id) {
        const Image* i = scene_.images.find(id);
        if (!i) return "no image";
        std::string& text = images_[id.value];
        if (text.empty() && i->data)
            text = "image " + std::to_string(i->data->width) + "x" + std::to_string(i->data->height) + ", hash " +
                   std::to_string(hash_of(i->data->values, i->data->channels));
        if (text.empty())
            text = "image file " + i->path.substr(i->path.find_last_of("/\\") + 1) +
                   (i->encoding == scene::Encoding::linear ? " linear" : "");
        return text;
    }

    std::string texture(Id<Texture> id, int depth) {
        const Texture* t = scene_.textures.find(id);
        if (!t || depth > 16) return "no texture";
        std::string text = t->type + (t->is_float ? " float" : "");
        if (t->image) text += " (" + image(t->image) + ")";
        static const std::map<std::string, std::string, std::less<>> defaults{
            {"uscale", "1"}, {"vscale", "1"}, {"udelta", "0"},   {"vdelta", "0"},
            {"scale", "1"},  {"invert", "0"}, {"wrap", "repeat"}};
        std::map<std::string, std::string> params;
        for (const auto& [name, v] : t->params.entries()) {
            const std::string shown_value = value(v, depth);
            if (const auto it = defaults.find(name); it == defaults.end() || it->second != shown_value)
                params[name] = shown_value;
        }
        return text + list(params);
    }

    std::string material(Id<Material> id, int depth = 0) {
        const Material* m = scene_.materials.find(id);
        if (!m || depth > 16) return "no material";
        std::map<std::string, std::string> params;
        if (const auto plugin = registry_.find_material(m->type)) {
            for (const model::Param& line : plugin->table->params) {
                const Value* set = m->params.find(line.id);
                params[line.id] = value(set ? *set : default_value(line), depth);
            }
            for (const char* common : {"bump", "normalmap"})
                if (m->params.texture(common)) params[common] = texture(m->params.texture(common), depth + 1);
        } else {
            for (const auto& [name, v] : m->params.entries())
                params[name] = value(v, depth);
        }
        return m->type + list(params);
    }

    std::string values(const ParamSet& params) {
        std::map<std::string, std::string> all;
        for (const auto& [name, v] : params.entries())
            all[name] = value(v, 0);
        return list(all);
    }

    std::string medium(Id<Medium> id) {
        const Medium* m = scene_.media.find(id);
        return m ? "(" + shown(m->sigma_a) + ", " + shown(m->sigma_s) + ", " + shown(m->g) + ")" : "vacuum";
    }

    std::string instance(const Instance& i) {
        std::string text = mesh(i.mesh) + "; " + material(i.material);
        if (i.emission)
            text += "; emits " + shown(i.emission->radiance) + (i.emission->two_sided ? " from both sides" : "") +
                    (i.emission->unseen ? " unseen" : "");
        if (i.media) text += "; media " + medium(i.media->interior) + " " + medium(i.media->exterior);
        if (i.alpha_texture)
            text += "; alpha " + texture(i.alpha_texture, 0);
        else if (i.alpha != 1)
            text += "; alpha " + shown(i.alpha);
        if (i.alpha_mask && (i.alpha_texture || i.alpha != 1)) text += " as a mask";
        if (i.reverse_orientation) text += "; reversed";
        if (i.hidden) text += "; hidden";
        if (i.catcher) text += "; shadow catcher";
        if (i.group && members_[i.group.value] > 1)
            text += "; in a group of " + std::to_string(members_[i.group.value]);
        if (!names_) return text;
        text += "; called \"" + i.name + "\", in \"" + group(i.group) + "\"";
        if (const Material* m = scene_.materials.find(i.material)) text += ", of \"" + m->name + "\"";
        if (const Mesh* m = scene_.meshes.find(i.mesh)) text += ", mesh \"" + m->name + "\"";
        return text;
    }

    std::string group(Id<Group> id) {
        std::string path;
        const Group* g = scene_.groups.find(id);
        for (int depth = 0; g && depth < 100; ++depth, g = scene_.groups.find(g->parent))
            path = g->name + (path.empty() ? "" : "/") + path;
        return path;
    }

  private:
    std::string value(const Value& v, int depth) {
        if (v.texture) return texture(v.texture, depth + 1);
        switch (v.type) {
            case model::ParamType::color:
                return shown(glm::vec3(v.v[0], v.v[1], v.v[2]));
            case model::ParamType::choice:
            case model::ParamType::text:
                return v.text;
            case model::ParamType::table: // an export may have copied it
                return std::filesystem::path(v.text).filename().string();
            case model::ParamType::material:
                return "{" + material(v.material, depth + 1) + "}";
            case model::ParamType::texture:
                return "none";
            default:
                return v.is_whole() ? std::to_string(v.i) : shown(v.v[0]);
        }
    }
    static std::string list(const std::map<std::string, std::string>& params) {
        std::string text = " [";
        for (const auto& [name, v] : params)
            text += " " + name + "=" + v;
        return text + " ]";
    }

    const Scene& scene_;
    const plugin::Registry& registry_;
    const bool names_;
    std::unordered_map<std::uint32_t, std::string> meshes_, images_;
    std::unordered_map<std::uint32_t, std::size_t> members_;
};

class Comparison {
  public:
    Comparison(const Scene& a, const Scene& b, const plugin::Registry& registry, const SceneCompareOptions& options)
        : a_(a),
          b_(b),
          describe_a_(a, registry, options.names),
          describe_b_(b, registry, options.names),
          options_(options) {}

    std::vector<std::string> run() {
        instances();
        lights();
        environment();
        camera();
        film();
        if (options_.names) names();
        if (found_ > options_.most) out_.push_back(std::to_string(found_ - options_.most) + " more differences");
        return std::move(out_);
    }

  private:
    void differ(const std::string& sentence) {
        if (++found_ <= options_.most) out_.push_back(sentence);
    }
    void same(const std::string& what, const std::string& x, const std::string& y) {
        if (x != y) differ(what + ": " + x + " | " + y);
    }

    void instances() {
        struct Other {
            glm::dmat4 place;
            bool taken = false;
        };
        std::map<std::string, std::vector<Other>> others;
        b_.instances.each(
            [&](auto, const Instance& i) { others[describe_b_.instance(i)].push_back({i.object_to_world}); });
        std::size_t left = b_.instances.live();
        a_.instances.each([&](auto, const Instance& i) {
            const std::string text = describe_a_.instance(i);
            auto& candidates = others[text];
            const auto match = std::find_if(candidates.begin(), candidates.end(), [&](const Other& o) {
                return !o.taken && close(i.object_to_world, o.place, options_.transform_tolerance);
            });
            if (match != candidates.end()) {
                match->taken = true;
                --left;
            } else {
                differ("instance \"" + i.name + "\" has no match in the second scene" +
                       (candidates.empty() ? ": " + text : " at its place"));
            }
        });
        if (left > 0)
            for (const auto& [text, list] : others)
                for (const Other& o : list)
                    if (!o.taken) differ("only in the second scene: " + text);
    }

    void lights() {
        const auto describe = [this](const Scene& s) {
            std::vector<std::string> all;
            s.lights.each([&](auto, const Light& l) {
                const glm::dvec3 at(l.light_to_world[3]), along = glm::normalize(glm::dvec3(l.light_to_world[2]));
                std::string text = scene::light_row(l.kind).id + std::string(" light of ") + shown(l.value);
                if (scene::light_row(l.kind).placed) text += " at " + shown(glm::vec3(at));
                if (scene::light_row(l.kind).aimed) text += " along " + shown(glm::vec3(glm::round(along * 1e6) / 1e6));
                if (scene::light_row(l.kind).cone)
                    text += " cone " + shown(l.cone_angle) + " " + shown(l.cone_delta) +
                            (l.falloff == scene::Falloff::quartic ? " quartic" : "");
                if (l.hidden) text += "; hidden";
                if (options_.names) text += " called \"" + l.name + "\"";
                all.push_back(std::move(text));
            });
            return all;
        };
        same_list("lights", describe(a_), describe(b_));
    }

    void names() { // of items not covered by instances and lights
        const auto groups = [](const Scene& s, Describer& d) {
            std::vector<std::string> all;
            s.groups.each([&](Id<Group> id, const Group&) { all.push_back(d.group(id)); });
            return all;
        };
        same_list("groups", groups(a_, describe_a_), groups(b_, describe_b_));
        const auto cameras = [](const Scene& s) {
            std::vector<std::string> all;
            s.cameras.each([&](Id<Camera> id, const Camera& c) {
                all.push_back("\"" + c.name + "\", fov " + shown(fov(c, s)) + " at " +
                              shown(glm::vec3(c.camera_to_world[3])) + (id == s.active_camera.value ? ", active" : ""));
            });
            return all;
        };
        same_list("cameras", cameras(a_), cameras(b_));
    }

    void same_list(const char* what, std::vector<std::string> x, std::vector<std::string> y) {
        std::sort(x.begin(), x.end());
        std::sort(y.begin(), y.end());
        for (std::size_t i = 0; i < std::max(x.size(), y.size()); ++i)
            same(what, i < x.size() ? x[i] : "none", i < y.size() ? y[i] : "none");
    }

    void environment() {
        const auto &x = a_.environment.value, &y = b_.environment.value;
        if (!x || !y) {
            same("environment", x ? "there" : "none", y ? "there" : "none");
            return;
        }
        const auto describe = [](Describer& d, const Environment& e) {
            return shown(e.scale) +
                   (e.image ? ", " + d.image(e.image) + ", mapping " + std::to_string(int(e.mapping)) : "") +
                   (e.hidden_from_camera ? ", hidden from the camera" : "");
        };
        if (options_.names)
            same("sky", x->sky + describe_a_.values(x->sky_params), y->sky + describe_b_.values(y->sky_params));
        same("environment", describe(describe_a_, *x), describe(describe_b_, *y));
        if (x->image && !close(x->light_to_world, y->light_to_world, options_.transform_tolerance))
            differ("environment: rotated differently");
    }

    // As seen in the picture, however the camera expresses it.
    static float fov(const Camera& c, const Scene& s) {
        const Film& film = s.film.value;
        return static_cast<float>(camera_fov(c, double(film.width) / film.height));
    }

    void camera() {
        const Camera *x = a_.cameras.find(a_.active_camera.value), *y = b_.cameras.find(b_.active_camera.value);
        if (!x || !y) {
            same("camera", x ? "there" : "none", y ? "there" : "none");
            return;
        }
        const auto describe = [](const Camera& c, const Scene& s) {
            std::string text = "projection " + std::to_string(int(c.projection)) +
                               (c.projection == scene::Projection::perspective ? ", fov " + shown(fov(c, s)) : "") +
                               ", lens " + shown(c.lens_radius) + ", aspect " + shown(c.frame_aspect);
            if (c.lens_radius > 0) text += ", focus " + shown(c.focal_distance);
            if (c.screen_window)
                text += ", window " + shown(glm::vec3(*c.screen_window)) + " " + shown(c.screen_window->w);
            return text;
        };
        same("camera", describe(*x, a_), describe(*y, b_));
        if (!close(x->camera_to_world, y->camera_to_world, options_.transform_tolerance))
            differ("camera: placed differently");
        same("medium of the camera", describe_a_.medium(a_.settings.value.camera_medium),
             describe_b_.medium(b_.settings.value.camera_medium));
    }

    void film() {
        const auto describe = [](const Scene& s) {
            const Film& f = s.film.value;
            return std::to_string(f.width) + "x" + std::to_string(f.height) + ", crop " + shown(glm::vec3(f.crop)) +
                   " " + shown(f.crop.w) + ", filter " + std::to_string(static_cast<int>(f.filter.kind)) + " " +
                   shown(glm::vec3(f.filter.radius, f.filter.params.x)) + " " + shown(f.filter.params.y) +
                   ", exposure " + shown(f.exposure) + ", depth " + std::to_string(s.settings.value.max_depth) +
                   ", samples " + std::to_string(s.settings.value.samples);
        };
        same("film and settings", describe(a_), describe(b_));
    }

    const Scene &a_, &b_;
    Describer describe_a_, describe_b_;
    const SceneCompareOptions& options_;
    std::vector<std::string> out_;
    std::size_t found_ = 0;
};

} // namespace

std::vector<std::string> structural_differences(const Scene& a, const Scene& b, const plugin::Registry& registry,
                                                const SceneCompareOptions& options) {
    return Comparison(a, b, registry, options).run();
}

} // namespace restage::io
