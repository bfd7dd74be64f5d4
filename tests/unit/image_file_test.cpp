// SPDX-License-Identifier: Apache-2.0
// Image files: each format returns the stored numbers, and an inconsistent or truncated file gives an error.
#include "io/image_file.hpp"
#include "io/image_file_codecs.hpp"

#include "base/file.hpp"
#include "image_test_files.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <fstream>
#include <limits>

using namespace restage;
using Catch::Approx;
using test::data_image;
using test::TemporaryFolder;

namespace {

std::array<float, 3> texel(const scene::PixelData& image, unsigned x, unsigned y) {
    const float* p = &image.values[(std::size_t{y} * image.width + x) * image.channels];
    return image.channels < 3 ? std::array<float, 3>{p[0], p[0], p[0]} : std::array<float, 3>{p[0], p[1], p[2]};
}

// |a - b| in units of 1/255.
float distance(std::array<float, 3> a, std::array<float, 3> b) {
    float most = 0;
    for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(a[c] * 255 - b[c]));
    return most;
}

} // namespace

TEST_CASE("image_file: the sRGB curve is the piecewise one") {
    CHECK(io::srgb_to_linear(0) == 0);
    CHECK(io::srgb_to_linear(1) == Approx(1));
    CHECK(io::srgb_to_linear(0.04045f) == Approx(0.0031308f).epsilon(1e-4)); // the joint
    CHECK(io::srgb_to_linear(0.5f) == Approx(0.21404114f).epsilon(1e-6));    // ((0.5 + 0.055) / 1.055)^2.4
    for (int i = 0; i <= 255; ++i)
        CHECK(io::linear_to_srgb(io::srgb_to_linear(float(i) / 255)) * 255 == Approx(i).margin(1e-3));
    CHECK(io::linear_to_srgb(-1) == 0);
    CHECK(io::linear_to_srgb(7) == 1);
    CHECK(io::linear_to_srgb(std::nanf("")) == 0);
}

TEST_CASE("image_file: every lossless 8-bit format keeps its texels, row 0 on top") {
    const std::string name =
        GENERATE("rgb8.png", "rgba8.png", "palette.png", "rgb16.png", "rgb24.bmp", "rgb24.tga", "rgb24_rle.tga",
                 "rgba32_rle.tga", "rgb16.tga", "interlaced.png", "gamma.png", "rgb8.webp", "rgba8.webp");
    CAPTURE(name);
    const auto image = io::read_image(data_image(name), scene::Encoding::linear);
    REQUIRE(image);
    CHECK(image->width == 16);
    CHECK(image->height == 8);
    const float tolerance = name == "rgb16.tga" ? 8.f : 1e-3f; // 5 bits a channel
    CHECK(distance(texel(*image, 0, 0), {255, 255, 255}) <= tolerance);
    CHECK(distance(texel(*image, 1, 0), {200, 100, 50}) <= tolerance);
    CHECK(distance(texel(*image, 0, 7), {200, 100, 50}) <= tolerance);
    CHECK(distance(texel(*image, 8, 0), {20, 60, 220}) <= tolerance);
    CHECK(distance(texel(*image, 15, 7), {20, 60, 220}) <= tolerance);
    if (name.starts_with("rgba")) {
        REQUIRE(image->channels == 4);
        CHECK(image->values[3] == Approx(128 / 255.f));
    } else {
        CHECK(image->channels == 3);
    }
}

TEST_CASE("image_file: JPG up to its loss") {
    for (const char* name : {"baseline.jpg", "progressive.jpg"}) {
        CAPTURE(name);
        const auto image = io::read_image(data_image(name), scene::Encoding::linear);
        REQUIRE(image);
        CHECK(image->channels == 3);
        CHECK(distance(texel(*image, 3, 3), {200, 100, 50}) <= 3);
    }
    const auto grey = io::read_image(data_image("grey.jpg"), scene::Encoding::linear);
    REQUIRE(grey);
    CHECK(grey->channels == 1);
    const float luma = 0.299f * 200 + 0.587f * 100 + 0.114f * 50;
    CHECK(distance(texel(*grey, 3, 3), {luma, luma, luma}) <= 2);
}

