// SPDX-License-Identifier: Apache-2.0
#include "scene_pictures.hpp"

#include "base/file.hpp"
#include "document/session.hpp"
#include "panel_context.hpp"
#include "panels/panels.hpp"
#include "panels/state.hpp"
#include "scene/development.hpp"
#include "theme.hpp"
#include "view/display.hpp"
#include "view/live_view.hpp"
#include "view/picture.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <system_error>
#include <vector>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t longer_side = 256; // [pixel]
constexpr std::size_t most_pictures = 200;

fs::path folder_of(const PanelUi& e) {
    return e.options().config_dir.empty() ? fs::path() : e.options().config_dir / "scene pictures";
}

// Where the picture of the file as it is now would be; "" if there is no such file.
fs::path picture_of(const PanelUi& e, const fs::path& file, std::optional<fs::file_time_type> time = {}) {
    std::error_code code;
    if (!time) time = fs::last_write_time(file, code);
    if (code || folder_of(e).empty()) return {};
    const std::string name = fs::absolute(file, code).lexically_normal().string();
    return folder_of(e) / fmt::format("{:016x}.png", hash64(name, std::uint64_t(time->time_since_epoch().count())));
}

// The means of blocks of pixels.
render::FilmImage small(const render::FilmImage& image) {
    const std::uint32_t block = std::max(1u, (std::max(image.width, image.height) + longer_side - 1) / longer_side);
    auto out = render::FilmImage::blank(std::max(image.width / block, 1u), std::max(image.height / block, 1u));
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            glm::vec3 sum(0);
            float hit = 0, count = 0;
            for (std::uint32_t v = y * block; v < std::min((y + 1) * block, image.height); ++v)
                for (std::uint32_t u = x * block; u < std::min((x + 1) * block, image.width); ++u) {
                    const std::size_t i = std::size_t{v} * image.width + u;
                    sum += image.color[i];
                    hit += i < image.coverage.size() ? image.coverage[i] : 1;
                    ++count;
                }
            out.color[std::size_t{y} * out.width + x] = sum / count;
            out.coverage[std::size_t{y} * out.width + x] = hit / count;
        }
    return out;
}

// Leaves the newest ones.
void forget_old(const fs::path& folder) {
    std::error_code code;
    std::vector<std::pair<fs::file_time_type, fs::path>> all;
    for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code))
        all.emplace_back(at->last_write_time(code), at->path());
    if (all.size() <= most_pictures) return;
    std::ranges::sort(all);
    for (std::size_t i = 0; i < all.size() - most_pictures; ++i)
        fs::remove(all[i].second, code);
}

} // namespace

void keep_scene_picture(PanelContext& e) {
    const auto frame = e.live().best(e.view.denoise);
    if (e.session().path().empty() || e.session().modified() || !frame || frame->document != e.document() ||
        frame->clay || frame->image.color.empty())
        return;
    const fs::path place = picture_of(e, e.session().path());
    if (place.empty()) return;
    view::DisplaySettings settings;
    settings.scale = e.scene().film.value.exposure;
    settings.development = scene::development_of(e.scene());
    std::vector<std::uint32_t> rgba;
    const render::FilmImage image = small(frame->image);
    view::to_display(image, settings, rgba);
    for (std::uint32_t& pixel : rgba)
        pixel |= 0xff000000u;
    std::error_code code;
    fs::create_directories(place.parent_path(), code);
    if (auto written = view::write_rgba(place.string(), image.width, image.height, rgba); !written)
        return e.log().debug("no picture of the scene is kept: " + written.error().message);
    forget_old(place.parent_path());
}

void draw_scene_picture(PanelUi& e, const fs::path& file, float side, const std::string& mark,
                        std::optional<fs::file_time_type> time) {
    const fs::path place = picture_of(e, file, time);
    std::error_code code;
    const bool kept = !place.empty() && fs::exists(place, code);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy({side, side});
    ImDrawList* draw = ImGui::GetWindowDrawList();
    static const AssetsState::Thumbnail none;
    const AssetsState::Thumbnail& picture = kept ? thumbnail_of(e, place.string()) : none;
    e.mark(picture.texture && picture.texture->ready() ? mark : mark + ".icon");
    if (picture.texture && picture.texture->ready()) {
        const float fit = std::min(side / picture.size.x, side / picture.size.y);
        const ImVec2 size(picture.size.x * fit, picture.size.y * fit),
            corner(at.x + (side - size.x) / 2, at.y + (side - size.y) / 2);
        draw->AddImage(picture.texture->ref(), corner, {corner.x + size.x, corner.y + size.y});
    } else {
        draw->AddRectFilled(at, {at.x + side, at.y + side}, ImGui::GetColorU32(ImGuiCol_FrameBg),
                            4 * ImGui::GetStyle().FontScaleMain);
        const float icon = side * 0.4f;
        draw_icon(draw, Icon::camera, {at.x + (side - icon) / 2, at.y + (side - icon) / 2}, icon,
                  ImGui::GetColorU32(colors::dim));
    }
}

void scene_picture_tip(PanelUi& e, const fs::path& file) {
    if (!ImGui::BeginItemTooltip()) return;
    draw_scene_picture(e, file, 160 * ImGui::GetStyle().FontScaleMain, "recent.picture");
    ImGui::TextUnformatted(file.string().c_str());
    ImGui::EndTooltip();
}

} // namespace restage::editor
