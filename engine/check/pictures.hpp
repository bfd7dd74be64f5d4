// SPDX-License-Identifier: Apache-2.0
// A page of pictures of a material, one self-contained HTML file: samples and pdf in the plane of incidence, a
// sphere in a white furnace, and a sweep of its roughness under a plain sky. For viewing only; the steps decide.
#pragma once

#include "check/subject.hpp"

namespace restage::check {

// Of the subject's current material. Returns the file's path.
Result<std::filesystem::path> write_pictures(Subject& s, const std::filesystem::path& folder);

} // namespace restage::check
