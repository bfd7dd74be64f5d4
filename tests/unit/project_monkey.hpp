// SPDX-License-Identifier: Apache-2.0
// Monkey: random edits. Every kind of thing is added, changed in every field, removed; the seed replays it.
#pragma once

#include "project_room.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace restage::test {

class Monkey {
  public:
    Monkey(const Fixture& files, unsigned seed) : files_(files), random_(seed) {}

    void edit(document::Session& session) {
        const Scene& s = session.scene();
        Edit e{"random", {}};
        switch (pick(14)) {
            case 0:
                thing<Mesh>(s, e);
                break;
            case 1:
                thing<Image>(s, e);
                break;
            case 2:
                thing<Texture>(s, e);
                break;
            case 3:
                thing<Material>(s, e);
                break;
            case 4:
                thing<Medium>(s, e);
                break;
            case 5:
                thing<Group>(s, e);
                break;
            case 6:
                thing<Light>(s, e);
                break;
            case 7:
                thing<Camera>(s, e);
                break;
            case 8: {
                auto environment = s.environment.value;
                if (pick(4) == 0)
                    environment.reset();
                else {
                    if (!environment) environment.emplace();
                    environment->name = name();
                    environment->image = pick(2) ? any<Image>(s) : Id<Image>{};
                    environment->mapping = pick(2) ? scene::Mapping::equirect : scene::Mapping::octahedral;
                    environment->scale = vec();
                    environment->light_to_world = matrix();
                    environment->hidden_from_camera =
                        environment->mapping == scene::Mapping::octahedral; // draws no random number
                    environment->origin = origin();
                    environment->sky = environment->hidden_from_camera ? "of_tomorrow" : ""; // no plugin makes it
                    environment->sky_params = {};
                    if (environment->hidden_from_camera)
                        environment->sky_params.set("haze", Value::number(environment->scale.x));
                }
                e = set_environment(s, environment);
                break;
            }
            case 9: {
                Film f = s.film.value;
                if (pick(2)) f.width = 1 + pick(5000);
                if (pick(2)) f.height = 1 + pick(5000);
                if (pick(2)) f.crop = {x() / 2, 0.5f + x() / 2, x() / 2, 0.5f + x() / 2};
                if (pick(2)) f.filter = {static_cast<FilterKind>(pick(5)), {1 + x(), 2}, {x(), x()}};
                if (pick(2)) f.exposure = x();
                if (pick(2)) f.filename = name();
                // Without a random number.
                f.development = {.tone = ToneCurve(f.width % 4), .temperature = 3000 + float(f.height % 5000)};
                if (f.width < 64 || f.height < 64) f.crop = {0, 1, 0, 1}; // a crop of less than a pixel is refused
                e = set_film(s, f);
                break;
            }
            case 10: {
                Settings o = s.settings.value;
                if (pick(2)) o.max_depth = pick(100);
                if (pick(2)) o.samples = 1 + pick(100);
                if (pick(2)) o.russian_roulette = !o.russian_roulette;
                if (pick(2)) o.spectral = !o.spectral;
                if (pick(2)) o.adaptive = !o.adaptive;
                if (pick(2)) o.guiding = Technique(pick(3));
                if (pick(2)) o.caustics = Technique(pick(3));
                if (pick(2)) o.clamp_direct = x();
                if (pick(2)) o.clamp_indirect = x();
                if (pick(2)) o.ray_epsilon = x();
                if (pick(2)) o.camera_medium = any<Medium>(s);
                if (pick(2)) o.origin = origin();
                e = set_settings(s, o);
                break;
            }
            case 11:
                if (const auto camera = any<Camera>(s)) e = *set_active_camera(s, camera);
                break;
            case 12:
                e = remove_unused(s);
                break;
            default:
                thing<Instance>(s, e);
                break;
        }
        (void)session.edit(std::move(e)); // refused by check_edit: changes nothing
        if (pick(5) == 0) session.undo();
        if (pick(7) == 0) session.redo();
    }

