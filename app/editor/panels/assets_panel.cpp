// SPDX-License-Identifier: Apache-2.0
// Assets: things to add to the scene: drag them into the picture, or double-click.
#include "panels.hpp"

#include "base/file.hpp"
#include "drop.hpp"
#include "file_browser.hpp"
#include "inspector.hpp"
#include "io/image_file.hpp"
#include "library.hpp"
#include "panel_context.hpp"
#include "scene_panel.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <cmath>

namespace restage::editor {

namespace {

namespace fs = std::filesystem;
constexpr std::uint32_t thumbnail_pixels = 128;
constexpr std::size_t most_thumbnails = 800; // the window has 1024 texture descriptors
constexpr const char* kind_names[] = {"All", "Scenes", "Skies", "Textures", "Meshes"};

fs::path own_config(const PanelUi& e) {
    return e.options().config_dir.empty() ? fs::path() : e.options().config_dir / "assets.json";
}

void load(PanelUi& e, AssetsState& state) {
    if (state.loaded) return;
    state.loaded = true;
    state.entries.clear();
    state.folders.clear();
    std::vector<fs::path> configs;
    if (const fs::path own = own_config(e); !own.empty()) configs.push_back(own);
    if (const auto bin = executable_dir())
        for (const char* beside : {"share/restage/assets.json", "share/restage/scenes/assets.json"})
            configs.push_back(bin->parent_path() / beside);
    for (const fs::path& config : configs) {
        auto read = read_assets(config, &state.folders);
        if (!read)
            e.notices.add(LogLevel::error, read.error().message);
        else
            for (Asset& asset : *read)
                if (std::none_of(state.entries.begin(), state.entries.end(),
                                 [&](const Asset& a) { return a.path == asset.path; }))
                    state.entries.push_back(std::move(asset));
    }
}

void ask_thumbnail(PanelUi& e, AssetsState::Thumbnail& thumbnail, const std::string& file) {
    thumbnail.asked = true;
    e.panel_state->loads.start(
        {.path = file,
         .encoding = scene::Encoding::srgb, // of 8-bit images
         .thumbnail = thumbnail_pixels,
         .done = [&e, path = file](Result<std::shared_ptr<const scene::PixelData>> pixels) {
             AssetsState::Thumbnail& to = e.panel_state->assets.thumbnails[path];
             if (!pixels) {
                 to.failed = true;
                 return;
             }
             const scene::PixelData& image = **pixels;
             std::vector<std::uint32_t> rgba(std::size_t(image.width) * image.height);
             for (std::size_t i = 0; i < rgba.size(); ++i) {
                 std::uint32_t seen[3];
                 for (std::size_t c = 0; c < 3; ++c)
                     seen[c] = std::uint32_t(std::lround(
                         255 * io::linear_to_srgb(std::clamp(
                                   image.values[i * image.channels + (image.channels >= 3 ? c : 0)], 0.f, 1.f))));
                 rgba[i] = seen[0] | seen[1] << 8 | seen[2] << 16 | 0xff000000u;
             }
             to.texture = std::make_unique<Texture>();
             to.texture->set(image.width, image.height, rgba);
             to.size = {float(image.width), float(image.height)};
         }});
}

void apply(SelectContext& e, const Asset& asset) {
    switch (asset.kind) {
        case AssetKind::scene:
            e.open(asset.path);
            break;
        case AssetKind::mesh:
            e.insert(asset.path);
            break;
        case AssetKind::sky:
            use_as_sky(e, asset.path);
            break;
        case AssetKind::texture:
            if (e.selection.instances().empty())
                e.notices.add(LogLevel::info, "Select an object first, or drag the image onto one");
            else
                texture_for_selected(e, asset.path);
            break;
    }
}

void cell(SelectContext& e, const Asset& asset, float side) {
    ImGui::PushID(asset.path.c_str());
    ImGui::BeginGroup();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("asset", {side, side + ImGui::GetTextLineHeight() + 4 * ImGui::GetStyle().FontScaleMain});
    const bool visible = ImGui::IsItemVisible(), hovered = ImGui::IsItemHovered();
    e.mark("asset." + asset.name);
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) apply(e, asset);
    if (ImGui::BeginDragDropSource()) {
        ImGui::SetDragDropPayload("restage.path", asset.path.c_str(), asset.path.size() + 1);
        ImGui::TextUnformatted(asset.name.c_str());
        ImGui::EndDragDropSource();
    }
    static constexpr const char* uses[] = {"Double click: open it",
                                           "Double click: use it as the sky. Or drag it into the picture",
                                           "Double click: apply it to the selection. Or drag it onto an object",
                                           "Double click: add it to the scene. Or drag it to its place"};
    tip(fmt::format("{}\n{}", asset.path, uses[int(asset.kind)]).c_str());
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, {at.x + side, at.y + side},
                        ImGui::GetColorU32(hovered ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg), side * 0.05f);
    const bool image = asset.kind == AssetKind::sky || asset.kind == AssetKind::texture;
    static const AssetsState::Thumbnail none;
    const AssetsState::Thumbnail& thumbnail = image && visible ? thumbnail_of(e, asset.path) : none;
    if (thumbnail.texture && thumbnail.texture->ready()) {
        const float fit = std::min(side / thumbnail.size.x, side / thumbnail.size.y);
        const ImVec2 size(thumbnail.size.x * fit, thumbnail.size.y * fit),
            corner(at.x + (side - size.x) / 2, at.y + (side - size.y) / 2);
        draw->AddImage(thumbnail.texture->ref(), corner, {corner.x + size.x, corner.y + size.y});
    } else {
        const char* label = image                            ? (thumbnail.failed ? "Unreadable" : "...")
                            : asset.kind == AssetKind::scene ? "Scene"
                                                             : "Mesh";
        const ImVec2 extent = ImGui::CalcTextSize(label);
        const ImU32 color = ImGui::GetColorU32(thumbnail.failed ? colors::error : colors::dim);
        const float icon = image ? 0 : side * 0.5f;
        if (!image)
            draw_icon(draw, asset.kind == AssetKind::scene ? Icon::camera : Icon::mesh,
                      {at.x + (side - icon) / 2, at.y + side * 0.12f}, icon, color);
        draw->AddText({at.x + (side - extent.x) / 2, at.y + (side - extent.y + icon) / 2}, color, label);
    }
    const float gap = 2 * ImGui::GetStyle().FontScaleMain;
    const ImVec2 name(at.x, at.y + side + gap), end(at.x + side, name.y + ImGui::GetTextLineHeight() + gap);
    ImGui::RenderTextEllipsis(draw, name, end, end.x, asset.name.c_str(), nullptr, nullptr);
    ImGui::EndGroup();
    ImGui::PopID();
}

