// SPDX-License-Identifier: Apache-2.0
// The host's side of restage.scene_reader: an exporter pulls, the Scene stays as it is. Pointers it hands out live as
// long as this reader and the scene.
#pragma once

#include "io/report.hpp"
#include "scene/scene.hpp"

#include <restage/scene_io.h>
#include <deque>
#include <string>
#include <vector>

namespace restage::io {

class SceneReader {
  public:
    SceneReader(const scene::Scene&, Progress);
    SceneReader(const SceneReader&) = delete; // table().ctx is this
    SceneReader& operator=(const SceneReader&) = delete;

    const RestageSceneReader1& table() const { return table_; }
    const std::string& error() const { return error_; } // "" = none was raised
    bool cancelled() const { return cancelled_; }

    Report report;

  private:
    struct Calls; // the C functions
    const RestageValue* values(const scene::ParamSet&, std::uint32_t& count);

    const scene::Scene& scene_;
    Progress progress_;
    RestageSceneReader1 table_{};
    std::deque<std::vector<RestageValue>> values_; // handed out
    std::string error_;
    bool cancelled_ = false;
};

} // namespace restage::io
