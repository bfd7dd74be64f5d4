// SPDX-License-Identifier: Apache-2.0
#include "scene/sky.hpp"

#include "scene/edits.hpp"
#include "scene/uses.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace restage::scene {

namespace {

PixelData studio_pixels() {
    constexpr std::uint32_t width = 64, height = 32;
    PixelData pixels{.width = width, .height = height, .channels = 3, .values = {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const float h = 1 - 2 * (float(y) + 0.5f) / height; // 1 above, -1 below
            const float around = (float(x) + 0.5f) / width - 0.3f;
            const float above = 1 / (1 + std::exp(-10 * (h - 0.45f)));
            const float side = std::exp(-18 * around * around - 12 * (h - 0.35f) * (h - 0.35f));
            pixels.values.insert(pixels.values.end(), 3, 0.35f + 1.1f * above + 1.6f * side + std::min(h, 0.f) * 0.2f);
        }
    return pixels;
}

void append(Edit& edit, const Edit& more) {
    edit.changes.insert(edit.changes.end(), more.changes.begin(), more.changes.end());
}

} // namespace

glm::dmat4 upright_sky(const glm::dvec3& up) {
    const glm::dvec3 other = std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(up, other));
    return {glm::dvec4(x, 0), glm::dvec4(glm::cross(up, x), 0), glm::dvec4(up, 0), glm::dvec4(0, 0, 0, 1)};
}

Edit studio_sky(const Scene& scene, const glm::dvec3& up) {
    const Id<Image> id = scene.images.next();
    Edit edit = insert(scene,
                       Image{.name = "studio",
                             .encoding = scene::Encoding::linear,
                             .data = std::make_shared<const PixelData>(studio_pixels())},
                       "Neutral studio");
    append(edit, set_environment(scene, Environment{.name = "Studio",
                                                    .image = id,
                                                    .mapping = scene::Mapping::equirect,
                                                    .light_to_world = upright_sky(up)}));
    return edit;
}

Edit image_sky(const Scene& scene, const std::string& path, std::shared_ptr<const PixelData> pixels,
               const glm::dvec3& up) {
    const std::string name = std::filesystem::path(path).stem().string();
    const scene::Mapping mapping =
        pixels->width == pixels->height ? scene::Mapping::octahedral : scene::Mapping::equirect;
    Environment sky{.light_to_world = upright_sky(up)};
    if (const auto& now = scene.environment.value; now && now->image) {
        if (now->mapping == mapping) sky.light_to_world = now->light_to_world;
        sky.scale = now->scale;
    }
    if (scene.environment.value) sky.hidden_from_camera = scene.environment.value->hidden_from_camera;
    sky.name = name;
    sky.mapping = mapping;
    scene.images.each([&](Id<Image> id, const Image& image) {
        if (image.path == path && image.encoding == scene::Encoding::srgb && image.data) sky.image = id;
    });
    Edit edit{"Sky " + name, {}};
    if (!sky.image) {
        sky.image = scene.images.next();
        edit.changes.push_back(Change<Image>{
            sky.image, std::nullopt,
            Image{.name = name, .path = path, .encoding = scene::Encoding::srgb, .data = std::move(pixels)}});
    }
    append(edit, set_environment(scene, sky));
    return edit;
}

Edit made_sky(const Scene& scene, const std::string& name, const std::string& type, ParamSet values,
              std::shared_ptr<const PixelData> pixels, const glm::dvec3& up) {
    const auto& now = scene.environment.value;
    const bool was_made = now && !now->sky.empty();
    Environment sky{.light_to_world = upright_sky(up)};
    if (was_made) sky.scale = now->scale, sky.light_to_world = now->light_to_world;
    if (now) sky.hidden_from_camera = now->hidden_from_camera;
    sky.name = name;
    sky.mapping = scene::Mapping::octahedral;
    sky.sky = type;
    sky.sky_params = std::move(values);
    Image image{.name = name, .encoding = scene::Encoding::linear, .data = std::move(pixels)};
    Edit edit{"Sky " + name, {}};
    const Image* before = was_made ? scene.images.find(now->image) : nullptr;
    if (before && users(scene, now->image).size() == 1) {
        sky.image = now->image;
        edit.changes.push_back(Change<Image>{sky.image, *before, std::move(image)});
    } else {
        sky.image = scene.images.next();
        edit.changes.push_back(Change<Image>{sky.image, std::nullopt, std::move(image)});
    }
    edit.changes.push_back(ChangeOne<std::optional<Environment>>{now, std::move(sky)});
    return edit;
}

} // namespace restage::scene
