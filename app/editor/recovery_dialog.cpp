// SPDX-License-Identifier: Apache-2.0
#include "recovery_dialog.hpp"

#include "editor.hpp"
#include "files.hpp"
#include "saving.hpp"
#include "widgets.hpp"

#include <imgui.h>
#include <algorithm>

namespace restage::editor {

void offer_recovery(Editor& e) {
    auto found =
        std::make_shared<std::vector<document::Recoverable>>(document::find_recoverable(e.files().recovery_folder));
    if (found->empty()) return;
    e.show_modal("Unsaved work was found", [found](Editor& editor) {
        dialog_width(560);
        ImGui::TextWrapped("Restage ended before this was saved. It can be opened as it was.");
        ImGui::Spacing();
        bool stay = true;
        std::size_t gone = found->size();
        const float scale = ImGui::GetStyle().FontScaleMain;
        if (ImGui::BeginTable("found", 4,
                              ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_SizingFixedFit)) {
            ImGui::TableSetupColumn("Scene", ImGuiTableColumnFlags_WidthStretch);
            ImGui::TableSetupColumn("Written aside", ImGuiTableColumnFlags_WidthFixed, 130 * scale);
            ImGui::TableSetupColumn("Changes", ImGuiTableColumnFlags_WidthFixed, 60 * scale);
            ImGui::TableSetupColumn("");
            ImGui::TableHeadersRow();
            for (std::size_t i = 0; i < found->size(); ++i) {
                const document::Recoverable& what = (*found)[i];
                ImGui::PushID(int(i));
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::AlignTextToFramePadding();
                ImGui::TextUnformatted(what.name.c_str());
                if (!what.base.empty()) ImGui::SetItemTooltip("%s", what.base.c_str());
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(what.time.c_str());
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(what.changes.c_str());
                ImGui::TableNextColumn();
                if (ImGui::Button("Recover")) {
                    stay = false;
                    editor.later([&editor, file = what.file] {
                        ask_unsaved(editor, "recovering another scene", [file](Editor& x) {
                            x.open_now({.path = file, .purpose = Opening::Purpose::recover});
                        });
                    });
                }
                if (i == 0) editor.mark("recovery.recover");
                ImGui::SameLine();
                if (ImGui::Button("Discard")) gone = i;
                if (i == 0) editor.mark("recovery.discard");
                ImGui::PopID();
            }
            ImGui::EndTable();
        }
        if (gone < found->size()) {
            document::discard_recoverable((*found)[gone]);
            found->erase(found->begin() + std::ptrdiff_t(gone));
            stay = stay && !found->empty();
        }
        ImGui::Spacing();
        if (ImGui::Button("Later") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        ImGui::SetItemTooltip("It is offered again at the next start");
        editor.mark("recovery.later");
        return stay;
    });
}

} // namespace restage::editor
