// SPDX-License-Identifier: Apache-2.0
#include "view/picture.hpp"

#include "io/exr.hpp"
#include "io/image_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace restage::view {

namespace {

// R, G, B, and Y: the error of luminance, which those of the channels do not tell because channels err together.
std::vector<float> standard_errors(const render::FilmImage& film, float exposure) {
    std::vector<float> out;
    out.reserve(film.std_error.size() * 4);
    for (std::size_t i = 0; i < film.std_error.size(); ++i) {
        const glm::vec3& e = film.std_error[i];
        for (const float error : {e.r, e.g, e.b, std::sqrt(film.luminance_variance[i])})
            out.push_back(error * exposure);
    }
    return out;
}

} // namespace

namespace {

std::string extension_of(const std::string& path) { // in lower case
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return extension;
}

constexpr std::string_view layers[] = {"stderr", "albedo", "normal", "depth", "id"};
} // namespace

Result<void> check_aovs(const std::string& aovs) {
    if (aovs == "all" || aovs == "none") return {};
    for (std::string_view rest = aovs;;) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const std::string_view name = rest.substr(0, comma);
        if (std::find(std::begin(layers), std::end(layers), name) == std::end(layers))
            return fail("there is no layer \"" + std::string(name) +
                        "\"; there are stderr, albedo, normal, depth and id (commas between), all, or none");
        if (comma == rest.size()) return {};
        rest.remove_prefix(comma + 1);
    }
}

Result<void> check_picture_path(const std::string& path) {
    const std::filesystem::path p(path);
    static constexpr std::string_view known[] = {".exr", ".png", ".jpg", ".jpeg", ".pfm", ".hdr"};
    if (std::find(std::begin(known), std::end(known), extension_of(path)) == std::end(known))
        return fail(path + ": the extension says the format: .exr, .png, .jpg, .pfm or .hdr");
    const auto folder = p.has_parent_path() ? p.parent_path() : std::filesystem::path(".");
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        return fail(path + ": there is no folder " + folder.string() + "; make it first, or write elsewhere");
    if (const auto there = std::filesystem::status(p, error); exists(there) && !is_regular_file(there))
        return fail(path + ": is there already, and no file that can be replaced");
    return {};
}

Result<void> write_picture(const std::string& path, const Picture& picture, const PictureOptions& o) {
    RESTAGE_CHECK(check_aovs(o.aovs));
    const render::FilmImage& film = picture.film;
    const auto scaled = [&](const std::vector<glm::vec3>& in, float scale) {
        std::vector<float> out(in.size() * 3);
        for (std::size_t i = 0; i < in.size(); ++i)
            for (int k = 0; k < 3; ++k)
                out[i * 3 + k] = in[i][k] * scale;
        return out;
    };
    const auto& color = picture.denoised ? *picture.denoised : film.color;
    const std::string extension = extension_of(path);
    if (extension != ".exr") {
        scene::PixelData pixels{
            .width = film.width, .height = film.height, .channels = 3, .values = scaled(color, picture.exposure)};
        if (extension == ".png") return io::write_png(path, pixels, o.exposure_stops);
        if (extension == ".jpg" || extension == ".jpeg") return io::write_jpg(path, pixels, o.exposure_stops);
        return io::write_image(path, pixels);
    }
    const auto wanted = [&](const char* name) {
        return o.aovs == "all" || ("," + o.aovs + ",").find(std::string(",") + name + ",") != std::string::npos;
    };
    const std::vector<std::string> rgb{"R", "G", "B"};
    io::ExrImage image{.width = film.width, .height = film.height, .metadata = o.metadata};
    image.layers.push_back({.name = "", .channels = rgb, .values = scaled(color, picture.exposure)});
    if (picture.denoised)
        image.layers.push_back({.name = "noisy", .channels = rgb, .values = scaled(film.color, picture.exposure)});
    if (wanted("stderr"))
        image.layers.push_back(
            {.name = "stderr", .channels = {"R", "G", "B", "Y"}, .values = standard_errors(film, picture.exposure)});
    if (wanted("albedo")) image.layers.push_back({.name = "albedo", .channels = rgb, .values = scaled(film.albedo, 1)});
    if (wanted("normal"))
        image.layers.push_back({.name = "normal", .channels = {"X", "Y", "Z"}, .values = scaled(film.normal, 1)});
    if (wanted("depth")) image.layers.push_back({.name = "depth", .channels = {"Z"}, .values = film.depth});
    if (wanted("id")) {
        std::vector<std::uint32_t> ids(film.instance_id.size() * 2);
        for (std::size_t i = 0; i < film.instance_id.size(); ++i) {
            ids[2 * i] = film.instance_id[i];
            ids[2 * i + 1] = film.material_id[i];
        }
        image.layers.push_back(
            {.name = "id", .channels = {"instance", "material"}, .type = io::ExrType::uint32, .integers = ids});
    }
    return io::write_exr(path, image);
}

} // namespace restage::view
