// SPDX-License-Identifier: Apache-2.0
// Session: one open document. It owns the scene, its history and the import report; everything a user can do to a scene
// goes through it, from the editor, a script or the command line alike. The renderer looks at scene() and compares
// versions; nothing here knows of it. [main]
#pragma once

#include "base/result.hpp"
#include "io/export.hpp"
#include "io/import.hpp"
#include "plugin/registry.hpp"
#include "scene/edits.hpp"
#include "scene/history.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace restage::session {

class Session {
  public:
    explicit Session(const plugin::Registry& registry) : registry_(registry) {}

    // Replaces what is open; when it fails, what is open stays.
    Result<> open(const std::string& path, const io::ImportOptions& = {});
    void adopt(scene::Scene, io::Report = {}, std::string path = {}); // a scene made in code, or read elsewhere

    const scene::Scene& scene() const { return scene_; }
    scene::Version version() const { return scene_.clock; } // grows with every change
    const scene::History& history() const { return history_; }
    const io::Report& report() const { return report_; } // of the import
    const std::string& path() const { return path_; } // of the file that was opened or saved; "" = none
    bool modified() const { return !history_.clean(); }
    const plugin::Registry& registry() const { return registry_; }

    template <class T>
    scene::Id<T> find(std::string_view name) const {
        return scene::find_by_name<T>(scene_, name);
    }

    // The one way to change the scene. True = it changed. `gesture`: see scene::History.
    bool edit(scene::Edit, std::string_view gesture = {});
    Result<bool> edit(Result<scene::Edit>, std::string_view gesture = {}); // of the builders of scene/edits.hpp
    void end_gesture() { history_.end_gesture(); }
    bool undo() { return history_.undo(scene_); }
    bool redo() { return history_.redo(scene_); }

    // The commonest edits in one word.
    using Instances = std::span<const scene::Id<scene::Instance>>;
    Result<std::vector<scene::Id<scene::Instance>>> duplicate(Instances, const glm::dmat4& move);
    Result<bool> remove(Instances);
    Result<bool> move(Instances, const glm::dmat4& by, std::string_view gesture = {}); // world space
    Result<bool> set_material(Instances, scene::Id<scene::Material>);
    // The value is held to the table of the material's plugin: type, range, choices. Unknown ids are refused; a
    // material whose plugin is missing takes any.
    Result<bool> set_param(scene::Id<scene::Material>, std::string_view param, scene::Value,
                           std::string_view gesture = {});
    Result<scene::Id<scene::Material>> add_material(std::string name, std::string type);
    // The objects of another file become new objects here, as one step of the history; what became of them is added to
    // the report. For a UI that reads on a worker: io::import_into, then edit() with what it returns.
    Result<scene::Merged> insert_file(const std::string& path, const io::ImportOptions& = {});

    // Writes a copy; the document stays what and where it is.
    Result<io::Report> export_to(const std::string& path, const io::ExportOptions& = {}) const;
    // Writes it and remembers the place: the document is unmodified afterwards.
    Result<io::Report> save_as(const std::string& path, const io::ExportOptions& = {});

  private:
    const plugin::Registry& registry_;
    scene::Scene scene_;
    scene::History history_;
    io::Report report_;
    std::string path_;
};

} // namespace restage::session
