// SPDX-License-Identifier: Apache-2.0
// Session: one open document. It owns the scene, its history and the import report; every user change to a scene
// goes through it, from the editor, a script or the command line alike. The renderer reads scene() and compares
// versions; nothing here knows of it. [main]
#pragma once

#include "base/result.hpp"
#include "document/document.hpp"
#include "io/export.hpp"
#include "io/import.hpp"
#include "plugin/registry.hpp"
#include "scene/edits.hpp"
#include "scene/history.hpp"
#include "scene/merge.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace restage::document {

class Session {
  public:
    explicit Session(const plugin::Registry& registry) : registry_(registry) {}

    // A scene file or project replaces the open document; on failure that stays open.
    Result<> open(const std::string& path, const ReadOptions& = {});
    void adopt(Document); // already read
    // A recovery file: everything beyond its base is one unsaved change, and its original location becomes the path.
    void adopt_recovered(Document);
    void adopt(scene::Scene, io::Report = {}, std::string path = {}); // a scene created in code

    const scene::Scene& scene() const { return scene_; }
    scene::Version version() const { return scene_.clock; } // grows with every change
    const scene::History& history() const { return history_; }
    void set_history_budget(std::size_t bytes) { history_.set_budget(bytes); } // scene::History
    const io::Report& report() const { return report_; } // of the import
    const std::string& path() const { return path_; } // of the file that was opened or saved; "" = none
    const DataSources& sources() const { return sources_; } // of geometry and pixels stored in other files
    const Base& base() const { return base_; } // the base of a project's changes
    bool modified() const { return !history_.clean(); }
    const plugin::Registry& registry() const { return registry_; }

    template <class T>
    scene::Id<T> find(std::string_view name) const {
        return scene::find_by_name<T>(scene_, name);
    }

    // The only way to change the scene. True if it changed. `gesture`: see scene::History. Refused: what builders in
    // scene/edits.hpp refuse, and values that scene::check_edit rejects.
    Result<bool> edit(Result<scene::Edit>, std::string_view gesture = {});
    // Its looks: see looks.hpp, whose functions change them. With the change of the scene, if any, one undo step.
    const Looks& looks() const;
    Result<> change_looks(Looks, std::string label, scene::Edit = {});
    void end_gesture() { history_.end_gesture(); }
    bool cancel_gesture() { return history_.cancel_gesture(scene_); } // see scene::History
    bool undo() { return history_.undo(scene_); }
    bool redo() { return history_.redo(scene_); }

    // Shortcuts for the most common edits.
    using Instances = std::span<const scene::Id<scene::Instance>>;
    Result<std::vector<scene::Id<scene::Instance>>> duplicate(Instances, const glm::dmat4& move);
    Result<bool> remove(Instances);
    Result<bool> move(Instances, const glm::dmat4& by, std::string_view gesture = {}); // world space
    Result<bool> set_material(Instances, scene::Id<scene::Material>);
    // The value is checked against the table of the material's plugin: type, range, choices. Unknown ids are refused; a
    // material whose plugin is missing accepts any.
    Result<bool> set_param(scene::Id<scene::Material>, std::string_view param, scene::Value,
                           std::string_view gesture = {});
    // Likewise, without applying it.
    Result<scene::Edit> param_edit(scene::Id<scene::Material>, std::string_view param, scene::Value) const;
    Result<scene::Id<scene::Material>> add_material(std::string name, std::string type);
    // Inserts the objects of another file, as one undo step; their import report is added to
    // the report. `stand`: a point of a surface, where the centre of their underside is placed; under a ceiling, of
    // their top; on a wall, if they are flat, of their back, turned to the wall.
    struct Stand {
        glm::dvec3 at, up; // up: unit
        glm::dvec3 normal{0}; // of the surface, unit; 0: up
    };
    Result<scene::Merged> insert_file(const std::string& path, const io::ImportOptions& = {});
    Result<scene::Merged> insert(const io::ImportedScene&, const std::string& file,
                                 const std::optional<Stand>& stand = {}); // already read

    // Writes a copy; the document and its path are unchanged.
    Result<io::Report> export_to(const std::string& path, const io::ExportOptions& = {}) const;
    // Writes it and remembers the path: the document is unmodified afterwards.
    Result<io::Report> save_as(const std::string& path, const io::ExportOptions& = {});
    // Likewise as a project (project.hpp): its base by reference and the changes. The history continues.
    Result<> save_project(const std::string& path);
    // The text of a project; paths in it are absolute. `note`: see recovery.hpp.
    std::string recovery_text(const std::map<std::string, std::string>& note) const;

  private:
    void take(scene::Scene&&);

    const plugin::Registry& registry_;
    scene::Scene scene_;
    scene::History history_;
    io::Report report_;
    std::string path_;
    Base base_;
    DataSources sources_;
    std::string unknown_; // of a project written by a newer program
};

} // namespace restage::document
