// SPDX-License-Identifier: Apache-2.0
#include "file_browser.hpp"

#include "dialog_keys.hpp"
#include "files.hpp"
#include "panel_context.hpp"
#include "scene_pictures.hpp"
#include "theme.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <thread>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

// --- file system queries, each on its own thread
// -----------------------------------------------------------

template <class T>
struct Asked {
    std::atomic<bool> done = false;
    T answer; // set when done
};

template <class T, class F>
std::shared_ptr<Asked<T>> ask(const std::function<void()>& wake, F&& f) {
    auto asked = std::make_shared<Asked<T>>();
    // Detached: it may never return, and owns only its arguments.
    std::thread([asked, wake, f = std::forward<F>(f)] {
        asked->answer = f();
        asked->done = true;
        if (wake) wake();
    }).detach();
    return asked;
}

struct Listing {
    fs::path folder;
    std::vector<FileEntry> entries;
    std::string problem;
};

Listing list_folder(const fs::path& folder, const std::string& make) {
    Listing result{folder, {}, {}};
    std::error_code code;
    if (!make.empty() && !fs::create_directory(folder / make, code) && code) {
        result.problem = make + " cannot be created: " + code.message();
        return result;
    }
    if (!make.empty()) result.folder = folder / make;
    fs::directory_iterator it(result.folder, fs::directory_options::skip_permission_denied, code);
    if (code) result.problem = code.message();
    for (; !code && it != fs::directory_iterator(); it.increment(code)) {
        std::error_code none;
        FileEntry entry{
            .name = it->path().filename().string(), .folder = it->is_directory(none), .size = 0, .time = {}};
        if (!entry.folder) entry.size = it->file_size(none);
        if (none) entry.size = 0;
        entry.time = it->last_write_time(none);
        result.entries.push_back(std::move(entry));
    }
    return result;
}

enum class Kind { nothing, file, folder };
Kind kind_of(const fs::path& path) {
    std::error_code none;
    const auto status = fs::status(path, none);
    return fs::is_directory(status) ? Kind::folder : fs::exists(status) ? Kind::file : Kind::nothing;
}

std::string lower(std::string text) {
    for (char& c : text)
        c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string size_text(std::uintmax_t bytes) {
    if (bytes < 1024) return fmt::format("{} B", bytes);
    if (bytes < 1024 * 1024) return fmt::format("{:.0f} kB", double(bytes) / 1024);
    if (bytes < 1024ull * 1024 * 1024) return fmt::format("{:.1f} MB", double(bytes) / (1024 * 1024));
    return fmt::format("{:.1f} GB", double(bytes) / (1024.0 * 1024 * 1024));
}

std::string time_text(fs::file_time_type time) {
    const auto system = std::chrono::time_point_cast<std::chrono::seconds>(time - fs::file_time_type::clock::now() +
                                                                           std::chrono::system_clock::now());
    return fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(std::chrono::system_clock::to_time_t(system)));
}

fs::path home() {
    const char* place = std::getenv("HOME");
    return place && *place ? fs::path(place) : fs::path("/");
}

// --- the browser
// ---------------------------------------------------------------------------------------------------------

class Browser {
  public:
    Browser(EditContext& e, BrowseOptions options)
        : options_(std::move(options)), wake_(e.options().wake), typed_(options_.name) {
        const auto& folders = e.files().recent.folders();
        std::error_code none;
        go(!options_.start.empty() ? options_.start : !folders.empty() ? fs::path(folders[0]) : fs::current_path(none));
        typed_ = options_.name;
    }

    bool draw(PanelContext& e); // false = closed

  private:
    void go(const fs::path& folder, const std::string& make = {});
    void accept(const fs::path& path);
    bool act(PanelContext& e); // with the result of accept(); true = chosen
    std::string select(int step); // the name selected then
    void update_shown();
    bool fits(const FileEntry& entry) const;
    void draw_places(PanelContext& e, float height);
    void draw_list(PanelContext& e, float height);
    void draw_name(PanelContext& e);
    void draw_details(PanelContext& e);
    bool draw_buttons(PanelContext& e);
    static int on_key(ImGuiInputTextCallbackData* data);

