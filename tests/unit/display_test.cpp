// SPDX-License-Identifier: Apache-2.0
// Outlines of the selection, from the picture's instance ids.
#include "view/display.hpp"

#include <catch2/catch_test_macros.hpp>

using namespace restage;

namespace {

constexpr std::uint32_t hover = 0xff112233, chosen = 0xff445566;

render::FilmImage ids(std::uint32_t width, std::vector<std::uint32_t> values) {
    render::FilmImage image;
    image.width = width;
    image.height = std::uint32_t(values.size()) / width;
    image.instance_id = std::move(values);
    return image;
}

} // namespace

TEST_CASE("outlines: a ring around marked objects, selected before hovered") {
    const auto image = ids(6, {0, 0, 0, 0, 0, 0, //
                               0, 1, 1, 2, 7, 0, //
                               0, 0, 0, 0, 0, 0});
    const std::uint8_t marks[] = {0, 2, 1, 0}; // 1 selected, 2 hovered; 7 is beyond the end
    std::vector<std::uint32_t> rgba;
    REQUIRE(view::to_outlines(image, marks, 1, {hover, chosen}, rgba));
    const std::uint32_t C = chosen, H = hover;
    CHECK(rgba == std::vector<std::uint32_t>{0, C, C, H, 0, 0, //
                                             C, 0, 0, C, H, 0, //
                                             0, C, C, H, 0, 0});
}

TEST_CASE("outlines: thicker ones, up to the picture's edge") {
    std::vector<std::uint32_t> rgba;
    const std::uint8_t marks[] = {0, 2};
    REQUIRE(view::to_outlines(ids(5, {1, 0, 0, 0, 0}), marks, 2, {hover, chosen}, rgba));
    CHECK(rgba == std::vector<std::uint32_t>{0, chosen, chosen, 0, 0});
}

TEST_CASE("outlines: none if nothing marked is visible") {
    std::vector<std::uint32_t> rgba{1, 2, 3};
    const std::uint8_t marks[] = {0, 2};
    CHECK_FALSE(view::to_outlines(ids(2, {0, 3, 3, 0}), marks, 2, {hover, chosen}, rgba));
    CHECK(rgba.empty());
}