  private:
    unsigned pick(unsigned n) { return std::uniform_int_distribution<unsigned>(0, n - 1)(random_); }
    float x() { return std::uniform_real_distribution<float>(0.001f, 1)(random_); }
    glm::vec3 vec() { return {x(), x() / 3, x() * 1e-6f}; }
    std::string name() {
        static constexpr const char* names[] = {"oak",        "a \"quoted\" name", "",         "two words",
                                                "\xc3\xa4gg", "#3 hash",           "new\nline"};
        return names[pick(7)] + std::to_string(pick(50));
    }
    glm::dmat4 matrix() {
        return glm::translate(glm::dmat4(1), glm::dvec3(x(), double(x()) / 3, 7)) *
               glm::rotate(glm::dmat4(1), double(x()), glm::normalize(glm::dvec3(x(), x(), 1)));
    }
    Origin origin() {
        if (pick(2)) return {};
        return {name() + "\n", "pbrt-v4",
                pick(2) ? std::vector<OriginValue>{} : std::vector<OriginValue>{{"*", "more"}, {name(), name()}}};
    }
    template <class T>
    Id<T> any(const Scene& s) {
        std::vector<Id<T>> all;
        table<T>(s).each([&](Id<T> id, const T&) { all.push_back(id); });
        return all.empty() ? Id<T>{} : all[pick(unsigned(all.size()))];
    }
    Value value(const Scene& s) {
        switch (pick(10)) {
            case 0:
                return Value::number(x());
            case 1:
                return Value::color(x(), x(), x());
            case 2:
                return Value::integer(int(pick(9)));
            case 3:
                return Value::boolean(pick(2));
            case 4:
                return Value::choice(name());
            case 5:
                return {.type = model::ParamType::text, .text = name()};
            case 6:
                return {.type = model::ParamType::material, .material = {}};
            case 7:
                return {.type = model::ParamType::texture, .texture = any<Texture>(s)};
            case 8:
                return Value::table(std::filesystem::absolute("tables/" + name()).lexically_normal().string());
            default:
                return {.type = model::ParamType::color, .v = {x(), x(), x(), 0}, .texture = any<Texture>(s)};
        }
    }
    void params(const Scene& s, ParamSet& set) {
        for (unsigned i = 0; i < 1 + pick(3); ++i)
            if (const auto& all = set.entries(); pick(3) == 0 && !all.empty())
                set.remove(std::string(all[pick(unsigned(all.size()))].id));
            else
                set.set("p" + std::to_string(pick(6)), value(s));
    }

    template <class T>
    void thing(const Scene& s, Edit& e) {
        const Id<T> id = any<T>(s);
        if (pick(6) == 0 && id) {
            Result<Edit> gone = fail("");
            if constexpr (std::is_same_v<T, Instance>)
                gone = remove_instances(s, std::array{id});
            else
                gone = remove(s, id);
            if (gone) e = *gone; // it may be in use
            return;
        }
        const bool fresh = pick(2) || !id;
        if (std::is_same_v<T, Instance> && !(any<Mesh>(s) && any<Material>(s))) return;
        T item = fresh ? T{} : table<T>(s)[id];
        if (fresh) complete(s, item);
        change(s, item);
        if (fresh)
            e.changes.push_back(Change<T>{table<T>(s).next(), std::nullopt, item});
        else
            e.changes.push_back(Change<T>{id, table<T>(s)[id], item});
    }

    template <class T>
    void complete(const Scene&, T&) {}
    void complete(const Scene& s, Mesh& m) { m.data = mesh(s); }
    void complete(const Scene& s, Image& i) { pixels(s, i); }
    void complete(const Scene& s, Instance& i) {
        i.mesh = any<Mesh>(s);
        i.material = any<Material>(s);
    }
    std::shared_ptr<const MeshData> mesh(const Scene& s) {
        if (const auto other = any<Mesh>(s); other && pick(2)) return s.meshes[other].data; // shared
        auto data = std::make_shared<MeshData>();
        for (int i = 0; i < 4; ++i) {
            data->positions.push_back(vec());
            data->uvs.push_back({x(), x()});
            data->uvs2.push_back({x(), x()});
            data->tangents.push_back({x(), x(), x(), pick(2) ? 1.f : -1.f});
        }
        if (pick(2)) data->normals.assign(4, {0, 0, 1});
        if (pick(2)) data->uvs.clear();
        if (pick(2)) data->uvs2.clear();
        if (pick(2)) data->tangents.clear();
        data->triangles = {{0, 1, 2}, {0, 2, 3}};
        compute_bounds(*data);
        return data;
    }
    void pixels(const Scene& s, Image& i) {
        i.path.clear();
        if (const auto other = any<Image>(s); other && pick(3) == 0)
            i.data = s.images[other].data;
        else if (pick(2)) {
            i.path = files_.at("scenes/wood.png");
            i.encoding = pick(2) ? scene::Encoding::srgb : scene::Encoding::linear;
            i.gamma = 2.2f;
            i.data = std::make_shared<const PixelData>(io::read_image(i.path, i.encoding).value());
        } else
            i.data = std::make_shared<const PixelData>(
                PixelData{.width = 1, .height = 2, .channels = 1, .values = {x(), 1e30f}});
    }

