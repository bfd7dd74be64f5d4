// SPDX-License-Identifier: Apache-2.0
#include "view/region.hpp"

#include <algorithm>
#include <cstddef>

namespace restage::view {

namespace {

template <class V>
std::vector<V> put(const std::vector<V>& around, glm::uvec2 around_size, glm::uvec2 size, const std::vector<V>& part,
                   glm::uvec2 part_size, glm::uvec2 lower) {
    if (around.empty() && part.empty()) return {}; // no catchers are seen
    std::vector<V> whole(std::size_t{size.x} * size.y);
    if (around.size() == std::size_t{around_size.x} * around_size.y && !around.empty())
        for (std::uint32_t y = 0; y < size.y; ++y) {
            const std::size_t row = std::size_t{y} * around_size.y / size.y * around_size.x;
            for (std::uint32_t x = 0; x < size.x; ++x)
                whole[std::size_t{y} * size.x + x] = around[row + std::size_t{x} * around_size.x / size.x];
        }
    const glm::uvec2 end = glm::min(lower + part_size, size);
    if (part.size() == std::size_t{part_size.x} * part_size.y && lower.x < end.x)
        for (std::uint32_t y = lower.y; y < end.y; ++y)
            std::copy_n(part.begin() + std::ptrdiff_t(std::size_t{y - lower.y} * part_size.x), end.x - lower.x,
                        whole.begin() + std::ptrdiff_t(std::size_t{y} * size.x + lower.x));
    return whole;
}

} // namespace

render::FilmImage with_part(const render::FilmImage& around, glm::uvec2 size, const render::FilmImage& part,
                            glm::uvec2 lower) {
    render::FilmImage whole;
    whole.width = size.x;
    whole.height = size.y;
    whole.samples = part.samples;
    render::each_film_layer([&](const auto& layer) {
        whole.*layer.values = put(around.*layer.values, {around.width, around.height}, size, part.*layer.values,
                                  {part.width, part.height}, lower);
    });
    if (!around.alpha.empty() || !part.alpha.empty())
        whole.alpha = put(around.opacity(), {around.width, around.height}, size, part.opacity(),
                          {part.width, part.height}, lower);
    return whole;
}

std::vector<std::uint32_t> with_part(const std::vector<std::uint32_t>& around, glm::uvec2 around_size, glm::uvec2 size,
                                     const std::vector<std::uint32_t>& part, glm::uvec2 part_size, glm::uvec2 lower) {
    return put(around, around_size, size, part, part_size, lower);
}

} // namespace restage::view