TEST_CASE("image_file: all bits of a value are kept, and low bit depths are scaled to the range") {
    const auto wide = io::read_image(data_image("grey16.png"), scene::Encoding::linear);
    REQUIRE(wide);
    REQUIRE(wide->channels == 1);
    for (int i = 0; i < 128; ++i)
        CHECK(wide->values[i] * 65535 == Approx(256 * i + 77).margin(0.01));

    const auto few = io::read_image(data_image("grey2.png"), scene::Encoding::linear); // tRNS: level 2 is clear
    REQUIRE(few);
    REQUIRE(few->channels == 4);
    for (int i = 0; i < 4; ++i) {
        CHECK(few->values[4 * i] == Approx(i / 3.0));
        CHECK(few->values[4 * i + 3] == (i == 2 ? 0 : 1));
    }

    const auto palette =
        io::read_image(data_image("palette1.png"), scene::Encoding::linear); // tRNS: the first colour's alpha
    REQUIRE(palette);
    REQUIRE(palette->channels == 4);
    CHECK(distance(texel(*palette, 0, 0), {200, 100, 50}) < 1e-3);
    CHECK(palette->values[3] == Approx(64 / 255.0));
    CHECK(distance(texel(*palette, 0, 1), {20, 60, 220}) < 1e-3);
    CHECK(palette->values[16 * 4 + 3] == 1);
}

TEST_CASE("image_file: CMYK inks become transmitted light, Adobe's inverted ones as well") {
    const auto adobe = io::read_image(data_image("cmyk.jpg"), scene::Encoding::linear);
    REQUIRE(adobe);
    REQUIRE(adobe->channels == 3);
    CHECK(distance(texel(*adobe, 3, 3), {200, 100, 50}) <= 6);
    const auto plain = io::read_image(data_image("cmyk_plain.jpg"), scene::Encoding::linear); // K is 255
    REQUIRE(plain);
    CHECK(distance(texel(*plain, 3, 3), {0, 0, 0}) <= 3);
}

TEST_CASE("image_file: a large picture of one colour takes few bytes, and is complete") {
    const auto solid = io::read_image(data_image("solid1.png"), scene::Encoding::linear);
    REQUIRE(solid);
    CHECK(solid->width == 2048);
    CHECK(solid->height == 2048);
    CHECK(distance(texel(*solid, 2047, 2047), {200, 100, 50}) < 1e-3);
}

TEST_CASE("image_file: damage that leaves a usable picture is a warning") {
    const TemporaryFolder folder;
    auto bytes = read_file(data_image("baseline.jpg"));
    REQUIRE(bytes);
    bytes->insert(bytes->size() - 2,
                  std::string(64, '\x12')); // between the last scan and the end, more than libjpeg looks ahead
    REQUIRE(write_file_atomic(folder / "a.jpg", *bytes));
    std::string warning;
    REQUIRE(io::read_image(folder / "a.jpg", scene::Encoding::linear, 2.2f, &warning));
    CHECK(warning.find("a.jpg: JPEG: ") != std::string::npos);
}

TEST_CASE("image_file: encoding applies to colour, never to alpha") {
    const auto srgb = io::read_image(data_image("rgba8.png"), scene::Encoding::srgb);
    REQUIRE(srgb);
    CHECK(srgb->values[4] == Approx(io::srgb_to_linear(200 / 255.f)));
    CHECK(srgb->values[7] == Approx(128 / 255.f));
    const auto gamma = io::read_image(data_image("rgb16.png"), scene::Encoding::gamma, 1.8f);
    REQUIRE(gamma);
    CHECK(gamma->values[3] == Approx(std::pow(200 / 255., 1.8)));
    const auto grey = io::read_image(data_image("grey_alpha8.png"), scene::Encoding::srgb);
    REQUIRE(grey);
    REQUIRE(grey->channels == 4); // 2 channels become 4
    for (int c = 0; c < 3; ++c)
        CHECK(grey->values[c] == Approx(io::srgb_to_linear(100 / 255.f)));
    CHECK(grey->values[3] == Approx(128 / 255.f));
}

TEST_CASE("image_file: only the header") {
    const auto header = io::read_image_header(data_image("grey_alpha8.png"));
    REQUIRE(header);
    CHECK(header->width == 16);
    CHECK(header->height == 8);
    CHECK(header->channels == 4);
    CHECK(header->values.empty());
}