    BrowseOptions options_;
    std::function<void()> wake_;
    fs::path folder_;
    std::shared_ptr<Asked<Listing>> listing_;
    const Listing* drawn_ = nullptr; // what shown_ was built from
    std::vector<const FileEntry*> shown_;
    std::string shown_filter_;
    int sort_column_ = 0;
    bool sort_down_ = false, hidden_ = false, resort_ = false;
    std::size_t filter_ = 0;
    int selected_ = -1;
    bool scroll_ = false;
    std::string typed_, folder_text_, new_folder_, problem_;
    bool use_folder_ = false; // accept() is final if it is a folder
    bool naming_folder_ = false, focus_folder_ = false, focus_name_ = true;
    bool list_open_ = false; // see dialog_escape
    std::unique_ptr<KeyNavigation> navigation_; // once the details have the keyboard
    float details_height_ = 0;
    fs::path asked_path_;
    std::shared_ptr<Asked<Kind>> asked_kind_;
    fs::path replace_; // asks whether this file may be replaced
};

void Browser::go(const fs::path& folder, const std::string& make) {
    folder_ = folder.lexically_normal();
    if (!make.empty()) folder_ /= make;
    if (folder_.has_relative_path() && !folder_.has_filename()) folder_ = folder_.parent_path(); // "a/b/"
    folder_text_ = folder_.string();
    listing_ =
        ask<Listing>(wake_, [folder = make.empty() ? folder_ : folder, make] { return list_folder(folder, make); });
    drawn_ = nullptr;
    shown_.clear();
    selected_ = -1;
    problem_.clear();
    ImGui::ClearActiveID(); // a field keeps its text while it is edited
    if (!options_.save) typed_.clear();
    focus_name_ = true;
}