void add_folder(PanelUi& e, const fs::path& folder) {
    if (own_config(e).empty())
        e.notices.add(LogLevel::error, "There is no configuration folder to store it in");
    else if (auto added = add_asset_folder(own_config(e), folder); !added)
        e.notices.add(LogLevel::error, added.error().message);
    else
        e.panel_state->assets.loaded = false;
}

} // namespace

std::vector<std::string> assets_of(PanelUi& e, AssetKind kind) {
    load(e, e.panel_state->assets);
    return e.panel_state->assets.files_of(kind);
}

const AssetsState::Thumbnail& thumbnail_of(PanelUi& e, const std::string& file) {
    AssetsState& state = e.panel_state->assets;
    AssetsState::Thumbnail& thumbnail = state.thumbnails[file];
    if (!thumbnail.asked && state.thumbnails.size() < most_thumbnails) ask_thumbnail(e, thumbnail, file);
    return thumbnail;
}

void accept_asset(PanelContext& e) {
    if (!ImGui::BeginDragDropTarget()) return;
    constexpr ImGuiDragDropFlags while_over = ImGuiDragDropFlags_AcceptBeforeDelivery |
                                              ImGuiDragDropFlags_AcceptNoDrawDefaultRect |
                                              ImGuiDragDropFlags_AcceptNoPreviewTooltip;
    if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(material_payload, while_over)) {
        const std::string key(static_cast<const char*>(payload->Data));
        const ImVec2 at = ImGui::GetIO().MousePos;
        if (payload->IsDelivery())
            e.later([&e, key, at] { drop_material(e, key, at); });
        else
            preview_material_drop(e, key, at);
    }
    if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload("restage.path", while_over)) {
        const std::filesystem::path path(static_cast<const char*>(payload->Data));
        const ImVec2 at = ImGui::GetIO().MousePos;
        if (payload->IsDelivery())
            e.later([&e, path, at] { e.drop({path}, at); }); // as if dropped from outside
        else
            preview_drop(e, path, at);
    }
    ImGui::EndDragDropTarget();
}

void draw_assets(SelectContext& e) {
    AssetsState& state = e.panel_state->assets;
    load(e, state);
    const float scale = ImGui::GetStyle().FontScaleMain;
    ImGui::SetNextItemWidth(100 * scale);
    ImGui::Combo("##kind", &state.kind, kind_names, IM_ARRAYSIZE(kind_names));
    e.mark("assets.kind");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(120 * scale);
    ImGui::InputTextWithHint("##search", "Search", &state.search);
    e.mark("assets.search");
    if (flow_button("Reload")) {
        state.loaded = false;
        for (auto& [path, thumbnail] :
             state.thumbnails) // existing ones stay: textures are never freed before the window
            if (thumbnail.failed) thumbnail = {};
    }
    tip("Read assets.json and the folders again");
    e.mark("assets.reload");
    if (flow_button("Add folder..."))
        browse(e, {.title = "Folder with scenes, images or meshes", .folder = true, .done = add_folder});
    tip("Lists its contents here, three levels deep");
    e.mark("assets.add");
    if (state.entries.empty()) {
        empty_note(fmt::format("No assets yet. Add a folder, or list files in {}.",
                               own_config(e).empty() ? "assets.json" : own_config(e).string())
                       .c_str());
        return;
    }
    ImGui::Separator();
    if (ImGui::BeginChild("grid")) {
        const float side = 76 * scale, step = side + ImGui::GetStyle().ItemSpacing.x;
        const int columns =
            std::max(1, int((ImGui::GetContentRegionAvail().x + ImGui::GetStyle().ItemSpacing.x) / step));
        int shown = 0;
        for (const Asset& asset : state.entries) {
            if ((state.kind > 0 && int(asset.kind) != state.kind - 1) || !contains_word(asset.name, state.search))
                continue;
            if (shown++ % columns) ImGui::SameLine();
            cell(e, asset, side);
        }
        if (shown == 0) empty_note("Nothing matches.");
    }
    ImGui::EndChild();
}

} // namespace restage::editor
