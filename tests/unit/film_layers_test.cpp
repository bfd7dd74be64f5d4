// SPDX-License-Identifier: Apache-2.0
// Every layer of a film is shown, written, read and merged, without being named elsewhere.
#include "render/film_layers.hpp"
#include "render/tracers.hpp"
#include "temporary_folder.hpp"
#include "view/display.hpp"
#include "view/merge_pictures.hpp"
#include "view/picture.hpp"

#include <catch2/catch_test_macros.hpp>

#include <cmath>
#include <set>
#include <string>

using namespace restage;
using render::FilmImage;

namespace {

// Different values in each layer and pixel; errors that are possible with two samples.
FilmImage numbered(float first) {
    FilmImage image = FilmImage::blank(3, 2);
    image.samples = 2;
    float next = first;
    render::each_film_layer([&]<class V>(const render::FilmLayer<V>& layer) {
        (image.*layer.values).resize(image.pixels()); // those of catchers, too
        for (V& value : image.*layer.values)
            value = V(next += 0.25f);
    });
    return image;
}

} // namespace

TEST_CASE("layers of a film survive a file") {
    const test::TemporaryFolder folder;
    const std::string path = (folder.path() / "all.exr").string();
    const FilmImage image = numbered(1);
    REQUIRE(view::write_picture(path, {.film = image, .denoised = {}}, {.metadata = {{"restage:ranges", "0:0+2"}}}));
    const auto read = view::read_picture(path);
    REQUIRE(read);
    const auto names = view::aov_names();
    CHECK(read->layers == std::set<std::string>(names.begin(), names.end()));
    render::each_film_layer([&]<class V>(const render::FilmLayer<V>& layer) {
        INFO(layer.in_file << " " << layer.channels[0]);
        const std::vector<V>&wrote = image.*layer.values, &has = read->film.*layer.values;
        REQUIRE(has.size() == wrote.size());
        for (std::size_t i = 0; i < has.size(); ++i)
            if constexpr (std::is_same_v<V, float>)
                CHECK(std::abs(has[i] - wrote[i]) < 1e-5f); // a variance was its root in the file
            else
                CHECK(has[i] == wrote[i]);
    });
}

TEST_CASE("layers of a film are merged: means by samples, ids of the first") {
    const FilmImage a = numbered(1), b = numbered(3);
    const view::PicturePart parts[] = {{.film = &a, .first_sample = 0}, {.film = &b, .first_sample = 2}};
    const auto merged = view::merge_films(parts);
    REQUIRE(merged);
    render::each_film_layer([&]<class V>(const render::FilmLayer<V>& layer) {
        INFO(layer.in_file << " " << layer.channels[0]);
        [[maybe_unused]] const V has = ((*merged).*layer.values)[4], x = (a.*layer.values)[4], y = (b.*layer.values)[4];
        if (layer.source == render::LayerSource::first) CHECK(has == x);
        if constexpr (!std::is_same_v<V, std::uint32_t>)
            if (layer.source == render::LayerSource::mean) CHECK(has == (x + y) / 2.f);
    });
}

TEST_CASE("layers of a film are shown, and so is the error") {
    const FilmImage image = numbered(0);
    std::set<std::string> labels;
    for (const view::LayerChoice& choice : view::layer_choices()) {
        INFO(choice.name);
        CHECK(labels.insert(choice.label).second);
        std::vector<std::uint32_t> rgba;
        view::to_display(image, {.layer = choice.name}, rgba);
        REQUIRE(rgba.size() == 6);
        for (const std::uint32_t pixel : rgba)
            CHECK(pixel >> 24 == 255);
    }
    CHECK(labels.contains("Picture"));
    CHECK(labels.contains("Error"));
    CHECK(labels.contains("Exposure"));
}

TEST_CASE("tracers are found by their names; by default the device chooses") {
    for (const render::TracerKind& kind : render::tracer_kinds())
        CHECK(render::find_tracer(kind.name) == &kind);
    CHECK_FALSE(render::find_tracer("abacus"));
    gpu::DeviceInfo device;
    device.type = gpu::DeviceType::cpu;
    device.ray_tracing = true;
    CHECK(render::best_tracer(device).name == "embree");
    device.type = gpu::DeviceType::discrete;
    CHECK(render::best_tracer(device).name == "vulkan");
    device.ray_tracing = false;
    CHECK(render::best_tracer(device).name == "embree");
}
