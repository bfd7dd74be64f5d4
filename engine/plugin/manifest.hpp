// SPDX-License-Identifier: Apache-2.0
// The manifest of a plugin, plugin.json, read before its library is opened, so that an unusable plugin is refused
// with a reason. A plugin is a bundle: it states what it provides and needs. For example:
//   { "id": "org.example.cloth", "version": "1.2.0", "licence": "MIT",
//     "provides": ["restage.material/1", "restage.inspector/1", "restage.importer/1"],
//     "needs": {"host": ">=0.2", "interfaces": ["restage.log/1"]},
//     "library": "cloth", "files": ["velvet.glsl"] }
// "host" is ">=A.B", or ">=A.B <C.D". Unknown interfaces in "provides" are ignored; missing ones in
// "needs" refuse the plugin. "library" without an extension gets the platform's. Paths are relative
// to the manifest's folder and stay inside it. `restage check` reads "exceptions". Third-party keys begin with
// "x-", at every level; other unknown keys are refused as misspellings. Materials without native
// code are written in the manifest, with or without a library:
//   "materials": [{ "type": "velvet", "label": "Velvet", "prefix": "velvet", "glsl": "velvet.glsl", "tooltip":
//   "Cloth.",
//     "flags": ["lossless"],                       stochastic lossless transmissive nonreciprocal tangent additive
//     "params": [{ "id": "fuzz", "label": "Fuzz", "type": "float",           float color int bool enum text
//       "min": 0, "max": 1, "default": 0.5, "unit": "", "tooltip": "How fuzzy.",
//       "choices": ["a", "b"],                     of an enum; its default is one of them
//       "flags": ["texturable", "advanced"] }],
//     "emission": { "radiance": "glow", "scale": "brightness", "two_sided": "both" } }]   ids of params; see emission.h
// and likewise textures (restage/texture.h), with the same "params":
//   "textures": [{ "type": "weave", "label": "Weave", "prefix": "weave", "glsl": "weave.glsl", "tooltip": "Threads.",
//     "flags": ["mapped"], "params": [...] }]      image mapped site
#pragma once

#include "base/result.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace restage::plugin {

struct Manifest {
    std::string id, version, licence;
    std::vector<std::string> provides; // "restage.material/1", ...
    std::string needs_host; // ">=0.2"; "" = any
    std::vector<std::string> needs_interfaces;
    std::filesystem::path library; // file name on this platform; empty: no native code
    std::vector<std::filesystem::path> files; // needed besides the library
    bool has_materials = false; // described in the manifest itself

    // "restage.material" of any revision.
    bool provides_any(std::string_view interface_name) const;
    // For lists: "material", "importer", ... in the order of "provides", without duplicates.
    std::vector<std::string> kinds() const;
    std::string kind() const; // "material", "importer, exporter"
};

// Errors: '<file>: "version" is missing: ...', '<file>:3:7: not JSON: ...'
Result<Manifest> parse_manifest(const std::string& text, const std::string& file);
Result<Manifest> read_manifest(const std::filesystem::path& file);

std::span<const std::string_view> known_interfaces(); // that this program can use
struct HostOffer {
    std::string version; // of the program
    std::vector<std::string_view> interfaces, services; // that it can use or that it offers to plugins
};
// Checks that the program meets the manifest's needs. The error is a sentence that says why the plugin is refused.
Result<> check_needs(const Manifest&, const HostOffer&, const std::string& file);

} // namespace restage::plugin
