// SPDX-License-Identifier: Apache-2.0
// Where the files that a scene refers to are put: named in place, or copied next to the scene.
#pragma once

#include "common/output.hpp"

#include <restage/scene_io.h>
#include <map>
#include <string>

namespace restage::exporters {

enum class Files { copy, relative, absolute };
Files files_option(const std::string& choice); // "copy", "relative" or "absolute"

class Places {
  public:
    Places(Output& output, Files how) : out_(output), how_(how) {}
    Files how() const { return how_; }
    // The name of an existing file for the scene file; copied into textures/ if so chosen and not next to the scene.
    std::string of(const std::string& path);
    std::string of_pixels(const RestageImage&); // which are written as .pfm
    // The mesh as models/NAME.ply
    std::string of_mesh(const RestageMesh&);

  private:
    Output& out_;
    Files how_;
    std::map<std::string, std::string> files_; // by path
};

} // namespace restage::exporters
