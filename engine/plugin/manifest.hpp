// SPDX-License-Identifier: Apache-2.0
// The manifest of a plugin, plugin.json, read before its library is opened, so that what does not fit is refused with a
// sentence. For example:
//   { "id": "org.example.velvet", "kind": "material", "version": "1.0.0", "abi": {"min": 1, "max": 1},
//     "licence": "MIT", "library": "velvet", "files": ["velvet.glsl"] }
// "abi": 1 is short for min = max = 1. "library" without an extension gets that of the platform. Paths are relative to
// the manifest's folder and stay inside it. `restage check` reads "exceptions". Keys of somebody else's begin with
// "x-", here and in all that is nested; others are refused, because they are typing errors. A material without native
// code has no "library"; its table stands in the manifest:
//   "materials": [{ "type": "velvet", "label": "Velvet", "prefix": "velvet", "glsl": "velvet.glsl", "tooltip":
//   "Cloth.",
//     "flags": ["lossless"],                       stochastic lossless transmissive nonreciprocal tangent additive
//     "params": [{ "id": "fuzz", "label": "Fuzz", "type": "float",           float color int bool enum text
//       "min": 0, "max": 1, "default": 0.5, "unit": "", "tooltip": "How fuzzy.",
//       "choices": ["a", "b"],                     of an enum; its default is one of them
//       "flags": ["texturable", "advanced"] }],
//     "emission": { "radiance": "glow", "scale": "brightness", "two_sided": "both" } }]   ids of params; see emission.h
#pragma once

#include "base/result.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace restage::plugin {

enum class Kind { material, importer, exporter, denoiser };
const char* to_string(Kind);

struct Manifest {
    std::string id, version, licence;
    Kind kind = Kind::material;
    std::uint32_t abi_min = 0, abi_max = 0;
    std::filesystem::path library; // file name as it is on this platform; empty: no native code
    std::vector<std::filesystem::path> files; // that the plugin needs beside its library
};

// Errors: '<file>: "version" is missing: ...', '<file>:3:7: not JSON: ...'
Result<Manifest> parse_manifest(const std::string& text, const std::string& file);
Result<Manifest> read_manifest(const std::filesystem::path& file);

} // namespace restage::plugin
