// SPDX-License-Identifier: Apache-2.0
// EXR: layers and metadata survive a round trip; the files of other programs (tiles, parts, luminance) are read.
#include "base/file.hpp"
#include "image_test_files.hpp"
#include "io/exr.hpp"
#include "io/image_file.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfTiledOutputFile.h>
#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using Catch::Approx;
using test::TemporaryFolder;

namespace {

constexpr unsigned width = 37, height = 21;

std::vector<float> ramp(std::size_t channels, float scale) {
    std::vector<float> values(channels * width * height);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = scale * float(i) - 3;
    return values;
}

io::ExrImage render() {
    io::ExrImage image{.width = width, .height = height};
    std::vector<std::uint32_t> ids(2 * width * height);
    for (std::uint32_t i = 0; i < ids.size(); ++i)
        ids[i] = i % 2 ? 0xfffffff0u + i % 7 : i;
    // In a reader's order: alphabetical by full channel name.
    image.layers = {{.name = "", .channels = {"R", "G", "B"}, .values = ramp(3, 1e-7f)},
                    {.name = "albedo", .channels = {"R", "G", "B"}, .type = io::ExrType::half, .values = ramp(3, 0)},
                    {.name = "depth", .channels = {"Z"}, .values = ramp(1, 1e9f)},
                    {.name = "id", .channels = {"instance", "material"}, .type = io::ExrType::uint32, .integers = ids},
                    {.name = "normal", .channels = {"X", "Y", "Z"}, .values = ramp(3, 0.1f)},
                    {.name = "stderr", .channels = {"R", "G", "B", "Y"}, .values = ramp(4, 0.3f)}};
    image.metadata = {{"restage.samples", "256"}, {"comments", "two\nlines, ümlaut"}};
    return image;
}

} // namespace

TEST_CASE("exr: layers, types and metadata survive a round trip exactly") {
    const auto compression = GENERATE(io::ExrCompression::none, io::ExrCompression::zip, io::ExrCompression::piz);
    const TemporaryFolder folder;
    const auto image = render();
    REQUIRE(io::write_exr(folder / "a.exr", image, compression));
    const auto back = io::read_exr(folder / "a.exr");
    REQUIRE(back);
    CHECK(back->metadata == image.metadata);
    REQUIRE(back->layers.size() == image.layers.size());
    for (std::size_t i = 0; i < image.layers.size(); ++i) {
        CAPTURE(image.layers[i].name);
        CHECK(back->layers[i] == image.layers[i]);
    }
    CHECK(*back == image);
    CHECK(back->find("depth"));
    CHECK_FALSE(back->find("nothing"));
}

TEST_CASE("exr: a half layer rounds to half and never becomes infinite") {
    const TemporaryFolder folder;
    io::ExrImage image{.width = 3, .height = 1};
    image.layers = {{.channels = {"Y"}, .type = io::ExrType::half, .values = {1e9f, 0.1f, -1e9f}}};
    REQUIRE(io::write_exr(folder / "a.exr", image));
    const auto back = io::read_exr(folder / "a.exr");
    REQUIRE(back);
    CHECK(back->layers[0].values[0] == 65504);
    CHECK(back->layers[0].values[1] == Approx(0.1f).epsilon(1e-3));
    CHECK(back->layers[0].values[2] == -65504);
}

TEST_CASE("exr: as a texture, the plain colour layer is used") {
    const TemporaryFolder folder;
    REQUIRE(io::write_exr(folder / "a.exr", render()));
    const auto image = io::read_image(folder / "a.exr", scene::Encoding::srgb); // float: the encoding does not matter
    REQUIRE(image);
    CHECK(image->channels == 3);
    CHECK(image->values == render().layers[0].values);

    auto only_guides = render();
    only_guides.layers.erase(only_guides.layers.begin());
    REQUIRE(io::write_exr(folder / "b.exr", only_guides));
    const auto albedo = io::read_image(folder / "b.exr", scene::Encoding::linear);
    REQUIRE(albedo);
    CHECK(albedo->values == render().layers[1].values); // the first that has colour

    io::ExrImage vectors{
        .width = 1, .height = 1, .layers = {{.name = "motion", .channels = {"X", "Z"}, .values = {1, 2}}}};
    REQUIRE(io::write_exr(folder / "c.exr", vectors));
    const auto none = io::read_image(folder / "c.exr", scene::Encoding::linear);
    REQUIRE_FALSE(none);
    CHECK(none.error().message.find("motion.X, motion.Z") != std::string::npos);
}

