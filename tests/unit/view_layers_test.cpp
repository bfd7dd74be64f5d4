// SPDX-License-Identifier: Apache-2.0
// Layers that a view can show: their names, looks and scales.
#include "view/display.hpp"

#include <catch2/catch_test_macros.hpp>
#include <cmath>

using namespace restage;
using namespace restage::view;

TEST_CASE("layers: three of them are first hits, and an unknown one is the picture") {
    CHECK(look_of(clay_layer) == render::ClayLook::clay);
    CHECK(look_of(wire_layer) == render::ClayLook::wires);
    CHECK(look_of(uv_layer) == render::ClayLook::uv);
    CHECK_FALSE(look_of(picture_layer));
    CHECK_FALSE(look_of(error_layer));
    CHECK(layer_choice("no such layer").name == picture_layer);
    for (const LayerChoice& choice : layer_choices()) {
        CHECK(layer_choice(choice.name).label == choice.label);
        CHECK(std::string_view(choice.about).size() > 10);
    }
}

TEST_CASE("layers: scales tell what their colours stand for") {
    auto image = render::FilmImage::blank(3, 1);
    image.samples = 8;
    image.depth = {0, 2, 19};
    std::vector<std::uint32_t> rgba;
    Scale scale = to_display(image, {.layer = "depth"}, rgba);
    CHECK(scale.bright == 0);
    CHECK(std::abs(scale.dark - 20) < 1e-4f);
    CHECK(rgba[1] == scale_color(1 - 2.f / 20));
    const std::uint32_t counts[] = {0, 4, 16};
    scale = to_display(image, {.layer = samples_layer}, rgba, counts);
    CHECK(scale.dark == 0);
    CHECK(scale.bright == 16);
    CHECK(rgba == std::vector<std::uint32_t>{scale_color(0), scale_color(0.25f), scale_color(1)});
    scale = to_display(image, {.layer = samples_layer}, rgba); // all as many
    CHECK(scale.bright == 8);
    CHECK(rgba[0] == scale_color(1));
    scale = to_display(image, {.layer = error_layer}, rgba);
    CHECK(scale.logarithmic);
    CHECK(rgba[0] == scale_color(0)); // 0.1 % and less
    scale = to_display(image, {}, rgba);
    CHECK(scale.dark == scale.bright);
}
