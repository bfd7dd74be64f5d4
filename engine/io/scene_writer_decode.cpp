// SPDX-License-Identifier: Apache-2.0
// Pictures that an importer wants to look into: decoded by the one decoder there is, lent until load returns.
#include "base/file.hpp"
#include "io/image_file.hpp"
#include "io/image_file_codecs.hpp"
#include "io/scene_writer_calls.hpp"
#include "plugin/abi.hpp"

#include <type_traits>
#include <variant>

namespace restage::io {

void SceneWriter::drop_decoded() { decoded_.clear(); }

int SceneWriter::Calls::decode_image(void* ctx, const void* bytes, std::size_t size, const char* name,
                                     RestageDecodedImage* out) {
    if (!out) return 0;
    plugin::give(out, RestageDecodedImage{.problem = "out of memory"});
    return static_cast<int>(guarded(ctx, "decode_image", [&](SceneWriter& w) -> RestageHandle {
        const std::string what = text(name);
        auto decoded = bytes ? decode_image_bytes({static_cast<const char*>(bytes), size}) : decode_image_file(what);
        if (!decoded) {
            w.decode_problem_ = bytes ? what + ": " + decoded.error().message : decoded.error().message;
            plugin::give(out, RestageDecodedImage{.problem = w.decode_problem_.c_str()});
            return 0;
        }
        auto image = std::make_shared<const DecodedImage>(std::move(*decoded));
        RestageDecodedImage given{
            .width = image->width,
            .height = image->height,
            .channels = image->channels,
            .problem = image->warning.c_str(),
            .owner = const_cast<DecodedImage*>(image.get())}; // a name for it; nobody writes there
        std::visit(
            [&](const auto& values) {
                given.bits = 8 * sizeof values[0];
                given.texels = values.data();
            },
            image->values);
        w.decoded_[given.owner] = std::move(image);
        plugin::give(out, given);
        return 1;
    }));
}

void SceneWriter::Calls::release_image(void* ctx, RestageDecodedImage* image) {
    if (!image) return;
    guarded(ctx, "release_image", [&](SceneWriter& w) -> RestageHandle {
        w.decoded_.erase(image->owner);
        return 0;
    });
    plugin::give(image, RestageDecodedImage{});
}

} // namespace restage::io
