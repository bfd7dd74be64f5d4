// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include "base/file.hpp"
#include "base/json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace restage::editor {

namespace {

constexpr std::size_t most = 12;

void put_first(std::vector<std::string>& list, const std::filesystem::path& path) {
    const std::string text = std::filesystem::absolute(path).lexically_normal().string();
    std::erase(list, text);
    list.insert(list.begin(), text);
    if (list.size() > most) list.resize(most);
}

} // namespace

Recent::Recent(std::filesystem::path file) : file_(std::move(file)) {
    const auto text = read_file(file_);
    const auto j = text ? parse_json<nlohmann::json>(*text).value_or(nlohmann::json()) : nlohmann::json();
    const auto take = [&](const char* name, std::vector<std::string>& list) {
        if (!j.is_object() || !j.contains(name) || !j[name].is_array()) return;
        for (const auto& item : j[name])
            if (item.is_string()) list.push_back(item.get<std::string>());
    };
    take("files", files_);
    take("folders", folders_);
}

void Recent::add_file(const std::filesystem::path& path) {
    put_first(files_, path);
    put_first(folders_, std::filesystem::absolute(path).parent_path());
    save();
}

void Recent::add_folder(const std::filesystem::path& path) {
    put_first(folders_, path);
    save();
}

void Recent::clear() {
    files_.clear();
    save();
}

void Recent::save() const {
    if (file_.empty()) return;
    const nlohmann::json j{{"files", files_}, {"folders", folders_}};
    // Failing to save the list is not worth a message.
    (void)write_file_atomic(file_, j.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

} // namespace restage::editor