TEST_CASE("image_file: PNG keeps all 256 levels, and exposure is a power of two") {
    const TemporaryFolder folder;
    scene::PixelData ramp{.width = 256, .height = 1, .channels = 1};
    for (int i = 0; i < 256; ++i)
        ramp.values.push_back(io::srgb_to_linear(float(i) / 255));
    REQUIRE(io::write_png(folder / "ramp.png", ramp));
    const auto back = io::read_image(folder / "ramp.png", scene::Encoding::linear);
    REQUIRE(back);
    for (int i = 0; i < 256; ++i)
        CHECK(back->values[i] * 255 == Approx(i));

    const scene::PixelData pixel{.width = 1, .height = 1, .channels = 4, .values = {0.125f, 0.25f, 9, 0.5f}};
    REQUIRE(io::write_png(folder / "exposed.png", pixel, 2));
    const auto exposed = io::read_image(folder / "exposed.png", scene::Encoding::srgb);
    REQUIRE(exposed);
    CHECK(exposed->values[0] == Approx(0.5f).epsilon(0.01));
    CHECK(exposed->values[1] == 1);
    CHECK(exposed->values[2] == 1);
    CHECK(exposed->values[3] == Approx(0.5f).margin(0.003)); // alpha is not exposed
}

TEST_CASE("image_file: a written JPG is the same up to its loss, without chroma subsampling") {
    const TemporaryFolder folder;
    scene::PixelData image{.width = 33, .height = 17, .channels = 4}; // red and green columns, half transparent
    for (std::size_t i = 0; i < 33 * 17; ++i)
        image.values.insert(image.values.end(), {i % 33 % 2 ? 0.5f : 0.05f, i % 33 % 2 ? 0.05f : 0.5f, 0.2f, 0.5f});
    REQUIRE(io::write_jpg(folder / "a.jpg", image));
    const auto back = io::read_image(folder / "a.jpg", scene::Encoding::srgb);
    REQUIRE(back);
    REQUIRE(back->channels == 3);
    for (std::size_t i = 0; i < 33 * 17; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(back->values[3 * i + c] == Approx(image.values[4 * i + c]).margin(0.06));
    const scene::PixelData wide{.width = 65536, .height = 1, .channels = 1, .values = std::vector<float>(65536, 0.5f)};
    const auto refused = io::write_jpg(folder / "wide.jpg", wide);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message.find("65500") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder / "wide.jpg"));
}

TEST_CASE("image_file: PFM, both byte orders, both channel counts, bottom row first") {
    const TemporaryFolder folder;
    const scene::PixelData image{
        .width = 2, .height = 2, .channels = 3, .values = {1, 2, 3, 4, 5, 6, -7, 8e10f, 9, 10, 11, 0.1f}};
    REQUIRE(io::write_pfm(folder / "a.pfm", image));
    const auto bytes = read_file(folder / "a.pfm");
    REQUIRE(bytes);
    REQUIRE(bytes->starts_with("PF\n2 2\n-1.0\n"));
    float first = 0;
    std::memcpy(&first, bytes->data() + 12, 4);
    CHECK(first == -7);                                               // the bottom row comes first
    const auto back = io::read_image(folder / "a.pfm", scene::Encoding::srgb); // float: the encoding does not matter
    REQUIRE(back);
    CHECK(back->values == image.values);

    const std::string big_endian("Pf\n1 2\n1.0\n\x3f\x80\0\0\x40\0\0\0", 19); // 1 below, 2 on top
    REQUIRE(write_file_atomic(folder / "b.pfm", big_endian));
    const auto grey = io::read_image(folder / "b.pfm", scene::Encoding::linear);
    REQUIRE(grey);
    CHECK(grey->channels == 1);
    CHECK(grey->values == std::vector<float>{2, 1});
}

TEST_CASE("image_file: HDR keeps 1 % over 12 orders of magnitude") {
    const TemporaryFolder folder;
    scene::PixelData image{.width = 32, .height = 2, .channels = 3};
    for (int i = 0; i < 64; ++i)
        for (int c = 0; c < 3; ++c)
            image.values.push_back(std::pow(10.f, float(i % 13) - 6) * (1 + 0.2f * float(c)));
    REQUIRE(io::write_hdr(folder / "a.hdr", image));
    const auto back = io::read_image(folder / "a.hdr", scene::Encoding::srgb);
    REQUIRE(back);
    REQUIRE(back->channels == 3);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        CHECK(back->values[i] == Approx(image.values[i]).epsilon(0.01));
}

