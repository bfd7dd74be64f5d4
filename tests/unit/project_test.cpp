// SPDX-License-Identifier: Apache-2.0
// Project files: whatever was edited comes back exactly, by any road; a base that moved, changed or went is told in a
// sentence; what is not understood is kept.
#include "session/project.hpp"
#include "base/file.hpp"
#include "io/image_file.hpp"
#include "io/scene_compare.hpp"
#include "scene/bounds.hpp"
#include "session/project_fields.hpp"
#include "session/session.hpp"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace fs = std::filesystem;
using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr const char* room = R"(
LookAt 0 2 -6  0 1 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 64 "integer yresolution" 48
WorldBegin
LightSource "infinite" "rgb L" [ 0.4 0.45 0.5 ]
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [ 0.1 0.1 0.1 ] "rgb tex2" [ 0.8 0.8 0.8 ]
Texture "wood" "spectrum" "imagemap" "string filename" "wood.png"
MakeNamedMaterial "floor" "string type" "diffuse" "texture reflectance" "checks"
MakeNamedMaterial "oak" "string type" "diffuse" "texture reflectance" "wood"
MakeNamedMaterial "steel" "string type" "conductor" "float roughness" 0.3
AttributeBegin
  NamedMaterial "floor"
  Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" [ -5 0 -5  5 0 -5  5 0 5  -5 0 5 ]
AttributeEnd
ObjectBegin "chair"
  NamedMaterial "oak"
  Shape "sphere" "float radius" 0.5
  NamedMaterial "steel"
  Shape "disk" "float radius" 0.7
ObjectEnd
AttributeBegin
  Translate 1 0.5 0
  ObjectInstance "chair"
AttributeEnd
AttributeBegin
  Translate -1 0.5 0
  ObjectInstance "chair"
AttributeEnd
AttributeBegin
  Translate 0 3 0
  AreaLightSource "diffuse" "rgb L" [ 10 10 10 ]
  # name: Lamp
  Shape "disk" "float radius" 0.4
AttributeEnd
LightSource "point" "rgb I" [ 3 3 3 ] "point3 from" [ 2 3 -2 ]
)";

struct Fixture {
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log};
    fs::path folder = fs::temp_directory_path() / "restage_project_test";
    Fixture() {
        registry.scan(
            std::vector<plugin::SearchPath>{{fs::path(RESTAGE_BINARY_DIR) / "lib" / "restage" / "plugins", true}});
        fs::remove_all(folder);
        fs::create_directories(folder / "scenes");
        PixelData wood{.width = 4, .height = 2, .channels = 3, .values = std::vector<float>(24, 0.25f)};
        REQUIRE(io::write_png(at("scenes/wood.png"), wood));
        REQUIRE(write_file_atomic(at("scenes/room.pbrt"), room));
    }
    ~Fixture() { fs::remove_all(folder); }
    std::string at(const char* name) const { return (folder / name).string(); }
    void opened(session::Session& session) const {
        const auto done = session.open(at("scenes/room.pbrt"));
        INFO((done ? "" : done.error().message));
        REQUIRE(done);
    }
};

// --- exact comparison: ids by their order, heavy data by content
// ---------------------------------------------------------

struct ByOrder { // a visitor of fields()
    const Scene& scene;
    template <class T>
    void operator()(const char*, T& value) {
        remap(value);
    }
    void path(const char*, std::string&) {}
    void mesh(Mesh& m) { m.data = nullptr; }
    void image(Image& i) { i.data = nullptr; }

    template <class T>
    void remap(T&) {}
    template <class T>
    void remap(Id<T>& id) {
        std::uint32_t n = 0;
        table<T>(scene).each([&](Id<T> other, const T&) { n += other.value <= id.value; });
        id.value = id ? n : 0;
    }
    template <class T>
    void remap(std::optional<T>& x) {
        if constexpr (requires { session::fields(*this, *x); })
            if (x) session::fields(*this, *x);
    }
    void remap(ParamSet& params) {
        const ParamSet old = params;
        for (const auto& [id, value] : old.entries()) {
            Value v = value;
            remap(v.texture);
            remap(v.material);
            params.set(id, v);
        }
    }
};

