// SPDX-License-Identifier: Apache-2.0
#include "gpu/includes.hpp"

#include "base/file.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

namespace restage::gpu {

namespace {

constexpr std::size_t max_depth = 64;

std::string_view trim(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// "include" of `  #  include "x"`, with the rest in `rest`.
std::string_view directive(std::string_view line, std::string_view& rest) {
    line = trim(line);
    if (line.empty() || line.front() != '#') return {};
    line = trim(line.substr(1));
    const auto end = std::min(line.find_first_of(" \t\"<("), line.size());
    rest = trim(line.substr(end));
    return line.substr(0, end);
}

// Follows /* */ over lines, so that a directive in a comment is none. True if the line starts inside a comment.
class CommentTracker {
  public:
    bool starts_inside(std::string_view line) {
        const bool started = inside_;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            if (inside_) {
                if (line[i] == '*' && line[i + 1] == '/') inside_ = false, ++i;
            } else if (line[i] == '/' && line[i + 1] == '/') {
                break;
            } else if (line[i] == '/' && line[i + 1] == '*') {
                inside_ = true, ++i;
            }
        }
        return started;
    }

  private:
    bool inside_ = false;
};

struct Found {
    std::string id; // the same for the same file, however it is spelled
    std::string name;
    std::string text;
    std::filesystem::path folder; // empty: in memory
};

class Expander {
  public:
    Expander(const ShaderSource& source, std::span<const std::filesystem::path> dirs) : source_(source), dirs_(dirs) {}

    ExpandedSource run() {
        ids_.push_back({});
        result_.names.push_back(source_.name);
        expand(source_.text, 0, {});
        return std::move(result_);
    }

  private:
    void expand(std::string_view text, std::size_t number, const std::filesystem::path& folder) {
        stack_.push_back(number);
        CommentTracker comments;
        std::size_t line_number = 0;
        while (!text.empty()) {
            const auto end = std::min(text.find('\n'), text.size());
            const std::string_view line = text.substr(0, end);
            text.remove_prefix(std::min(end + 1, text.size()));
            ++line_number;
            const bool comment = comments.starts_inside(line);
            std::string_view rest;
            const std::string_view word = comment ? std::string_view() : directive(line, rest);
            if (word == "include") {
                include(rest, folder);
                result_.text += "#line " + std::to_string(line_number + 1) + " " + std::to_string(number) + "\n";
            } else if (word == "pragma" && rest == "once") {
                result_.text += "\n"; // the wrapper around the file does it
            } else {
                result_.text += line;
                result_.text += '\n';
            }
        }
        stack_.pop_back();
    }

    void include(std::string_view rest, const std::filesystem::path& folder) {
        const char close = !rest.empty() && rest.front() == '<' ? '>' : '"';
        const auto end = rest.find(close, 1);
        if (rest.empty() || (rest.front() != '"' && rest.front() != '<') || end == std::string_view::npos)
            return error("#include needs a file name in quotes");
        const std::string name(rest.substr(1, end - 1));
        const std::optional<Found> file = find(name, folder);
        if (!file) return error("cannot find the file " + name + " to include");
        const std::size_t number = number_of(*file);
        const bool once = has_once(file->text);
        if (std::find(stack_.begin(), stack_.end(), number) != stack_.end()) {
            if (!once) error(name + " includes itself; put #pragma once into it");
            return;
        }
        if (stack_.size() >= max_depth) return error("#include nested more than 64 deep");
        const std::string guard = "RESTAGE_INCLUDED_" + std::to_string(number);
        if (once) result_.text += "#ifndef " + guard + "\n#define " + guard + "\n";
        result_.text += "#line 1 " + std::to_string(number) + "\n";
        expand(file->text, number, file->folder);
        if (once) result_.text += "#endif\n";
    }

    void error(const std::string& message) {
        result_.text += "#error RESTAGE_INCLUDE_ERROR_" + std::to_string(result_.errors.size()) + "_\n";
        result_.errors.push_back(message);
    }

    std::optional<Found> find(const std::string& name, const std::filesystem::path& folder) {
        if (const auto in_memory = source_.files.find(name); in_memory != source_.files.end())
            return Found{"memory:" + name, name, in_memory->second, {}};
        if (!folder.empty())
            if (auto file = load(folder / name)) return file;
        for (const auto& dir : source_.include_dirs)
            if (auto file = load(dir / name)) return file;
        for (const auto& dir : dirs_)
            if (auto file = load(dir / name)) return file;
        return {};
    }

    std::optional<Found> load(const std::filesystem::path& path) {
        std::error_code failed;
        if (source_.texts)
            if (const auto kept = source_.texts->find(path.lexically_normal()); kept != source_.texts->end())
                return Found{"kept:" + kept->first.string(), kept->first.string(), kept->second, path.parent_path()};
        if (!std::filesystem::is_regular_file(path, failed)) return {};
        std::filesystem::path real = std::filesystem::weakly_canonical(path, failed);
        if (failed) real = path;
        auto text = read_file(path);
        if (!text) return {};
        if (std::find(result_.files.begin(), result_.files.end(), real) == result_.files.end())
            result_.files.push_back(real);
        // Relative includes are relative to where the file was found, not to where a link points.
        return Found{"disk:" + real.string(), path.lexically_normal().string(), std::move(*text), path.parent_path()};
    }

    std::size_t number_of(const Found& file) {
        const auto known = std::find(ids_.begin(), ids_.end(), file.id);
        if (known != ids_.end()) return static_cast<std::size_t>(known - ids_.begin());
        ids_.push_back(file.id);
        result_.names.push_back(file.name);
        return ids_.size() - 1;
    }

    static bool has_once(std::string_view text) {
        CommentTracker comments;
        while (!text.empty()) {
            const auto end = std::min(text.find('\n'), text.size());
            std::string_view rest;
            const bool comment = comments.starts_inside(text.substr(0, end));
            if (!comment && directive(text.substr(0, end), rest) == "pragma" && rest == "once") return true;
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        return false;
    }

    const ShaderSource& source_;
    std::span<const std::filesystem::path> dirs_;
    ExpandedSource result_;
    std::vector<std::string> ids_; // by number
    std::vector<std::size_t> stack_;
};

} // namespace

ExpandedSource expand_includes(const ShaderSource& source, std::span<const std::filesystem::path> include_dirs) {
    return Expander(source, include_dirs).run();
}

} // namespace restage::gpu