TEST_CASE("exr: grey, grey with alpha, and RGBA") {
    const TemporaryFolder folder;
    const auto read = [&](std::vector<std::string> channels, std::vector<float> values) {
        io::ExrImage image{
            .width = 1, .height = 1, .layers = {{.channels = std::move(channels), .values = std::move(values)}}};
        REQUIRE(io::write_exr(folder / "a.exr", image));
        auto back = io::read_image(folder / "a.exr", scene::Encoding::linear);
        REQUIRE(back);
        return back->values;
    };
    CHECK(read({"Y"}, {5}) == std::vector<float>{5});
    CHECK(read({"Y", "A"}, {5, 0.5f}) == std::vector<float>{5, 5, 5, 0.5f});
    CHECK(read({"R", "G", "B", "A"}, {1, 2, 3, 4}) == std::vector<float>{1, 2, 3, 4});
    CHECK(read({"R"}, {7}) == std::vector<float>{7});
    CHECK(read({"R", "G"}, {7, 8}) == std::vector<float>{7, 8, 0});
    CHECK(read({"height"}, {9}) == std::vector<float>{9});
}

TEST_CASE("exr: tiles, a data window off the origin, several parts") {
    const TemporaryFolder folder;
    const std::string path = folder / "a.exr";
    std::vector<float> y(8 * 4);
    for (std::size_t i = 0; i < y.size(); ++i)
        y[i] = float(i);
    const Imath::Box2i window({-3, 5}, {4, 8});
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, y.data(), window, 4, 4 * 8));
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));

    SECTION("tiles with mip maps") {
        header.setTileDescription(Imf::TileDescription(3, 3, Imf::MIPMAP_LEVELS));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1, 0);
    }
    SECTION("scan lines") {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(4);
    }
    SECTION("the first of two parts") {
        std::vector<Imf::Header> headers(2, header);
        headers[0].setName("left");
        headers[1].setName("right");
        headers[0].setType(Imf::SCANLINEIMAGE);
        headers[1].setType(Imf::SCANLINEIMAGE);
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
        for (int i = 0; i < 2; ++i) {
            Imf::OutputPart part(file, i);
            part.setFrameBuffer(buffer);
            part.writePixels(4);
            for (float& v : y)
                v = -1; // the second part is something else
        }
        for (std::size_t i = 0; i < y.size(); ++i)
            y[i] = float(i);
    }
    const auto image = io::read_image(path, scene::Encoding::linear);
    REQUIRE(image);
    CHECK(image->width == 8);
    CHECK(image->height == 4);
    CHECK(image->values == y);
}

TEST_CASE("exr: luminance with subsampled chroma becomes RGB") {
    const TemporaryFolder folder;
    const std::string path = folder / "a.exr";
    const std::vector<Imf::Rgba> pixels(32 * 16, Imf::Rgba(0.8f, 0.4f, 0.2f));
    {
        Imf::RgbaOutputFile file(path.c_str(), 32, 16, Imf::WRITE_YC);
        file.setFrameBuffer(pixels.data(), 1, 32);
        file.writePixels(16);
    }
    const auto image = io::read_image(path, scene::Encoding::linear);
    REQUIRE(image);
    REQUIRE(image->channels == 3);
    for (std::size_t i = 0; i < 32 * 16; ++i) {
        CHECK(image->values[3 * i] == Approx(0.8f).epsilon(0.01));
        CHECK(image->values[3 * i + 1] == Approx(0.4f).epsilon(0.01));
        CHECK(image->values[3 * i + 2] == Approx(0.2f).epsilon(0.02));
    }
    CHECK_FALSE(io::read_exr(path)); // as layers it is refused
}

TEST_CASE("exr: unwritable images are refused, and the old file is kept") {
    const TemporaryFolder folder;
    const auto good = render();
    REQUIRE(io::write_exr(folder / "a.exr", good));
    auto bad = good;
    bad.layers[2].values.pop_back();
    const auto refused = io::write_exr(folder / "a.exr", bad);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message.find("a.exr: layer 'depth'") != std::string::npos);
    bad = good;
    bad.layers.push_back(bad.layers[0]);
    CHECK_FALSE(io::write_exr(folder / "a.exr", bad));
    const auto still = io::read_exr(folder / "a.exr");
    REQUIRE(still);
    CHECK(*still == good);
}