template <class D>
bool same_data(const std::shared_ptr<const D>& a, const std::shared_ptr<const D>& b) {
    if (a == b || !a || !b) return a == b;
    if constexpr (std::is_same_v<D, MeshData>)
        return a->positions == b->positions && a->normals == b->normals && a->uvs == b->uvs &&
               a->triangles == b->triangles && a->lower == b->lower && a->upper == b->upper;
    else
        return a->width == b->width && a->height == b->height && a->channels == b->channels && a->values == b->values;
}

void check_same(const Scene& a, const Scene& b) {
    session::each_kind([&]<class T>(const char* kind) {
        std::vector<T> left, right;
        table<T>(a).each([&](auto, const T& item) { left.push_back(item); });
        table<T>(b).each([&](auto, const T& item) { right.push_back(item); });
        INFO(kind);
        REQUIRE(left.size() == right.size());
        for (std::size_t i = 0; i < left.size(); ++i) {
            INFO(i << ": " << left[i].name << " / " << right[i].name);
            if constexpr (requires { left[i].data; }) CHECK(same_data(left[i].data, right[i].data));
            ByOrder of_a{a}, of_b{b};
            session::fields(of_a, left[i]);
            session::fields(of_b, right[i]);
            CHECK(left[i] == right[i]);
        }
    });
    auto ea = a.environment.value, eb = b.environment.value;
    ByOrder{a}.remap(ea);
    ByOrder{b}.remap(eb);
    CHECK(ea == eb);
    auto ca = a.active_camera.value, cb = b.active_camera.value;
    ByOrder{a}.remap(ca);
    ByOrder{b}.remap(cb);
    CHECK(ca == cb);
    CHECK(a.film.value == b.film.value);
    auto sa = a.settings.value, sb = b.settings.value;
    ByOrder{a}.remap(sa.camera_medium);
    ByOrder{b}.remap(sb.camera_medium);
    CHECK(sa == sb);
}

// --- random edits: every kind of thing is added, changed in every field, removed
// ------------------------------------------

class Monkey {
  public:
    Monkey(const Fixture& files, unsigned seed) : files_(files), random_(seed) {}

    void edit(session::Session& session) {
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
                    environment->mapping = pick(2) ? RESTAGE_EQUIRECT : RESTAGE_OCTAHEDRAL;
                    environment->scale = vec();
                    environment->light_to_world = matrix();
                    environment->origin = origin();
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
                if (f.width < 64 || f.height < 64) f.crop = {0, 1, 0, 1}; // a crop of less than a pixel is none
                e = set_film(s, f);
                break;
            }
            case 10: {
                Settings o = s.settings.value;
                if (pick(2)) o.max_depth = pick(100);
                if (pick(2)) o.samples = 1 + pick(100);
                if (pick(2)) o.russian_roulette = !o.russian_roulette;
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
        session.edit(std::move(e));
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
    Origin origin() { return pick(2) ? Origin{} : Origin{name() + "\n=* more", "pbrt-v4"}; }
    template <class T>
    Id<T> any(const Scene& s) {
        std::vector<Id<T>> all;
        table<T>(s).each([&](Id<T> id, const T&) { all.push_back(id); });
        return all.empty() ? Id<T>{} : all[pick(unsigned(all.size()))];
    }
    Value value(const Scene& s) {
        switch (pick(9)) {
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
                return {.type = RESTAGE_TEXT, .text = name()};
            case 6:
                return {.type = RESTAGE_MATERIAL, .material = {}};
            case 7:
                return {.type = RESTAGE_TEXTURE, .texture = any<Texture>(s)};
            default:
                return {.type = RESTAGE_COLOR, .v = {x(), x(), x(), 0}, .texture = any<Texture>(s)};
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
        }
        if (pick(2)) data->normals.assign(4, {0, 0, 1});
        if (pick(2)) data->uvs.clear();
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
            i.encoding = pick(2) ? RESTAGE_SRGB : RESTAGE_LINEAR;
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
        if (pick(2)) t.type = pick(2) ? "imagemap" : "one nobody knows";
        if (pick(2)) t.is_float = !t.is_float;
        if (pick(2)) t.image = any<Image>(s);
        ParamSet without; // textures in textures could make circles, which validate() refuses
        params(Scene{}, t.params);
        t.origin = origin();
    }
    void change(const Scene& s, Material& m) {
        m.name = name();
        if (pick(2)) m.type = pick(2) ? "plastic" : "one nobody knows";
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
        if (pick(2)) i.emission = pick(2) ? std::optional(Emission{vec(), pick(2) == 1}) : std::nullopt;
        if (pick(2)) i.media = pick(2) ? std::optional(MediumInterface{any<Medium>(s), {}}) : std::nullopt;
        if (pick(2)) i.alpha_texture = any<Texture>(s);
        if (pick(2)) i.alpha = x();
        if (pick(2)) i.reverse_orientation = !i.reverse_orientation;
        if (pick(2)) i.hidden = !i.hidden;
        if (pick(2)) i.origin = origin();
    }
    void change(const Scene&, Light& l) {
        l.name = name();
        l.kind = static_cast<RestageLightKind>(1 + pick(3));
        l.value = vec();
        l.light_to_world = matrix();
        l.cone_angle = 20 + x();
        l.cone_delta = x();
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
        c.origin = origin();
    }

    const Fixture& files_;
    std::mt19937 random_;
};

} // namespace