TEST_CASE("image_file: HDR with plain texels, old run-length coding and other row orders") {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& resolution, const std::string& texels) {
        REQUIRE(write_file_atomic(folder / "a.hdr",
                                  "#?RGBE\n# note\nFORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n" + texels));
        return io::read_image(folder / "a.hdr", scene::Encoding::linear);
    };
    const std::string one("\x80\x40\x20\x81", 4), zero(4, '\0'), repeat("\1\1\1\2", 4); // one = (1, 0.5, 0.25)
    auto image = read("-Y 1 +X 3", one + repeat);
    REQUIRE(image);
    CHECK(image->values == std::vector<float>{1, 0.5f, 0.25f, 1, 0.5f, 0.25f, 1, 0.5f, 0.25f});
    image = read("+Y 2 +X 1", one + zero);
    REQUIRE(image);
    CHECK(image->values == std::vector<float>{0, 0, 0, 1, 0.5f, 0.25f});
    image = read("-Y 1 -X 2", one + zero);
    REQUIRE(image);
    CHECK(image->values == std::vector<float>{0, 0, 0, 1, 0.5f, 0.25f});
    CHECK_FALSE(read("+X 2 -Y 1", one + zero));         // rows are columns: not supported
    CHECK_FALSE(read("-Y 1 +X 3", repeat));             // repeats nothing
    CHECK_FALSE(read("-Y 1 +X 2", one + repeat));       // one too many
    const std::string corrupt_run("\2\2\0\x08\x89", 5); // a run of 9 in a row of 8
    CHECK_FALSE(read("-Y 1 +X 8", corrupt_run + one + one));
}

TEST_CASE("image_file: NaN and infinity are replaced and counted") {
    const TemporaryFolder folder;
    constexpr float inf = std::numeric_limits<float>::infinity();
    const scene::PixelData image{.width = 5, .height = 1, .channels = 1, .values = {1, std::nanf(""), inf, -inf, 2}};
    REQUIRE(io::write_pfm(folder / "a.pfm", image));
    std::string warning;
    const auto back = io::read_image(folder / "a.pfm", scene::Encoding::linear, 1, &warning);
    REQUIRE(back);
    CHECK(back->values == std::vector<float>{1, 0, 65504, -65504, 2});
    const std::string file = std::string(folder / "a.pfm") + ": ";
    CHECK(warning == file + "1 values are NaN and became 0, 2 values are infinite and became 65504");
    REQUIRE(io::write_pfm(folder / "a.pfm", {.width = 2, .height = 1, .channels = 1, .values = {std::nanf(""), 2}}));
    REQUIRE(io::read_image(folder / "a.pfm", scene::Encoding::linear, 1, &warning));
    CHECK(warning == file + "1 values are NaN and became 0");
    REQUIRE(io::write_pfm(folder / "a.pfm", {.width = 2, .height = 1, .channels = 1, .values = {inf, 2}}));
    REQUIRE(io::read_image(folder / "a.pfm", scene::Encoding::linear, 1, &warning));
    CHECK(warning == file + "1 values are infinite and became 65504");
    REQUIRE(io::read_image(data_image("rgb8.png"), scene::Encoding::linear, 1, &warning));
    CHECK(warning.empty());
}

TEST_CASE("image_file: a truncated file is an error that names it") {
    const TemporaryFolder folder;
    const scene::PixelData image{
        .width = 16, .height = 8, .channels = 3, .values = std::vector<float>(16 * 8 * 3, 0.5f)};
    REQUIRE(io::write_hdr(folder / "whole.hdr", image));
    REQUIRE(io::write_pfm(folder / "whole.pfm", image));
    REQUIRE(io::write_image(folder / "whole.exr", image));
    const std::string name =
        GENERATE("rgb8.png", "palette.png", "rgb16.png", "baseline.jpg", "progressive.jpg", "grey.jpg", "rgb24.bmp",
                 "rgb24.tga", "rgb24_rle.tga", "rgb16.tga", "grey8.tga", "interlaced.png", "grey16.png", "rgb8.webp",
                 "cmyk.jpg", "whole.hdr", "whole.pfm", "whole.exr");
    const std::string path = name.starts_with("whole") ? (folder / name).string() : data_image(name);
    CAPTURE(path);
    const auto whole = read_file(path);
    REQUIRE(whole);
    REQUIRE(io::read_image(path, scene::Encoding::linear));
    const std::string cut = folder / "cut";
    for (std::size_t size = 0; size < whole->size(); ++size) {
        // TGA files of Pillow end in a 26-byte footer, PNG in a checksum: truncating these loses nothing of the
        // picture.
        if (path.ends_with(".tga") && size >= whole->size() - 26) break;
        if (path.ends_with(".png") && size >= whole->size() - 4) break;
        std::ofstream(cut, std::ios::binary).write(whole->data(), static_cast<std::streamsize>(size));
        const auto read = io::read_image(cut, scene::Encoding::linear);
        CAPTURE(size, whole->size());
        REQUIRE_FALSE(read);
        REQUIRE(read.error().message.find("cut: ") != std::string::npos);
    }
}

