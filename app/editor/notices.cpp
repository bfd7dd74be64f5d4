// SPDX-License-Identifier: Apache-2.0
#include "notices.hpp"

#include "theme.hpp"

#include <imgui.h>
#include <chrono>
#include <vector>

namespace restage::editor {

namespace {

constexpr double info_seconds = 4, error_seconds = 12;
constexpr std::size_t most_lines = 2000;

double now() {
    static const auto start = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double lifetime(LogLevel level) {
    return level == LogLevel::debug ? 0 : level == LogLevel::info ? info_seconds : error_seconds;
}

} // namespace

void Notices::add(LogLevel level, std::string text) {
    std::lock_guard lock(mutex_);
    lines_.push_back({level, std::move(text), now()});
    ++total_;
    if (lines_.size() > most_lines) lines_.pop_front();
}

std::deque<LogLine> Notices::lines() const {
    std::lock_guard lock(mutex_);
    return lines_;
}

std::size_t Notices::count() const {
    std::lock_guard lock(mutex_);
    return total_;
}

bool Notices::fading() const {
    std::lock_guard lock(mutex_);
    for (auto line = lines_.rbegin(); line != lines_.rend() && now() - line->time < error_seconds; ++line)
        if (now() - line->time < lifetime(line->level)) return true;
    return false;
}

void Notices::draw(float right, float bottom) {
    std::vector<LogLine> fresh;
    {
        std::lock_guard lock(mutex_);
        for (auto line = lines_.rbegin(); line != lines_.rend() && fresh.size() < 4; ++line)
            if (now() - line->time < lifetime(line->level)) fresh.push_back(*line);
    }
    const float scale = ImGui::GetStyle().FontScaleMain, pad = 8 * scale,
                width = std::clamp(right - ImGui::GetWindowPos().x - 4 * pad, 1.f, 360 * scale);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    for (const LogLine& line : fresh) {
        const ImVec2 size = ImGui::CalcTextSize(line.text.c_str(), nullptr, false, width);
        const float alpha = float(std::min(1.0, (lifetime(line.level) - (now() - line.time)) / 0.5));
        const ImVec2 corner(right - size.x - 3 * pad, bottom - size.y - 2 * pad);
        const ImVec4 stripe = line.level == LogLevel::error     ? colors::error
                              : line.level == LogLevel::warning ? colors::warning
                                                                : colors::good;
        draw->AddRectFilled(corner, {right - pad, bottom}, faded(colors::over_picture, colors::over_picture.w * alpha),
                            4 * scale);
        draw->AddRectFilled(corner, {corner.x + 3 * scale, bottom}, faded(stripe, alpha), 2 * scale);
        draw->AddText(ImGui::GetFont(), ImGui::GetFontSize(), {corner.x + pad, corner.y + pad},
                      faded(ImGui::GetStyleColorVec4(ImGuiCol_Text), alpha), line.text.c_str(), nullptr, width);
        bottom = corner.y - pad;
    }
}

} // namespace restage::editor