TEST_CASE("Any edits come back exactly from a project file", "[project]") {
    const Fixture files;
    const unsigned seed = GENERATE(Catch::Generators::range(1u, 41u));
    INFO("seed " << seed);
    session::Session session(files.registry);
    const bool based = seed % 4 != 0; // or made in the program
    if (based) files.opened(session);
    Monkey monkey(files, seed);
    for (int i = 0; i < 60; ++i)
        monkey.edit(session);
    const auto saved = session.save_project(files.at("edited.restage"));
    INFO((saved ? "" : saved.error().message));
    REQUIRE(saved);
    CHECK_FALSE(session.modified());

    session::Session other(files.registry);
    const auto opened = other.open(files.at("edited.restage"));
    INFO((opened ? "" : opened.error().message));
    INFO(read_file(files.at("edited.restage")).value());
    REQUIRE(opened);
    check_same(session.scene(), other.scene());
    CHECK(io::structural_differences(session.scene(), other.scene(), files.registry) == std::vector<std::string>{});
    CHECK_FALSE(other.modified());
    // Saved again, not a byte differs, also from another folder and back.
    fs::create_directories(files.folder / "else");
    REQUIRE(other.save_project(files.at("else/again.restage")));
    session::Session third(files.registry);
    REQUIRE(third.open(files.at("else/again.restage")));
    REQUIRE(third.save_project(files.at("back.restage")));
    CHECK(read_file(files.at("back.restage")).value() == read_file(files.at("edited.restage")).value());
}

TEST_CASE("A project holds what changed and nothing else", "[project]") {
    const Fixture files;
    session::Session session(files.registry);
    files.opened(session);
    const auto steel = session.find<Material>("steel");
    REQUIRE(session.set_param(steel, "uroughness", Value::number(0.1f)));
    REQUIRE(session.save_project(files.at("one.restage")));
    const std::string text = read_file(files.at("one.restage")).value();
    CHECK_THAT(text, ContainsSubstring("\"file\": \"scenes/room.pbrt\""));
    CHECK_THAT(text, ContainsSubstring("steel\": {\n        \"params\": {\n          \"uroughness\": 0.1\n"));
    CHECK_THAT(text, !ContainsSubstring("oak") && !ContainsSubstring("instances\": {") && !ContainsSubstring("film"));
}

TEST_CASE("Undo and redo go on across a save", "[project]") {
    const Fixture files;
    session::Session session(files.registry);
    files.opened(session);
    const Scene before = session.scene();
    REQUIRE(session.set_param(session.find<Material>("steel"), "uroughness", Value::number(0.1f)));
    REQUIRE(session.save_project(files.at("p.restage")));
    CHECK_FALSE(session.modified());
    REQUIRE(session.undo());
    CHECK(session.modified());
    check_same(session.scene(), before);
    REQUIRE(session.redo());
    CHECK_FALSE(session.modified());
}