TEST_CASE("image_file: implausible sizes are refused before memory is allocated") {
    const TemporaryFolder folder;
    const auto refused = [&](std::string_view bytes) {
        REQUIRE(write_file_atomic(folder / "lie", bytes));
        const auto read = io::read_image(folder / "lie", scene::Encoding::linear);
        REQUIRE_FALSE(read);
        return read.error().message;
    };
    CHECK(refused("Pf\n2000000000 2000000000\n-1\n").find("2000000000 x 2000000000") != std::string::npos);
    CHECK(refused("Pf\n-3 4\n-1\n").find("width expected") != std::string::npos);
    CHECK(refused("Pf\n0 4\n-1\n").find("no pixels") != std::string::npos);
    CHECK(refused("Pf\n4 4\n0\nxxxx").find("scale") != std::string::npos);
    CHECK(refused("Pf\n30000 30000\n-1\n").find("more than this program holds") != std::string::npos);
    CHECK(refused("Pf\n10000 10000\n-1\n").find("but the file has only") != std::string::npos);
    auto bmp = read_file(data_image("rgb24.bmp"));
    REQUIRE(bmp);
    bmp->replace(18, 8, std::string("\xff\xff\xff\x7f\xff\xff\xff\x7f", 8)); // width, height
    refused(*bmp);
    auto tga = read_file(data_image("rgb24_rle.tga"));
    REQUIRE(tga);
    tga->replace(12, 4, "\xff\xff\xff\xff");
    refused(*tga);
    CHECK(refused("just text, no picture at all").find("not a picture") != std::string::npos);
    CHECK(refused("").find("empty") != std::string::npos);
    CHECK_FALSE(io::read_image(folder / "absent.png", scene::Encoding::linear));
}

TEST_CASE("image_file: write_image selects the format by the extension") {
    const TemporaryFolder folder;
    const scene::PixelData image{.width = 2, .height = 1, .channels = 3, .values = {0, 0.25f, 1, 0.5f, 0.5f, 0.5f}};
    for (const char* name : {"a.PNG", "a.pfm", "a.hdr", "a.exr"}) {
        REQUIRE(io::write_image(folder / name, image));
        const auto back = io::read_image(folder / name, scene::Encoding::srgb);
        REQUIRE(back);
        for (std::size_t i = 0; i < 6; ++i)
            CHECK(back->values[i] == Approx(image.values[i]).margin(0.01));
    }
    const auto refused = io::write_image(folder / "a.webp", image);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message.find(".webp") != std::string::npos);
    CHECK_FALSE(io::write_image(folder / "no/such/folder/a.png", image));
}

TEST_CASE("image_file: a JPG of a few bytes that claims to be huge is refused before it is unpacked") {
    auto jpeg = io::encode_jpeg(16, 16, 1, 90, std::vector<std::uint8_t>(256, 128));
    REQUIRE(jpeg);
    REQUIRE(io::decode_jpeg(*jpeg, false));
    const std::size_t frame = jpeg->find("\xff\xc0");
    REQUIRE(frame != std::string::npos);
    for (const std::size_t at : {frame + 5, frame + 7}) // height and width: 8224
        (*jpeg)[at] = (*jpeg)[at + 1] = '\x20';
    const auto huge = io::decode_jpeg(*jpeg, false);
    REQUIRE_FALSE(huge);
    CHECK(huge.error().message.find("the header says 8224 x 8224 pixels, but the file has only") != std::string::npos);
}