bool Browser::fits(const FileEntry& entry) const {
    if (!hidden_ && entry.name.starts_with('.')) return false;
    if (options_.folder) return entry.folder;
    if (entry.folder || options_.filters.empty()) return true;
    const auto& extensions = options_.filters[filter_].extensions;
    std::string extension = lower(fs::path(entry.name).extension().string());
    if (!extension.empty()) extension.erase(0, 1);
    return extensions.empty() || std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

void Browser::update_shown() {
    if (!listing_->done) return;
    const std::string filter = fmt::format("{}{}", filter_, hidden_);
    if (drawn_ == &listing_->answer && shown_filter_ == filter && !resort_) return;
    const std::string chosen =
        selected_ >= 0 && selected_ < int(shown_.size()) ? shown_[std::size_t(selected_)]->name : "";
    drawn_ = &listing_->answer;
    shown_filter_ = filter;
    resort_ = false;
    shown_.clear();
    for (const FileEntry& entry : drawn_->entries)
        if (fits(entry)) shown_.push_back(&entry);
    std::sort(shown_.begin(), shown_.end(), [&](const FileEntry* a, const FileEntry* b) {
        if (a->folder != b->folder) return a->folder;
        const bool down = sort_down_;
        if (down) std::swap(a, b);
        if (sort_column_ == 1 && a->size != b->size) return a->size < b->size;
        if (sort_column_ == 2 && a->time != b->time) return a->time < b->time;
        const std::string la = lower(a->name), lb = lower(b->name);
        return la != lb ? la < lb : a->name < b->name;
    });
    selected_ = -1;
    for (std::size_t i = 0; i < shown_.size(); ++i)
        if (shown_[i]->name == chosen) selected_ = int(i);
    if (!drawn_->problem.empty()) problem_ = drawn_->problem;
}

std::string Browser::select(int step) {
    if (shown_.empty()) return "";
    selected_ = selected_ < 0 ? (step > 0 ? 0 : int(shown_.size()) - 1)
                              : std::clamp(selected_ + step, 0, int(shown_.size()) - 1);
    scroll_ = true;
    return shown_[std::size_t(selected_)]->name;
}

void Browser::accept(const fs::path& path) {
    if (path.empty()) return;
    asked_path_ = path.is_absolute() ? path : folder_ / path;
    if (path.string().starts_with("~/")) asked_path_ = home() / path.string().substr(2);
    asked_path_ = asked_path_.lexically_normal();
    problem_.clear();
    asked_kind_ = ask<Kind>(wake_, [path = asked_path_] { return kind_of(path); });
}

bool Browser::act(PanelContext& e) {
    if (!asked_kind_ || !asked_kind_->done) return false;
    const Kind kind = asked_kind_->answer;
    asked_kind_.reset();
    focus_name_ = true;
    if (std::exchange(use_folder_, false) && kind == Kind::folder) {
        e.files().recent.add_folder(asked_path_);
        e.later([&e, done = options_.done, path = asked_path_] { done(e, path); });
        return true;
    }
    if (kind == Kind::folder) {
        go(asked_path_);
        typed_ = options_.save ? fs::path(options_.name).filename().string() : "";
        return false;
    }
    if (!options_.save && kind == Kind::nothing) {
        problem_ = asked_path_.string() + " does not exist";
        return false;
    }
    if (options_.folder) {
        problem_ = asked_path_.string() + " is not a folder";
        return false;
    }
    if (options_.save) {
        if (!asked_path_.has_extension() && !options_.extension.empty()) {
            asked_path_ += options_.extension;
            accept(asked_path_); // whether that one exists
            return false;
        }
        if (kind == Kind::file && replace_ != asked_path_) {
            replace_ = asked_path_;
            return false;
        }
    }
    e.files().recent.add_folder(asked_path_.parent_path());
    e.later([&e, done = options_.done, path = asked_path_] { done(e, path); });
    return true;
}

int Browser::on_key(ImGuiInputTextCallbackData* data) {
    auto& self = *static_cast<Browser*>(data->UserData); // its typed_ is in use by the widget
    if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion && self.drawn_) {
        std::vector<FileEntry> fitting;
        for (const FileEntry* entry : self.shown_)
            fitting.push_back(*entry);
        const std::string more = completion(data->Buf, fitting);
        data->InsertChars(data->BufTextLen, more.c_str());
        if (more.ends_with('/')) self.accept(data->Buf); // into the folder
    }
    if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory) {
        const std::string name = self.select(data->EventKey == ImGuiKey_DownArrow ? 1 : -1);
        data->DeleteChars(0, data->BufTextLen);
        data->InsertChars(0, name.c_str());
    }
    return 0;
}

void Browser::draw_places(PanelContext& e, float height) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    ImGui::BeginChild("places", {170 * scale, height}, ImGuiChildFlags_Borders);
    std::error_code none;
    const auto place = [&](const std::string& label, const fs::path& path) {
        if (ImGui::Selectable((label + "##" + path.string()).c_str(), path == folder_)) go(path);
        ImGui::SetItemTooltip("%s", path.string().c_str());
    };
    place("Home", home());
    e.mark("browser.home");
    place("Computer", "/");
    place("Current folder", fs::current_path(none));
    ImGui::Spacing();
    ImGui::TextColored(colors::dim, "Recent");
    for (const std::string& folder : e.files().recent.folders()) {
        const fs::path path(folder);
        place(path.filename().empty() ? folder : path.filename().string(), path);
    }
    if (selected_ >= 0 && selected_ < int(shown_.size()) && !options_.folder) { // as it was last seen in the editor
        const FileEntry& entry = *shown_[std::size_t(selected_)];
        const float side = ImGui::GetContentRegionAvail().x;
        ImGui::SetCursorPosY(
            std::max(ImGui::GetCursorPosY(), ImGui::GetCursorPosY() + ImGui::GetContentRegionAvail().y - side));
        if (!entry.folder) draw_scene_picture(e, folder_ / entry.name, side, "browser.picture", entry.time);
    }
    ImGui::EndChild();
}

