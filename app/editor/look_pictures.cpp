// SPDX-License-Identifier: Apache-2.0
#include "look_pictures.hpp"

#include "document/looks.hpp"
#include "scene/development.hpp"

#include <algorithm>
#include <utility>

namespace restage::editor {

namespace {

constexpr std::uint32_t longer_side = 192; // [pixel]
constexpr std::uint32_t samples = 48; // a pixel

glm::uvec2 small_size(const scene::Film& film) {
    const double width = std::max(film.width, 1u), height = std::max(film.height, 1u);
    const double scale = longer_side / std::max(width, height);
    return glm::max(glm::uvec2(glm::dvec2(width, height) * scale + 0.5), glm::uvec2(8));
}

} // namespace

LookPictures::Picture& LookPictures::find(const std::string& name, const Of& of) {
    const auto [at, fresh] = pictures_.try_emplace(name);
    if (fresh) // a renamed or duplicated look has its picture already
        for (const auto& [other, picture] : pictures_)
            if (picture.texture && picture.made == of) {
                at->second = picture;
                at->second.number = 0;
                at->second.texture = pool_.take();
                at->second.display.reset();
            }
    return at->second;
}

LookPictures::Shown LookPictures::picture(const SmallPictures::Maker& maker, const scene::Scene& now,
                                          const document::Look& look, const view::DisplaySettings& display) {
    const Of of{.state = look.state,
                .meshes = now.meshes.version(),
                .objects = now.instances.live(),
                .lights = now.lights.live(),
                .size = small_size(now.film.value),
                .plugins = maker.registry.version()};
    Picture& one = find(look.name, of);
    if (!(one.asked == of)) {
        scene::Scene scene = document::with_look(now, look);
        if (!scene.cameras.find(scene.active_camera.value)) return {};
        one.asked = of;
        one.failed = false;
        one.number = next_++;
        one.exposure = scene.film.value.exposure;
        one.development = scene::development_of(scene);
        scene.film.value.width = of.size.x;
        scene.film.value.height = of.size.y;
        scene.film.value.crop = {0, 1, 0, 1};
        renders_.ask(maker, {.number = one.number, .scene = std::move(scene), .samples = samples});
    }
    const auto place = renders_.place(one.number);
    if (one.image.width == 0) return {.failed = one.failed, .place = place};
    view::DisplaySettings settings = display;
    settings.layer = view::picture_layer;
    settings.scale = one.exposure;
    settings.development = one.development;
    if (!one.texture) one.texture = pool_.take();
    if (!one.display || *one.display != settings) {
        std::vector<std::uint32_t> rgba;
        view::to_display(one.image, settings, rgba);
        view::over_checkers(one.image.width, rgba);
        one.texture->set(one.image.width, one.image.height, rgba);
        one.display = settings;
    }
    return {.texture = one.texture.get(),
            .size = {float(one.image.width), float(one.image.height)},
            .stale = !(one.made == of),
            .failed = one.failed,
            .place = place};
}

void LookPictures::poll() {
    for (SmallPictures::Made& made : renders_.take())
        for (auto& [name, picture] : pictures_)
            if (picture.number == made.number) {
                picture.failed = made.image.width == 0;
                if (picture.failed) break;
                picture.image = std::move(made.image);
                picture.made = picture.asked;
                picture.display.reset();
                break;
            }
}

void LookPictures::forget() {
    renders_.forget();
    pictures_.clear();
}

} // namespace restage::editor
