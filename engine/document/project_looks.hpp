// SPDX-License-Identifier: Apache-2.0
// Reads the looks of a project file: each is what changes in the project's scene when one goes to it. What that scene
// no longer has is left out and reported.
#pragma once

#include "document/looks.hpp"
#include "document/project_values.hpp"

namespace restage::document {

class LookReader : public ValueReader {
  public:
    // `sizes`: of the base when the project was saved, by kind.
    LookReader(const std::string& file, const plugin::Registry& registry, const scene::Scene& base,
               std::map<std::string, std::uint32_t> sizes);
    // `scene`: the project's. Errors name the look and the field.
    Result<std::shared_ptr<const Looks>> run(const json& list, const scene::Scene& scene, io::Report& report);

  private:
    scene::Scene read_look(const json& look, const scene::Scene& scene);
    template <class T>
    void read_items(const json& look, scene::Scene& state);
    void make_sky(scene::Scene& state, const scene::Scene& scene, const std::string& name, io::Report& report);

    const plugin::Registry& registry_;
    struct Sky {
        std::string type;
        scene::ParamSet params;
        std::shared_ptr<const scene::PixelData> pixels;
    };
    std::vector<Sky> skies_; // those already made
};

} // namespace restage::document