    void change(const Scene& s, Mesh& m) {
        m.name = name();
        if (pick(2)) m.data = mesh(s);
        if (pick(2)) m.source_file = files_.at("scenes/chair.ply");
        if (pick(2)) m.primitive = name();
        m.origin = origin();
    }
    void change(const Scene& s, Image& i) {
        i.name = name();
        if (pick(2)) pixels(s, i);
        i.origin = origin();
    }
    void change(const Scene& s, Texture& t) {
        t.name = name();
        if (pick(2)) t.type = pick(2) ? "imagemap" : "an unknown one";
        if (pick(2)) t.is_float = !t.is_float;
        if (pick(2)) t.image = any<Image>(s);
        ParamSet without; // textures in textures could make cycles, which validate() refuses
        params(Scene{}, t.params);
        t.origin = origin();
    }
    void change(const Scene& s, Material& m) {
        m.name = name();
        if (pick(2)) m.type = pick(2) ? "plastic" : "an unknown one";
        params(s, m.params);
        m.origin = origin();
    }
    void change(const Scene&, Medium& m) {
        m.name = name();
        m.sigma_a = vec();
        m.sigma_s = vec();
        m.g = x();
        m.origin = origin();
    }
    void change(const Scene&, Group& g) {
        g.name = name();
        g.origin = origin();
    }
    void change(const Scene& s, Instance& i) {
        if (pick(2)) i.name = name();
        if (pick(2) && any<Mesh>(s)) i.mesh = any<Mesh>(s);
        if (pick(2) && any<Material>(s)) i.material = any<Material>(s);
        if (pick(2)) i.group = any<Group>(s);
        if (pick(2)) i.object_to_world = matrix();
        if (pick(2)) i.emission = pick(2) ? std::optional(Emission{vec(), pick(2) == 1, pick(2) == 1}) : std::nullopt;
        if (pick(2)) i.media = pick(2) ? std::optional(MediumInterface{any<Medium>(s), {}}) : std::nullopt;
        if (pick(2)) i.alpha_texture = any<Texture>(s);
        if (pick(2)) i.alpha = x();
        if (pick(2)) i.reverse_orientation = !i.reverse_orientation;
        if (pick(2)) i.hidden = !i.hidden;
        if (pick(2)) i.alpha_mask = !i.alpha_mask;
        if (pick(2)) i.origin = origin();
    }
    void change(const Scene&, Light& l) {
        l.name = name();
        l.kind = static_cast<scene::LightKind>(pick(3));
        l.value = vec();
        l.light_to_world = matrix();
        l.cone_angle = 20 + x();
        l.cone_delta = x();
        l.hidden = pick(2) == 1;
        l.origin = origin();
    }
    void change(const Scene&, Camera& c) {
        c.name = name();
        c.camera_to_world = matrix();
        c.fov = 30 + x();
        c.screen_window = pick(2) ? std::optional(glm::vec4(-x(), x(), -x(), x())) : std::nullopt;
        c.lens_radius = x();
        c.focal_distance = x();
        c.frame_aspect = x();
        c.projection = static_cast<scene::Projection>(pick(4));
        c.fit_aspect = pick(2) ? x() : 0;
        c.origin = origin();
    }

    const Fixture& files_;
    std::mt19937 random_;
};

} // namespace restage::test
