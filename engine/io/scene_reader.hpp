// SPDX-License-Identifier: Apache-2.0
// The host's side of restage.scene_reader: an exporter pulls, the Scene is unchanged. Its pointers are valid as
// long as this reader and the scene.
#pragma once

#include "io/exchange.hpp"
#include "io/material_emission.hpp"
#include "scene/scene.hpp"

#include <restage/scene_io.h>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace restage::io {

// As plugins see them, pointing into `params`.
std::vector<RestageValue> give_values(const scene::ParamSet& params);

class SceneReader : public Exchange {
  public:
    // `registry`: to find the materials that emit.
    SceneReader(const scene::Scene&, const plugin::Registry& registry, Progress);

    const RestageSceneReader1& table() const { return table_; } // its ctx is this

  private:
    struct Calls; // the C functions
    template <class Description>
    bool give_values(const scene::ParamSet&, Description& out);
    const RestageOrigin* origin(const scene::Origin&);

    const scene::Scene& scene_;
    MaterialEmissions shine_;
    std::map<std::uint32_t, glm::vec3> means_; // of emissive textures, by Id<Texture>::value
    RestageSceneReader1 table_{};
    std::deque<std::vector<RestageValue>> values_; // handed out
    std::map<const scene::Origin*, std::pair<std::vector<RestageOriginValue>, RestageOrigin>> origins_; // handed out
};

} // namespace restage::io
