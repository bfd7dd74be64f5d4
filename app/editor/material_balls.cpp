// SPDX-License-Identifier: Apache-2.0
#include "material_balls.hpp"

#include "base/file.hpp"
#include "base/version.hpp"
#include "io/image_file.hpp"
#include "render/material_types.hpp"
#include "scene/bounds.hpp"
#include "scene/edits.hpp"
#include "scene/same_material.hpp"
#include "scene/sky.hpp"
#include "view/display.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::editor {

namespace {

constexpr std::uint32_t side = 128; // [pixel]
constexpr std::uint32_t samples = 32, first_samples = 4; // a pixel
constexpr std::uint64_t drawing = 1; // a new number: kept pictures are not used any more
constexpr std::size_t most_waiting = 256; // balls; older requests are dropped, and repeated once visible again

// A unit ball around the origin. Textures go around it twice, so that their scale is visible.
std::shared_ptr<const scene::MeshData> ball_mesh() {
    constexpr std::uint32_t rows = 48, columns = 96;
    auto mesh = std::make_shared<scene::MeshData>();
    for (std::uint32_t j = 0; j <= rows; ++j)
        for (std::uint32_t i = 0; i <= columns; ++i) {
            const double u = double(i) / columns, v = double(j) / rows;
            const double theta = std::numbers::pi * v, phi = 2 * std::numbers::pi * u;
            const glm::vec3 p(std::sin(theta) * std::cos(phi), -std::cos(theta), std::sin(theta) * std::sin(phi));
            mesh->positions.push_back(p);
            mesh->normals.push_back(p);
            mesh->uvs.emplace_back(2 * u, v);
        }
    for (std::uint32_t j = 0; j < rows; ++j)
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t a = j * (columns + 1) + i, b = a + columns + 1;
            if (j > 0) mesh->triangles.emplace_back(a, a + 1, b);
            if (j + 1 < rows) mesh->triangles.emplace_back(a + 1, b + 1, b);
        }
    scene::compute_bounds(*mesh);
    return mesh;
}

// Where the picture of a preset is kept; "" = nowhere: a table's file may change unnoticed.
std::filesystem::path kept_at(const MaterialBalls::Maker& maker, const document::Preset& preset) {
    std::filesystem::path cache = maker.options.cache_dir;
    if (cache.empty()) cache = cache_dir().value_or(std::filesystem::path());
    if (cache.empty()) return {};
    std::uint64_t key = scene::material_hash(preset.parts, preset.material);
    bool stable = true;
    preset.parts.materials.each([&](auto, const scene::Material& m) {
        const auto plugin = maker.registry.find_material(m.type);
        const std::uint64_t revision = plugin ? plugin->source->revision() : 0;
        key = hash64(&revision, sizeof revision, key);
        m.params.each_value([&](const scene::Value& v) { stable &= v.type != model::ParamType::table; });
    });
    preset.parts.textures.each([&](auto, const scene::Texture& t) {
        t.params.each_value([&](const scene::Value& v) { stable &= v.type != model::ParamType::table; });
    });
    if (!stable) return {};
    return cache / "balls" / fmt::format("{:016x}-{}-{}-{}.png", key, version(), drawing, side);
}

std::vector<std::uint32_t> read_kept(const std::filesystem::path& file) {
    std::error_code code;
    if (file.empty() || !std::filesystem::exists(file, code)) return {};
    const auto image = io::read_image(file.string(), scene::Encoding::srgb);
    if (!image || image->width != side || image->height != side || image->channels != 3) return {};
    std::vector<std::uint32_t> rgba(std::size_t(side) * side, 0xff000000u);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            rgba[i] |= std::uint32_t(std::lround(255 * io::linear_to_srgb(image->values[3 * i + c]))) << (8 * c);
    return rgba;
}

// Failing is not an error: it is rendered again next time.
void keep(const std::filesystem::path& file, const std::vector<std::uint32_t>& rgba) {
    if (file.empty()) return;
    std::error_code code;
    std::filesystem::create_directories(file.parent_path(), code);
    scene::PixelData image{.width = side, .height = side, .channels = 3, .values = {}};
    image.values.reserve(3 * rgba.size());
    for (const std::uint32_t pixel : rgba)
        for (int c = 0; c < 3; ++c)
            image.values.push_back(io::srgb_to_linear(float(pixel >> (8 * c) & 255) / 255));
    static_cast<void>(io::write_png(file.string(), image));
}

} // namespace

