// SPDX-License-Identifier: Apache-2.0
#include "common/output.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#if !defined(_WIN32)
#include <unistd.h>
#endif

namespace restage::exporters {

namespace fs = std::filesystem;

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

} // namespace

Output::Output(const fs::path& scene_file) {
    std::error_code code;
    scene_file_ = fs::absolute(scene_file, code).lexically_normal();
    folder_ = scene_file_.parent_path();
    if (code || !fs::is_directory(folder_, code))
        throw ExportError(scene_file.string(), "there is no folder " + folder_.string() + " to write into");
    taken_.insert(lower(scene_file_.filename().string()));
}

Output::~Output() {
    std::error_code ignored;
    for (const Staged& file : staged_)
        fs::remove(file.temporary, ignored);
    for (auto it = made_folders_.rbegin(); it != made_folders_.rend(); ++it)
        fs::remove(*it, ignored); // only when empty
}

std::string Output::unique_file(const std::string& folder, const std::string& stem, const std::string& extension) {
    std::string base = folder + "/" + (stem.empty() ? "unnamed" : stem), name = base + extension;
    for (unsigned i = 2; !taken_.insert(lower(name)).second; ++i)
        name = base + "_" + std::to_string(i) + extension;
    return name;
}

bool Output::has(const std::string& relative) const {
    std::error_code code;
    return taken_.contains(lower(relative)) || fs::is_regular_file(folder_ / relative, code);
}

fs::path Output::stage(const std::string& relative) {
    const fs::path target = folder_ / relative;
    std::error_code code;
    if (const fs::file_status kind = fs::status(target, code); fs::exists(kind) && !fs::is_regular_file(kind))
        throw ExportError(target.string(), fs::is_directory(kind) ? "is a folder, not a regular file"
                                                                  : "is a pipe or a device, not a regular file");
    if (const fs::path parent = target.parent_path(); !fs::exists(parent, code)) {
        fs::create_directory(parent, code);
        if (code) throw ExportError(parent.string(), "cannot be created: " + code.message());
        made_folders_.push_back(parent);
    }
    fs::path temporary = target;
    temporary += ".tmp";
#if !defined(_WIN32)
    temporary += std::to_string(getpid());
#endif
    staged_.push_back({temporary, target});
    return temporary;
}

void Output::write(const std::string& relative, std::string_view bytes) {
    const fs::path temporary = stage(relative);
#if defined(_WIN32)
    std::FILE* file = std::fopen(temporary.string().c_str(), "wb");
#else
    std::FILE* file = std::fopen(temporary.string().c_str(), "wbe"); // e: closed in children
#endif
    const auto failed = [&]() -> ExportError {
        return ExportError((folder_ / relative).string(), std::string("cannot be written: ") + std::strerror(errno));
    };
    if (!file) throw failed();
    bool good = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
#if !defined(_WIN32)
    good = good && fsync(fileno(file)) == 0;
#endif
    if (!good) {
        const ExportError error = failed();
        std::fclose(file);
        throw error;
    }
    if (std::fclose(file) != 0) throw failed();
}

void Output::copy(const fs::path& from, const std::string& relative) {
    const fs::path temporary = stage(relative);
    std::error_code code;
    fs::copy_file(from, temporary, fs::copy_options::overwrite_existing, code);
    if (code)
        throw ExportError(from.string(),
                          "cannot be copied to " + (folder_ / relative).string() + ": " + code.message());
}

std::string Output::inside(const fs::path& file) const {
    std::error_code code;
    const fs::path relative = fs::weakly_canonical(file, code).lexically_relative(fs::weakly_canonical(folder_, code));
    if (code || relative.empty() || *relative.begin() == ".." || relative == ".") return "";
    return relative.generic_string();
}

void Output::commit() {
    // All staged files are complete on disk; the scene file goes last, so that it never names a missing file.
    std::stable_partition(staged_.begin(), staged_.end(), [&](const Staged& s) { return s.target != scene_file_; });
    std::error_code code;
    for (const Staged& file : staged_) {
        fs::rename(file.temporary, file.target, code);
        if (code) throw ExportError(file.target.string(), "cannot be replaced: " + code.message());
    }
    staged_.clear();
    made_folders_.clear();
}

} // namespace restage::exporters
