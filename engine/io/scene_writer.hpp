// SPDX-License-Identifier: Apache-2.0
// The host's side of restage.scene_writer: an importer pushes, a Scene grows. Data is copied and checked on arrival;
// invalid data (an index out of range, an unknown handle) is refused with a line in the report, so that
// the scene is valid whatever the importer does. Image files are read at the end, on all cores.
#pragma once

#include "base/jobs.hpp"
#include "base/result.hpp"
#include "io/exchange.hpp"
#include "plugin/adapters.hpp"
#include "plugin/registry.hpp"
#include "scene/scene.hpp"

#include <restage/scene_io.h>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace restage::io {

class SceneWriter : public Exchange {
  public:
    SceneWriter(const plugin::Registry&, Progress);
    SceneWriter(const SceneWriter&) = delete;
    SceneWriter& operator=(const SceneWriter&) = delete;

    const RestageSceneWriter1& table() const { return table_; } // its ctx is this

    void set_options(scene::ParamSet); // passed to the importer; call before load

    // Names unnamed items, adds a camera if there is none, decodes images, validates. Call once, after load.
    Result<> finish(Jobs&, bool read_images);

    scene::Scene scene;
    bool unexposed = false; // RestageFilm::unexposed

  protected:
    struct Calls; // the C functions (scene_writer_calls.hpp)
    template <class T>
    RestageHandle push(T item);
    template <class T>
    bool known(RestageHandle handle, const char* who_kind, const std::string& who, bool needed = false);
    void refuse(const std::string& what, const std::string& why);
    std::string unique_name(const char* kind, const std::string& wanted);
    scene::Origin origin(const RestageOrigin*);
    scene::ParamSet params(const RestageValue*, std::uint32_t count, const std::string& who);
    // Converted to the engine's types, before the name is made unique; nullopt: refused.
    std::optional<scene::Light> read(const RestageLight&);
    std::optional<scene::Camera> read(const RestageCamera&);
    void read_images(Jobs&, scene::Version newer_than = 0);

    const plugin::Registry& registry_;
    std::map<std::string, std::set<std::string>> names_; // by kind
  private:
    void add_camera();

    std::map<std::string, std::unique_ptr<plugin::GivenTable>> tables_; // handed to the importer, by type
    RestageSceneWriter1 table_{};
    scene::ParamSet options_;
    std::vector<RestageValue> given_options_; // point into options_
    std::map<std::string, unsigned> numbers_;               // by kind and name: the last number used
    std::map<std::tuple<std::string, std::uint32_t, float>, RestageHandle> image_files_;
};

} // namespace restage::io
