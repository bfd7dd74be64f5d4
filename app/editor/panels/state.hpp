// SPDX-License-Identifier: Apache-2.0
// State that panels keep from frame to frame. Not part of the document; one per editor.
#pragma once

#include "arrange.hpp"
#include "assets.hpp"
#include "check/step.hpp"
#include "finding_things.hpp"
#include "image_loads.hpp"
#include "kept_pictures.hpp"
#include "library.hpp"
#include "light_mixing.hpp"
#include "look_pictures.hpp"
#include "material_balls.hpp"
#include "palette.hpp"
#include "scene/statistics.hpp"
#include "selection.hpp"
#include "sky_making.hpp"
#include "view/light_board.hpp"

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace restage::editor {

struct InspectorState {
    bool uniform_scale = true;
    std::optional<glm::dvec3> euler; // last shown [deg]: kept while they represent the current rotation
    InstanceId euler_of;
    struct Relative { // of several objects: the fields' values until released
        glm::dvec3 move{0}, turn{0}, scale{1};
        glm::dvec3 pivot{0};
        std::vector<std::pair<InstanceId, glm::dmat4>> start;
    } relative;
    std::string material_search;
    struct Area { // of the selected emitter, in world units
        InstanceId of;
        glm::dmat4 transform{0};
        double value = 0;
    } area;
};

struct OutlinerState {
    struct Row {
        enum class Kind { header, group, instance, light, camera } kind = Kind::instance;
        std::uint32_t id = 0; // of that kind
        int depth = 0;
    };
    struct Seen { // of an object, which determines its row
        std::uint32_t group = 0;
        bool live = false, hidden = false, listed = false;
        bool operator==(const Seen&) const = default;
    };
    std::vector<Row> rows; // objects and groups, then lights and cameras
    std::size_t object_rows = 0;
    std::vector<Seen> seen; // by id - 1
    std::size_t lists = 0; // number of times object rows were listed, for tests
    scene::Version made_for = ~std::uint64_t(0);
    std::string made_search;
    scene::Id<scene::Material> made_material;
    std::set<std::uint32_t> open, made_open; // groups
    std::vector<std::uint32_t> members, hidden; // objects in each group, at any depth
    std::string search;
    scene::Id<scene::Material> material; // list only its users
    Row renaming{.id = 0}, cursor{.id = 0}; // cursor: the start for the arrow keys
    std::string new_name;
    bool focus_name = false;
    InstanceId last_active; // the list scrolls when it changes elsewhere
    std::vector<GroupId> dragged; // groups that are dragged whole, with the selection
    std::string drop_problem; // why what is dragged cannot be dropped at the mouse; "" = it can
};

struct StatisticsState {
    scene::Version made_for = ~scene::Version(0);
    scene::Statistics scene;
};

struct SceneState {
    bool keep_aspect = true;
    double aspect = 1;
    std::string device, sky_search;
    bool device_shown = false;
    int threads = 0; // while it is dragged
    bool choose_sky = false; // show the row for a sky's image before there is one
    float blur = 10; // of the sky [deg]
};

struct ReportState {
    bool kept = false, approximated = true, dropped = true;
    std::string search;
};

struct LogState {
    bool details = false, info = true, warnings = true, errors = true;
    std::string search;
    std::size_t cleared = 0; // lines before this one are not shown
    std::size_t seen = 0;
};

struct Curve {
    std::uint64_t request = 0;
    std::vector<double> seconds, samples, error;
};
struct ConvergenceState {
    Curve current, previous;
    bool against_samples = false;
};

struct LooksState {
    explicit LooksState(const std::function<void()>& wake) : pictures(wake) {}
    LookPictures pictures;
    std::optional<std::size_t> renaming; // index of the look
    std::string new_name;
    bool focus_name = false;
    struct Seen { // for which `differs` holds
        scene::Version version = 0;
        std::uint64_t view = 0, document = 0;
        bool operator==(const Seen&) const = default;
    } seen;
    std::string differs; // from the current look; "" = nothing, or there is none
};

struct PluginState { // actions and panels of plugins
    std::map<std::string, scene::ParamSet> asked; // of an action's dialog, from its last use
    std::map<std::string, scene::ParamSet> panels, remembered; // of each panel; `remembered` is the stored version
    bool panels_read = false;
    // Libraries whose panel threw an exception: not drawn until they are reloaded.
    std::map<std::string, std::weak_ptr<const void>> broken;
    std::weak_ptr<const std::string> running; // label of the running action; held by its job
};

struct ImportState { // options of importers in the file browser
    std::map<std::string, scene::ParamSet> options; // by format, the last chosen
    std::filesystem::path file; // for which they were last shown
};

struct PanelState {
    std::map<std::string, check::PluginReport> checks; // by plugin, the latest
    std::set<std::string> said; // warnings not to repeat each frame
    explicit PanelState(const std::function<void()>& wake)
        : loads(wake), balls(wake), looks(wake), skies(wake), things(wake), mixing(wake) {}
    // For a closed scene.
    void forget_document() {
        balls.forget();
        looks.pictures.forget();
        looks.seen = {};
        kept.forget();
        skies.stop();
        things.stop();
        inspector = {};
        outliner = {};
        library.trial = {};
        report = {};
        convergence.current = {};
        convergence.previous = {};
        arrange.live.reset();
        arrange.found = {};
        history_seen = 0;
        lights.forget();
        mixing.forget();
        plugins.asked.clear(); // may refer to its things
    }

    ImageLoads loads;
    MaterialBalls balls;
    LibraryState library;
    LooksState looks;
    KeptPictures kept;
    SkyMaking skies;
    FindingThings things;
    InspectorState inspector;
    ArrangeState arrange;
    OutlinerState outliner;
    SceneState scene;
    view::LightBoard lights; // of the live picture
    LightMixing mixing;
    ReportState report;
    LogState log;
    ConvergenceState convergence;
    PluginState plugins;
    AssetsState assets;
    PaletteState palette;
    StatisticsState statistics;
    ImportState importing;
    std::size_t history_seen = 0;
    int history_mib = 0; // while it is typed
    scene::Id<scene::Texture> texture_to_place; // asked for by its row (place_texture.hpp)
    std::string texture_search; // in popups for choosing an image
    std::pair<std::string, std::string> image_choice; // the mark that asked for an image file, and the file
};

} // namespace restage::editor
