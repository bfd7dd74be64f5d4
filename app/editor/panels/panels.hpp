// SPDX-License-Identifier: Apache-2.0
// The panels: functions that draw the editor's state into their own Dear ImGui window and request changes. Each takes
// the parts of the context that it uses (contexts.hpp). To add one: a new file, a line here, a line in the table of
// panels.cpp.
#pragma once

#include "assets.hpp"
#include "contexts.hpp"

#include <span>

namespace restage::editor {

class PictureView;

void draw_viewport(PanelContext& editor);
void draw_outliner(SelectContext& editor);
void draw_inspector(SelectContext& editor);
void draw_arrange(SelectContext& editor);
void draw_light_mixer(SelectContext& editor);
void draw_scene_settings(SelectContext& editor, PictureView& picture);
void draw_import_report(SelectContext& editor);
void draw_convergence(PanelUi& editor, const PictureView& picture);
void draw_statistics(DocumentContext& editor, const PictureView& picture);
void draw_plugins(DocumentContext& editor);
void draw_log(PanelUi& editor);
void draw_history(EditContext& editor);
void draw_looks(SelectContext& editor, PictureView& picture);
void draw_assets(SelectContext& editor);
void draw_materials(SelectContext& editor);
void draw_help(PanelUi& editor, PictureView& picture);

// Makes the last item (the picture) a drop target for assets: an image on an object or the background, a mesh,
// a scene; and for materials.
void accept_asset(PanelContext& editor);
// All assets of a kind, whether the panel was shown or not.
std::vector<std::string> assets_of(PanelUi& editor, AssetKind kind);
// A thumbnail of that file, read on first use.
const AssetsState::Thumbnail& thumbnail_of(PanelUi& editor, const std::string& file);
// Records the error of the live picture, whether the panel is shown or not; call once per frame.
void follow_convergence(PanelUi& editor, const PictureView& picture);
// Applies the sky that a plugin has generated meanwhile; call once per frame.
void follow_sky(EditContext& editor);

enum class Dock { center, left, right, bottom, floating };

struct Panel {
    const char* title; // also its name in the layout file
    void (*draw)(PanelContext&); // between Begin and End
    Dock dock; // initial place
    bool open; // initially
    const char* tooltip;
};
std::span<const Panel> all_panels();

} // namespace restage::editor
