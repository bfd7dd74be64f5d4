// SPDX-License-Identifier: Apache-2.0
#include "io/services.hpp"

#include "io/image_file.hpp"
#include "io/image_file_codecs.hpp"
#include "plugin/abi.hpp"

#include <restage/image.h>
#include <exception>
#include <memory>
#include <string>
#include <variant>

namespace restage::io {

namespace {

struct Lent { // owned by a plugin until it calls release()
    Result<DecodedImage> image = fail("");
    std::string problem;
};

int decode(const RestageHost*, const void* bytes, std::uint64_t length, const char* name,
           RestageDecodedImage* out) noexcept {
    if (!out) return 0;
    plugin::give(out, RestageDecodedImage{.problem = "out of memory"});
    try {
        auto lent = std::make_unique<Lent>();
        const std::string what = name ? name : "";
        lent->image = bytes ? decode_image_bytes({static_cast<const char*>(bytes), static_cast<std::size_t>(length)})
                            : decode_image_file(what);
        RestageDecodedImage given{};
        if (lent->image) {
            const DecodedImage& image = *lent->image;
            lent->problem = image.warning;
            given.width = image.width, given.height = image.height, given.channels = image.channels;
            std::visit(
                [&](const auto& values) {
                    given.bits = 8 * sizeof values[0];
                    given.texels = values.data();
                },
                image.values);
        } else {
            lent->problem = (bytes ? what + ": " : "") + lent->image.error().message;
        }
        const bool done = lent->image.has_value();
        given.problem = lent->problem.c_str();
        given.owner = lent.release(); // release() deletes it
        plugin::give(out, given);
        return done;
    } catch (const std::exception&) { // out of memory: the fields set above remain
        return 0;
    }
}

void release(const RestageHost*, RestageDecodedImage* image) noexcept {
    if (!image) return;
    const std::unique_ptr<Lent> lent(static_cast<Lent*>(image->owner));
    plugin::give(image, RestageDecodedImage{});
}

} // namespace

std::span<const plugin::HostService> services() {
    static constexpr RestageImageService1 images{
        .size = sizeof(RestageImageService1), .decode = decode, .release = release};
    static constexpr plugin::HostService all[] = {{RESTAGE_IMAGE_SERVICE, &images}};
    return all;
}

} // namespace restage::io
