// SPDX-License-Identifier: Apache-2.0
#include "common/picture.hpp"

#include <cmath>
#include <cstddef>

namespace restage::importing {

namespace {

double linear_to_srgb(double v) { return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

// Of the library, from init to shutdown.
const RestageHost* host = nullptr;
const RestageImageService1* service = nullptr;

std::optional<Picture> decode(const void* bytes, std::size_t size, const std::string& name, std::string& reason) {
    if (!service) {
        reason = name + ": this program decodes no pictures for importers";
        return std::nullopt;
    }
    auto* image = new RestageDecodedImage{};
    std::shared_ptr<RestageDecodedImage> kept(image, [](RestageDecodedImage* done) {
        service->release(host, done);
        delete done;
    });
    if (!service->decode(host, bytes, size, name.c_str(), image)) {
        reason = image->problem ? image->problem : name + ": it cannot be decoded";
        return std::nullopt;
    }
    return Picture{image->width, image->height, image->channels, image->problem ? image->problem : "", std::move(kept)};
}

} // namespace

int use_host_pictures(const RestageHost* given) {
    host = given;
    service = static_cast<const RestageImageService1*>(host->service(host, RESTAGE_IMAGE_SERVICE));
    return service ? 1 : 0;
}

bool Picture::alpha_varies() const {
    const std::size_t count = std::size_t{width} * height;
    for (std::size_t i = 0; i < count && has_alpha(); ++i)
        if (value(i, 3) != 1) return true;
    return false;
}

double Picture::value(std::size_t pixel, unsigned channel) const {
    if (channel == 3 && !has_alpha()) return 1;
    const std::size_t stored = channels >= 3 ? channel : channel == 3 ? 1 : 0;
    const std::size_t at = pixel * channels + stored;
    switch (texels->bits) {
        case 8:
            return static_cast<const std::uint8_t*>(texels->texels)[at] / 255.0;
        case 16:
            return static_cast<const std::uint16_t*>(texels->texels)[at] / 65535.0;
        default: {
            const double v = static_cast<double>(static_cast<const float*>(texels->texels)[at]);
            return channel == 3 ? v : linear_to_srgb(v);
        }
    }
}

std::optional<Picture> decode_picture(std::string_view bytes, const std::string& name, std::string& reason) {
    static constexpr char nothing = 0; // null = a file
    return decode(bytes.empty() ? &nothing : bytes.data(), bytes.size(), name, reason);
}

std::optional<Picture> read_picture(const std::string& path, std::string& reason) {
    return decode(nullptr, 0, path, reason);
}

double srgb_to_linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

Rgb average_color(const Picture& picture, bool srgb) {
    Rgb sum{};
    const std::size_t count = std::size_t{picture.width} * picture.height;
    for (std::size_t i = 0; i < count; ++i)
        for (unsigned c = 0; c < 3; ++c)
            sum[c] += srgb ? srgb_to_linear(picture.value(i, c)) : picture.value(i, c);
    for (double& x : sum)
        x /= static_cast<double>(count ? count : 1);
    return sum;
}

} // namespace restage::importing
