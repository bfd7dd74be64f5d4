// SPDX-License-Identifier: Apache-2.0
#include "final_batch.hpp"

#include "contexts.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <utility>

namespace restage::editor {

FinalBatch::FinalBatch(const std::vector<std::string>& names) {
    for (const std::string& name : names)
        lines_.push_back({.shot = lines_.size(), .name = name});
}

FinalBatch::Line* FinalBatch::find(std::size_t shot) {
    const auto found = std::ranges::find(lines_, shot, &Line::shot);
    return found == lines_.end() ? nullptr : &*found;
}

const FinalBatch::Line* FinalBatch::rendering() const {
    const auto found = std::ranges::find(lines_, State::renders, &Line::state);
    return found == lines_.end() ? nullptr : &*found;
}

std::optional<std::size_t> FinalBatch::next() {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(lines_, State::waits, &Line::state);
    if (found == lines_.end()) return std::nullopt;
    found->state = State::renders;
    return found->shot;
}

void FinalBatch::report(double done) {
    const std::lock_guard lock(mutex_);
    if (const Line* now = rendering()) find(now->shot)->done = done;
}

void FinalBatch::finish(State state) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(lines_, State::renders, &Line::state);
    if (found == lines_.end()) return; // cancelled meanwhile
    found->state = state;
    found->done = 1;
}

bool FinalBatch::cancelled() const {
    const std::lock_guard lock(mutex_);
    return !rendering();
}

bool FinalBatch::enough() const {
    const std::lock_guard lock(mutex_);
    const Line* now = rendering();
    return now && now->enough;
}

double FinalBatch::done() const {
    const std::lock_guard lock(mutex_);
    double sum = 0, count = 0;
    for (const Line& line : lines_)
        if (line.state != State::cancelled) {
            sum += line.done;
            count += 1;
        }
    return count > 0 ? sum / count : 1;
}

std::string FinalBatch::count() const {
    const std::lock_guard lock(mutex_);
    std::size_t through = 0, all = 0;
    for (const Line& line : lines_) {
        all += line.state != State::cancelled;
        through += line.state == State::done || line.state == State::failed;
    }
    return rendering() ? fmt::format("{} of {}, ", through + 1, all) : "";
}

std::vector<FinalBatch::Line> FinalBatch::lines() const {
    const std::lock_guard lock(mutex_);
    return lines_;
}

void FinalBatch::move(std::size_t shot, int by) {
    const std::lock_guard lock(mutex_);
    Line* from = find(shot);
    if (!from || from->state != State::waits) return;
    for (Line* to = from + by; to >= lines_.data() && to < lines_.data() + lines_.size(); to += by)
        if (to->state == State::waits) return std::swap(*from, *to);
}

void FinalBatch::put(std::size_t shot, std::size_t at) {
    const std::lock_guard lock(mutex_);
    Line *from = find(shot), *to = find(at);
    if (!from || !to || from->state != State::waits || to->state != State::waits) return;
    if (from < to)
        std::rotate(from, from + 1, to + 1);
    else
        std::rotate(to, from, from + 1);
}

void FinalBatch::cancel(std::size_t shot) {
    const std::lock_guard lock(mutex_);
    if (Line* line = find(shot); line && (line->state == State::waits || line->state == State::renders))
        line->state = State::cancelled;
}

void FinalBatch::finish_early(std::size_t shot) {
    const std::lock_guard lock(mutex_);
    if (Line* line = find(shot); line && line->state == State::renders) line->enough = true;
}

namespace {

std::string state_text(const FinalBatch::Line& line) {
    switch (line.state) {
        case FinalBatch::State::waits:
            return "waits";
        case FinalBatch::State::renders:
            return fmt::format("{:.0f} %", line.done * 100);
        case FinalBatch::State::done:
            return "done";
        case FinalBatch::State::cancelled:
            return "cancelled";
        case FinalBatch::State::failed:
            return "failed";
    }
    return "";
}

void buttons(PanelUi& e, FinalBatch& batch, const FinalBatch::Line& line, bool can_finish_early) {
    const bool waits = line.state == FinalBatch::State::waits, renders = line.state == FinalBatch::State::renders;
    if (waits) {
        if (ImGui::ArrowButton("up", ImGuiDir_Up)) batch.move(line.shot, -1);
        tip("Render it earlier");
        e.mark("batch.up." + line.name);
        ImGui::SameLine();
        if (ImGui::ArrowButton("down", ImGuiDir_Down)) batch.move(line.shot, 1);
        tip("Render it later");
        e.mark("batch.down." + line.name);
        ImGui::SameLine();
    } else if (renders && can_finish_early) {
        ImGui::BeginDisabled(line.done <= 0); // it has no samples
        if (ImGui::Button("Enough")) batch.finish_early(line.shot);
        ImGui::EndDisabled();
        tip("Write this picture as it is now, and go on with the next");
        e.mark("batch.enough");
        ImGui::SameLine();
    }
    if (!waits && !renders) return ImGui::Dummy({0, ImGui::GetFrameHeight()});
    if (icon_button("cancel", Icon::cross, true, "Leave it out")) batch.cancel(line.shot);
    e.mark("batch.cancel." + line.name);
}

constexpr const char* row_payload = "restage.batch";

// Those that wait are dragged to another place.
void name(PanelUi& e, FinalBatch& batch, const FinalBatch::Line& line) {
    if (line.state != FinalBatch::State::waits) {
        ImGui::TextUnformatted(line.name.c_str());
        return tip(line.name.c_str());
    }
    ImGui::Selectable(line.name.c_str());
    tip((line.name + ": drag it to another place in the order").c_str());
    e.mark("batch.row." + line.name);
    if (ImGui::BeginDragDropSource()) {
        ImGui::SetDragDropPayload(row_payload, &line.shot, sizeof line.shot);
        ImGui::TextUnformatted(line.name.c_str());
        ImGui::EndDragDropSource();
    }
    if (ImGui::BeginDragDropTarget()) {
        if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(row_payload))
            batch.put(*static_cast<const std::size_t*>(payload->Data), line.shot);
        ImGui::EndDragDropTarget();
    }
}

} // namespace

void draw_batch(PanelUi& e, FinalBatch& batch, bool can_finish_early) {
    const auto lines = batch.lines();
    constexpr std::size_t most_rows = 6;
    const float row = ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    const float height = row * float(std::min(lines.size(), most_rows));
    if (!ImGui::BeginTable("batch", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY, {0, height})) return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("state", ImGuiTableColumnFlags_WidthFixed, ImGui::CalcTextSize("cancelled").x);
    ImGui::TableSetupColumn("buttons", ImGuiTableColumnFlags_WidthFixed,
                            3 * ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().ItemSpacing.x);
    for (const FinalBatch::Line& line : lines) {
        ImGui::PushID(int(line.shot));
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::AlignTextToFramePadding();
        name(e, batch, line);
        ImGui::TableNextColumn();
        ImGui::AlignTextToFramePadding();
        const bool failed = line.state == FinalBatch::State::failed;
        ImGui::TextColored(failed ? colors::error : colors::dim, "%s", state_text(line).c_str());
        e.mark("batch.state." + line.name);
        ImGui::TableNextColumn();
        buttons(e, batch, line, can_finish_early);
        ImGui::PopID();
    }
    ImGui::EndTable();
}

} // namespace restage::editor