scene::Scene ball_scene(const scene::Scene& scene, scene::Id<scene::Material> id) {
    using namespace scene;
    Scene ball = scene; // shares its data
    Edit rest;
    ball.instances.each(
        [&](Id<Instance> one, const Instance& i) { rest.changes.push_back(Change<Instance>{one, i, std::nullopt}); });
    ball.lights.each(
        [&](Id<Light> one, const Light& l) { rest.changes.push_back(Change<Light>{one, l, std::nullopt}); });
    ball.cameras.each([&](Id<Camera> one, const Camera& c) {
        if (one != ball.active_camera.value) rest.changes.push_back(Change<Camera>{one, c, std::nullopt});
    });
    apply(ball, rest);
    static const std::shared_ptr<const MeshData> mesh = ball_mesh();
    const Id<Mesh> shape = ball.meshes.next();
    apply(ball, insert(ball, Mesh{.name = "ball", .data = mesh}, ""));
    apply(ball, insert(ball, Instance{.name = "ball", .mesh = shape, .material = id}, ""));
    ball.environment.value.reset();
    apply(ball, scene::studio_sky(ball, {0, 1, 0}));
    apply(ball, remove_unused(ball));
    Camera camera{.name = "ball", .fov = 29};
    camera.camera_to_world[3] = {0, 0, -4.1, 1}; // looks along +z
    if (ball.cameras.find(ball.active_camera.value)) {
        apply(ball, set_camera(ball, ball.active_camera.value, camera, "").value());
    } else {
        const Id<Camera> made = ball.cameras.next();
        apply(ball, insert(ball, camera, ""));
        apply(ball, set_active_camera(ball, made).value());
    }
    ball.film.value = Film{.width = side, .height = side};
    ball.settings.value = {};
    return ball;
}

void MaterialBalls::forget() {
    std::erase_if(balls_, [](const auto& one) { return one.second.made.document != 0; });
    ++document_;
    std::erase_if(asked_, [&](const Asked& asked) {
        if (asked.made.document == 0) return false;
        renders_.drop(asked.number);
        return true;
    });
}

const Texture* MaterialBalls::ball(const Maker& maker, const scene::Scene& scene, scene::Id<scene::Material> id) {
    const Made now{.document = document_,
                   .materials = scene.materials.version(),
                   .textures = scene.textures.version(),
                   .images = scene.images.version(),
                   .preset = 0,
                   .plugins = maker.registry.version()};
    return request(maker, std::to_string(id.value), now, [&] {
        return document::Preset{
            .name = {}, .category = {}, .source = {}, .file = {}, .parts = scene, .material = id, .hash = 0};
    });
}

const Texture* MaterialBalls::ball(const Maker& maker, const document::Preset& preset) {
    return request(maker, preset.file.string(), {.preset = preset.hash, .plugins = maker.registry.version()},
                   [&] { return preset; });
}

const Texture* MaterialBalls::request(const Maker& maker, const std::string& key, const Made& now,
                                      const std::function<document::Preset()>& make) {
    Ball& ball = balls_[key];
    if (ball.made != now) {
        ball.made = now;
        std::erase_if(asked_, [&](const Asked& asked) {
            if (asked.key != key) return false;
            renders_.drop(asked.number);
            return true;
        });
        asked_.push_front(
            {.number = next_++, .key = key, .made = now, .pixels = std::make_shared<Pixels::element_type>()});
        SmallPictures::Job wanted = job(maker, make(), now.document == 0, asked_.front().pixels);
        wanted.number = asked_.front().number;
        renders_.ask(maker, std::move(wanted));
        while (asked_.size() > most_waiting) {
            renders_.drop(asked_.back().number);
            balls_[asked_.back().key].made = {};
            asked_.pop_back();
        }
    }
    return ball.texture && ball.texture->ready() ? ball.texture.get() : nullptr;
}

SmallPictures::Job MaterialBalls::job(const Maker& maker, document::Preset preset, bool kept, const Pixels& pixels) {
    SmallPictures::Job job{
        .scene = {}, .samples = samples, .coarse = first_samples, .batch = std::uint64_t(ImGui::GetFrameCount())};
    const auto file = std::make_shared<std::filesystem::path>(); // where it is kept; "" = nowhere
    job.prepare = [maker, kept, file, pixels, preset = std::move(preset)](scene::Scene& scene) mutable -> Result<bool> {
        if (kept) {
            RESTAGE_CHECK(document::read_images(preset));
            *file = kept_at(maker, preset);
            if (*pixels = read_kept(*file); !pixels->empty()) return false;
        }
        scene = ball_scene(preset.parts, preset.material);
        return true;
    };
    job.done = [this, file, pixels](const render::FilmImage& image) {
        view::to_display(image, {}, *pixels);
        keep(*file, *pixels);
        ++rendered_;
    };
    return job;
}

void MaterialBalls::poll() {
    for (const SmallPictures::Made& made : renders_.take()) {
        const auto found = std::ranges::find(asked_, made.number, &Asked::number);
        if (found == asked_.end()) continue; // forgotten, or asked for again
        std::vector<std::uint32_t> pixels;
        if (made.coarse)
            view::to_display(made.image, {}, pixels);
        else
            pixels = *found->pixels;
        if (pixels.size() == std::size_t(side) * side) {
            auto& texture = balls_[found->key].texture;
            if (!texture) texture = pool_.take();
            texture->set(side, side, pixels);
        }
        if (!made.coarse) asked_.erase(found);
    }
}

} // namespace restage::editor