TEST_CASE("What is inserted from a file is named, not held, and stands in when it goes", "[project]") {
    const Fixture files;
    session::Session session(files.registry);
    files.opened(session);
    REQUIRE(write_file_atomic(files.at("scenes/lamp.pbrt"),
                              "WorldBegin\nShape \"sphere\" \"float radius\" 0.2\n"
                              "Shape \"disk\" \"float radius\" 0.3\n"));
    const auto lamp = io::import_scene(files.at("scenes/lamp.pbrt"), files.registry);
    REQUIRE(lamp);
    const auto merged =
        session.insert(*lamp, files.at("scenes/lamp.pbrt"), session::Session::Stand{.at = {0, 1, 0}, .up = {0, 1, 0}});
    REQUIRE(merged);
    const auto& made = merged->instances;
    REQUIRE(made.size() == 2);
    CHECK(session.scene().groups[session.scene().instances[made[0]].group].name == "lamp");
    Bounds bounds = world_bounds(session.scene(), made[0]);
    bounds.add(world_bounds(session.scene(), made[1]));
    CHECK(std::abs(bounds.lower.y - 1) < 1e-6);
    CHECK(session.history().size() == 1); // one step
    REQUIRE(session.save_project(files.at("lamp.restage")));
    const std::string text = read_file(files.at("lamp.restage")).value();
    CHECK_THAT(text, ContainsSubstring("\"file\": \"scenes/lamp.pbrt\"") && !ContainsSubstring("positions"));
    session::Session other(files.registry);
    REQUIRE(other.open(files.at("lamp.restage")));
    check_same(session.scene(), other.scene());

    fs::rename(files.at("scenes/lamp.pbrt"), files.at("scenes/elsewhere.pbrt"));
    session::Session without(files.registry);
    REQUIRE(without.open(files.at("lamp.restage")));
    CHECK(without.report().count(RESTAGE_DROPPED) == 3); // the file, and two meshes of it
    CHECK(without.scene().instances.live() == session.scene().instances.live());
    REQUIRE(without.save_project(files.at("lamp2.restage")));
    CHECK(read_file(files.at("lamp2.restage")).value() == text); // and nothing is lost
}

TEST_CASE("A base that moved or changed is told, and can be named anew", "[project]") {
    const Fixture files;
    session::Session session(files.registry);
    files.opened(session);
    REQUIRE(session.set_param(session.find<Material>("steel"), "uroughness", Value::number(0.1f)));
    Id<Instance> disk;
    session.scene().instances.each([&](Id<Instance> id, const Instance& i) {
        if (i.emission) disk = id;
    });
    const std::string lamp_name = session.scene().instances[disk].name;
    REQUIRE(session.remove(std::array{disk}));
    REQUIRE(session.save_project(files.at("p.restage")));

    session::BaseProblem problem{};
    const auto open = [&](session::ReadOptions options) {
        problem = {};
        options.problem = &problem;
        return session::read_document(files.at("p.restage"), files.registry, options);
    };
    SECTION("moved") {
        fs::rename(files.at("scenes/room.pbrt"), files.at("scenes/moved.pbrt"));
        const auto gone = open({});
        REQUIRE_FALSE(gone);
        CHECK(problem == session::BaseProblem::missing);
        CHECK_THAT(gone.error().message, ContainsSubstring("p.restage") && ContainsSubstring("scenes/room.pbrt") &&
                                             ContainsSubstring("put it back"));
        auto found = open({.base = files.at("scenes/moved.pbrt")});
        REQUIRE(found);
        session::Session other(files.registry);
        other.adopt(std::move(*found));
        check_same(session.scene(), other.scene());
    }
    SECTION("with more in it, so that ids have moved") {
        std::string more = room;
        more.insert(more.find("AttributeBegin"),
                    "MakeNamedMaterial \"brass\" \"string type\" \"conductor\"\n"
                    "NamedMaterial \"brass\"\nShape \"sphere\"\n");
        more.insert(more.find("MakeNamedMaterial"), "MakeNamedMaterial \"clay\" \"string type\" \"diffuse\"\n");
        REQUIRE(write_file_atomic(files.at("scenes/room.pbrt"), more));
        auto found = open({});
        INFO((found ? "" : found.error().message));
        REQUIRE(found);
        CHECK(found->report.count(RESTAGE_APPROXIMATED) >= 1);
        session::Session other(files.registry);
        other.adopt(std::move(*found));
        CHECK(other.scene().materials[other.find<Material>("steel")].params.number("uroughness", 0) == 0.1f);
        CHECK(other.scene().instances.live() == session.scene().instances.live() + 1);
    }
    SECTION("without what was changed") {
        std::string less = room;
        for (std::size_t at; (at = less.find("steel")) != std::string::npos;)
            less.replace(at, 5, "lead");
        REQUIRE(write_file_atomic(files.at("scenes/room.pbrt"), less));
        const auto lost = open({});
        REQUIRE_FALSE(lost);
        CHECK(problem == session::BaseProblem::changed);
        CHECK_THAT(lost.error().message, ContainsSubstring("material \"steel\"") && ContainsSubstring("room.pbrt"));
        auto part = open({.drop_lost = true});
        REQUIRE(part);
        CHECK(part->report.count(RESTAGE_DROPPED) == 1);
        session::Session other(files.registry);
        other.adopt(std::move(*part));
        CHECK_FALSE(other.find<Instance>(lamp_name)); // that change still fits
    }
}