void Browser::draw_list(PanelContext& e, float height) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    if (!ImGui::BeginTable("files", 3,
                           ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_Sortable |
                               ImGuiTableFlags_Resizable | ImGuiTableFlags_BordersOuter,
                           {0, height}))
        return;
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("Name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("Size", ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_PreferSortDescending,
                            80 * scale);
    ImGui::TableSetupColumn("Changed", ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_PreferSortDescending,
                            135 * scale);
    ImGui::TableHeadersRow();
    if (ImGuiTableSortSpecs* sort = ImGui::TableGetSortSpecs(); sort && sort->SpecsDirty && sort->SpecsCount > 0) {
        sort_column_ = sort->Specs[0].ColumnIndex;
        sort_down_ = sort->Specs[0].SortDirection == ImGuiSortDirection_Descending;
        sort->SpecsDirty = false;
        resort_ = true;
    }
    update_shown();
    if (!listing_->done) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextColored(colors::dim, "Looking...");
    }
    ImGuiListClipper clipper;
    clipper.Begin(int(shown_.size()));
    if (scroll_ && selected_ >= 0) clipper.IncludeItemByIndex(selected_);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd && i < int(shown_.size()); ++i) {
            const FileEntry& entry = *shown_[std::size_t(i)];
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::PushID(i);
            if (entry.folder) ImGui::PushStyleColor(ImGuiCol_Text, colors::hover);
            const std::string label = entry.folder ? entry.name + "/" : entry.name;
            if (ImGui::Selectable(label.c_str(), i == selected_,
                                  ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick)) {
                selected_ = i;
                if (!entry.folder || !options_.save) typed_ = entry.name;
                if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) accept(folder_ / entry.name);
            }
            if (entry.folder) ImGui::PopStyleColor();
            e.mark("browser.file." + entry.name);
            if (scroll_ && i == selected_) {
                ImGui::SetScrollHereY(0.5f);
                scroll_ = false;
            }
            ImGui::TableNextColumn();
            if (!entry.folder) ImGui::TextUnformatted(size_text(entry.size).c_str());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(time_text(entry.time).c_str());
            ImGui::PopID();
        }
    ImGui::EndTable();
}

void Browser::draw_name(PanelContext& e) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(options_.save ? "Name" : options_.folder ? "Folder" : "File");
    ImGui::SameLine();
    const float scale = ImGui::GetStyle().FontScaleMain;
    ImGui::SetNextItemWidth(options_.filters.empty() ? -1 : -190 * scale);
    if (std::exchange(focus_name_, false)) ImGui::SetKeyboardFocusHere();
    if (ImGui::InputTextWithHint("##name", "Type a name or a path; Tab completes", &typed_,
                                 ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion |
                                     ImGuiInputTextFlags_CallbackHistory,
                                 on_key, this))
        accept(typed_); // the field regains the keyboard when the result arrives
    e.mark("browser.name");
    if (options_.filters.empty()) return;
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##filter", options_.filters[filter_].label.c_str())) {
        for (std::size_t i = 0; i < options_.filters.size(); ++i)
            if (ImGui::Selectable(options_.filters[i].label.c_str(), i == filter_)) filter_ = i;
        ImGui::EndCombo();
    }
}

void Browser::draw_details(PanelContext& e) {
    if (!options_.details) return;
    const float top = ImGui::GetCursorPosY();
    const bool focus = ImGui::IsKeyChordPressed(ImGuiMod_Alt | ImGuiKey_O);
    if (focus && !navigation_) navigation_ = std::make_unique<KeyNavigation>();
    options_.details(e, typed_, focus);
    details_height_ = ImGui::GetCursorPosY() - top;
}

