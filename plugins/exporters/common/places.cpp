// SPDX-License-Identifier: Apache-2.0
#include "common/places.hpp"

#include "common/picture.hpp"
#include "common/ply.hpp"
#include "common/text.hpp"

namespace restage::exporters {

namespace fs = std::filesystem;

Files files_option(const std::string& choice) {
    return choice == "relative" ? Files::relative : choice == "absolute" ? Files::absolute : Files::copy;
}

std::string Places::of(const std::string& path) {
    std::string& file = files_[path];
    if (!file.empty()) return file;
    const fs::path source(path);
    if (how_ == Files::absolute) return file = source.generic_string();
    if (const std::string inside = out_.inside(source); !inside.empty()) return file = inside; // next to the scene
    if (how_ == Files::relative) {
        file = source.lexically_relative(out_.folder()).generic_string();
        return file = file.empty() ? source.generic_string() : file; // on another drive
    }
    file = out_.unique_file("textures", plain_name(source.stem().string()), source.extension().string());
    out_.copy(source, file);
    return file;
}

std::string Places::of_pixels(const RestageImage& image) {
    const std::string file = out_.unique_file("textures", plain_name(fs::path(image.name).stem().string()), ".pfm");
    out_.write(file, pfm_bytes(image));
    return file;
}

std::string Places::of_mesh(const RestageMesh& mesh) {
    const std::string file = out_.unique_file("models", plain_name(mesh.name), ".ply");
    out_.write(file, ply_bytes(mesh));
    return file;
}

} // namespace restage::exporters