TEST_CASE("A project of tomorrow keeps what we do not know", "[project]") {
    const Fixture files;
    session::Session session(files.registry);
    files.opened(session);
    REQUIRE(session.set_param(session.find<Material>("steel"), "uroughness", Value::number(0.1f)));
    REQUIRE(session.save_project(files.at("p.restage")));
    auto j = session::json::parse(read_file(files.at("p.restage")).value());
    j["storyboard"] = {{"frames", 12}};
    j["materials"]["changed"].begin().value()["aging"] = {{"years", 30}};
    REQUIRE(write_file_atomic(files.at("p.restage"), j.dump(1)));
    session::Session other(files.registry);
    REQUIRE(other.open(files.at("p.restage")));
    REQUIRE(other.set_param(other.find<Material>("steel"), "uroughness", Value::number(0.2f)));
    REQUIRE(other.save_project(files.at("p.restage")));
    const std::string text = read_file(files.at("p.restage")).value();
    CHECK_THAT(text,
               ContainsSubstring("\"frames\": 12") && ContainsSubstring("\"years\": 30") && ContainsSubstring("0.2"));
    // What it hung on is gone: so is it, and nothing else.
    REQUIRE(other.set_param(other.find<Material>("steel"), "uroughness", Value::number(0.3f)));
    REQUIRE(other.save_project(files.at("p.restage")));
    const std::string same = read_file(files.at("p.restage")).value();
    CHECK_THAT(same, ContainsSubstring("storyboard") && !ContainsSubstring("years"));
}

TEST_CASE("Damaged projects are refused with the place", "[project]") {
    const Fixture files;
    const auto message = [&](const std::string& text) {
        REQUIRE(write_file_atomic(files.at("bad.restage"), text));
        session::Session session(files.registry);
        const auto opened = session.open(files.at("bad.restage"));
        REQUIRE_FALSE(opened);
        return opened.error().message;
    };
    CHECK_THAT(message("{\n  \"restage\": 1,\n  oops\n}"), ContainsSubstring("bad.restage:3:3"));
    CHECK_THAT(message("[1, 2]"), ContainsSubstring("no Restage project"));
    CHECK_THAT(message("{\"restage\": 99}"), ContainsSubstring("newer"));
    const std::string head = "{\"restage\": 1, \"base\": {\"file\": \"scenes/room.pbrt\"}, ";
    CHECK_THAT(message(head + "\"materials\": {\"changed\": {\"steel\": {}}}}"), ContainsSubstring("#17 oak"));
    CHECK_THAT(message(head + "\"instances\": {\"added\": {\"#77 x\": {}}}}"), ContainsSubstring("#77 x"));
    CHECK_THAT(message(head + "\"film\": {\"width\": \"wide\"}}"), ContainsSubstring("film: width: a whole number"));
    CHECK_THAT(message(head + "\"film\": 7}"), ContainsSubstring("film"));
    CHECK_THAT(message(head + "\"meshes\": 7, \"cameras\": {\"added\": []}, \"active_camera\": \"#9 none\"}"),
               ContainsSubstring("bad.restage"));
}