bool Browser::draw_buttons(PanelContext& e) {
    const bool escape = dialog_escape(list_open_);
    if (!replace_.empty()) {
        ImGui::TextColored(colors::warning, "%s exists already.", replace_.filename().string().c_str());
        ImGui::SameLine();
        if (ImGui::Button("Replace it")) accept(replace_);
        e.mark("browser.replace");
        ImGui::SameLine();
        if (ImGui::Button("Keep it") || escape) {
            replace_.clear();
            focus_name_ = true;
        }
        e.mark("browser.keep");
        return true;
    }
    ImGui::BeginDisabled((typed_.empty() && !options_.folder) || (asked_kind_ && !asked_kind_->done));
    if (ImGui::Button(options_.folder ? "Use this folder" : options_.save ? "Save" : "Open")) {
        use_folder_ = options_.folder;
        accept(typed_.empty() ? folder_ : fs::path(typed_));
    }
    e.mark("browser.accept");
    ImGui::EndDisabled();
    ImGui::SameLine();
    bool stay = !ImGui::Button("Cancel");
    e.mark("browser.cancel");
    ImGui::SameLine();
    ImGui::Checkbox("Hidden files", &hidden_);
    ImGui::SetItemTooltip("Show files whose names begin with a dot (Ctrl+H)");
    if (ImGui::IsKeyChordPressed(ImGuiMod_Ctrl | ImGuiKey_H)) hidden_ = !hidden_;
    if (options_.save) {
        ImGui::SameLine();
        if (!naming_folder_) {
            if (ImGui::Button("New folder")) naming_folder_ = focus_folder_ = true;
            e.mark("browser.new_folder");
        } else {
            ImGui::SetNextItemWidth(160 * ImGui::GetStyle().FontScaleMain);
            if (std::exchange(focus_folder_, false)) ImGui::SetKeyboardFocusHere();
            if (ImGui::InputTextWithHint("##new folder", "Type its name, then press Enter", &new_folder_,
                                         ImGuiInputTextFlags_EnterReturnsTrue) &&
                !new_folder_.empty()) {
                go(folder_, new_folder_);
                new_folder_.clear();
                naming_folder_ = false;
            }
            e.mark("browser.new_folder_name");
        }
    }
    if (escape) {
        if (naming_folder_)
            naming_folder_ = false;
        else
            stay = false;
    }
    return stay;
}

bool Browser::draw(PanelContext& e) {
    const bool chosen = act(e); // its last frame is drawn like the others
    const float scale = ImGui::GetStyle().FontScaleMain;
    const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
    const ImVec2 size(std::min(820 * scale, room.x - 60 * scale), std::min(480 * scale, room.y - 80 * scale));
    ImGui::Dummy({size.x, 0});

    if (ImGui::Button("Up")) go(folder_.parent_path());
    e.mark("browser.up");
    ImGui::SetItemTooltip("The parent folder (Alt+Up)");
    if (ImGui::IsKeyChordPressed(ImGuiMod_Alt | ImGuiKey_UpArrow)) go(folder_.parent_path());
    ImGui::SameLine();
    ImGui::SetNextItemWidth(size.x - ImGui::GetCursorPosX());
    if (ImGui::InputText("##folder", &folder_text_, ImGuiInputTextFlags_EnterReturnsTrue)) accept(folder_text_);
    e.mark("browser.folder");

    const float below = 2 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetTextLineHeightWithSpacing();
    const float height = std::max(size.y - below - ImGui::GetFrameHeightWithSpacing() - details_height_, 80 * scale);
    draw_places(e, height);
    ImGui::SameLine();
    draw_list(e, height);
    draw_name(e);
    draw_details(e);
    ImGui::TextColored(colors::warning, "%s", problem_.c_str());
    return draw_buttons(e) && !chosen;
}

} // namespace

std::string completion(const std::string& typed, const std::vector<FileEntry>& names) {
    const FileEntry* first = nullptr;
    std::string common;
    bool one = true;
    for (const FileEntry& entry : names) {
        if (!entry.name.starts_with(typed)) continue;
        if (!first) {
            first = &entry;
            common = entry.name;
            continue;
        }
        one = false;
        std::size_t same = 0;
        while (same < std::min(common.size(), entry.name.size()) && common[same] == entry.name[same])
            ++same;
        common.resize(same);
    }
    if (!first) return "";
    return common.substr(typed.size()) + (one && first->folder ? "/" : "");
}

void browse(EditContext& editor, BrowseOptions options) {
    const std::string title = options.title;
    auto browser = std::make_shared<Browser>(editor, std::move(options));
    editor.show_modal(title, [browser](PanelContext& e) { return browser->draw(e); });
}

} // namespace restage::editor
