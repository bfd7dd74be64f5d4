// SPDX-License-Identifier: Apache-2.0
// Pictures that the export makes itself.
#include "exporter.hpp"

namespace restage::pbrt_out {

std::string Exporter::own_picture(const OwnPicture& picture, const std::string& name) {
    const RestageImage image{
        .width = picture.width, .height = picture.height, .channels = 3, .pixels = picture.pixels.data()};
    const std::string file = out_.unique_file("textures", plain_name(name), ".pfm");
    out_.write(file, pfm_bytes(image));
    return file;
}

std::string Exporter::environment_file(const RestageEnvironment& e, const std::array<float, 3>& tint) {
    RestageImage image{};
    if (!in_.image(in_.ctx, e.image, &image) || !image.pixels || image.width == 0) return "";
    const bool to_octahedral = !v3();
    OwnPicture picture = resampled(image, to_octahedral, 2);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] *= tint[i % 3];
    const std::string file = own_picture(picture, std::string(e.name) + (to_octahedral ? "_octahedral" : "_equirect"));
    approximated(std::string("environment \"") + e.name + "\"",
                 std::string("its picture was resampled to ") +
                     (to_octahedral ? "pbrt-v4's octahedral" : "pbrt-v3's equirectangular") + " mapping");
    return file;
}

} // namespace restage::pbrt_out
