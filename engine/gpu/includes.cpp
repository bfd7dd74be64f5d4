// SPDX-License-Identifier: Apache-2.0
#include "gpu/includes.hpp"

#include "base/file.hpp"

#include <algorithm>
#include <charconv>
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

// Tracks /* */ across lines, so that directives in comments do not count. True if the line starts inside a comment.
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
    std::string id; // identical for the same file, however spelled
    std::string name;
    std::string text;
    std::filesystem::path folder; // empty: in memory
    std::filesystem::path plugin; // the plugin's folder that it is of; empty: the host's
};

constexpr std::string_view library = "restage/v1/";
constexpr std::string_view plugin_prefix = "plugin"; // <plugin/file>, <plugin:1/file>
constexpr const char* plugin_rule = "a plugin's GLSL may include <restage/v1/...> and files of its own folder";

bool is_word(char c) { return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// The first word of a line forbidden in a plugin's GLSL, comments aside: words that declare or access memory, and
// built-in variables, which depend on the surrounding kernel.
std::string_view forbidden_word(std::string_view line, bool inside_comment) {
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (inside_comment) {
            inside_comment = line.substr(i, 2) != "*/";
            if (!inside_comment) ++i;
        } else if (line.substr(i, 2) == "//") {
            break;
        } else if (line.substr(i, 2) == "/*") {
            inside_comment = true;
            ++i;
        } else if (is_word(line[i])) {
            std::size_t end = i;
            while (end < line.size() && is_word(line[end]))
                ++end;
            const std::string_view word = line.substr(i, end - i);
            for (const std::string_view bad : {"layout", "uniform", "buffer", "shared"})
                if (word == bad) return word;
            if (word.starts_with("gl_")) return word;
            i = end - 1;
        }
    }
    return {};
}

class Expander {
  public:
    Expander(const ShaderSource& source, std::span<const std::filesystem::path> dirs) : source_(source), dirs_(dirs) {}

    ExpandedSource run() {
        ids_.push_back({});
        result_.names.push_back(source_.name);
        expand(source_.text, 0, {}, {});
        return std::move(result_);
    }

  private:
    void expand(std::string_view text, std::size_t number, const std::filesystem::path& folder,
                const std::filesystem::path& its_plugin) {
        const bool plugin = !its_plugin.empty();
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
                include(rest, folder, its_plugin);
                result_.text += "#line " + std::to_string(line_number + 1) + " " + std::to_string(number) + "\n";
            } else if (word == "pragma" && rest == "once") {
                result_.text += "\n"; // handled by the wrapper around the file
            } else if (plugin && word == "extension") {
                error("a plugin's GLSL cannot enable extensions");
            } else if (const auto bad = plugin ? forbidden_word(line, comment) : std::string_view(); !bad.empty()) {
                error("\"" + std::string(bad) +
                      "\": a plugin's GLSL has no bindings, buffers, shared memory or built-in " +
                      "variables; its only inputs are the arguments of its functions");
            } else {
                result_.text += line;
                result_.text += '\n';
            }
        }
        stack_.pop_back();
    }

    void include(std::string_view rest, const std::filesystem::path& folder, const std::filesystem::path& its_plugin) {
        const bool plugin = !its_plugin.empty();
        const char close = !rest.empty() && rest.front() == '<' ? '>' : '"';
        const auto end = rest.find(close, 1);
        if (rest.empty() || (rest.front() != '"' && rest.front() != '<') || end == std::string_view::npos)
            return error("#include needs a file name in quotes");
        const std::string name(rest.substr(1, end - 1));
        const std::optional<Found> file = plugin         ? find_for_plugin(name, close == '>', folder, its_plugin)
                                          : close == '>' ? find_angled(name)
                                                         : find(name, folder);
        if (!file)
            return error(plugin ? why_not_for_plugin(name, close == '>')
                                : "cannot find the file " + name + " to include");
        const std::size_t number = number_of(*file);
        const bool once = has_once(file->text);
        if (std::find(stack_.begin(), stack_.end(), number) != stack_.end()) {
            if (!once) error(name + " includes itself; add #pragma once to it");
            return;
        }
        if (stack_.size() >= max_depth) return error("#include nested more than 64 deep");
        const std::string guard = "RESTAGE_INCLUDED_" + std::to_string(number);
        if (once) result_.text += "#ifndef " + guard + "\n#define " + guard + "\n";
        result_.text += "#line 1 " + std::to_string(number) + "\n";
        expand(file->text, number, file->folder, file->plugin);
        if (once) result_.text += "#endif\n";
    }

    void error(const std::string& message) {
        result_.text += "#error RESTAGE_SOURCE_ERROR_" + std::to_string(result_.errors.size()) + "_\n";
        result_.errors.push_back(message);
    }

    std::optional<Found> find(const std::string& name, const std::filesystem::path& folder) {
        if (const auto in_memory = source_.files.find(name); in_memory != source_.files.end())
            return Found{"memory:" + name, name, in_memory->second, {}, {}};
        if (!folder.empty())
            if (auto file = load(folder / name)) return file;
        for (const auto& dir : source_.include_dirs)
            if (auto file = load(dir / name)) return file;
        for (const auto& dir : dirs_)
            if (auto file = load(dir / name)) return file;
        return {};
    }

    // <plugin/...>, <plugin:1/...>: of that plugin's folder, and nowhere else.
    std::optional<Found> find_angled(const std::string& name) {
        const std::size_t slash = name.find('/');
        if (!name.starts_with(plugin_prefix) || slash == std::string::npos) return find(name, {});
        const std::string which = name.substr(plugin_prefix.size(), slash - plugin_prefix.size());
        std::size_t i = 0;
        if (which.size() > 1 && which[0] == ':')
            std::from_chars(which.data() + 1, which.data() + which.size(), i);
        else if (!which.empty())
            return find(name, {});
        if (i >= source_.plugin_folders.size()) return {};
        return load_plugin(source_.plugin_folders[i] / name.substr(slash + 1), source_.plugin_folders[i]);
    }

    std::optional<Found> find_for_plugin(const std::string& name, bool angled, const std::filesystem::path& folder,
                                         const std::filesystem::path& plugin) {
        if (!angled) {
            if (auto file = load_plugin(folder / name, plugin)) return file;
            return load_plugin(plugin / name, plugin);
        }
        if (!name.starts_with(library) || name.find("..") != std::string::npos) return {};
        for (const auto& dir : dirs_)
            if (auto file = load(dir / name)) return file;
        return {};
    }

    std::string why_not_for_plugin(const std::string& name, bool angled) {
        const std::string cannot = "cannot include " + (angled ? "<" + name + ">" : "\"" + name + "\"") + ": ";
        const std::string here = std::string(library) + std::filesystem::path(name).filename().string();
        for (const auto& dir : dirs_) { // its place before versioning
            std::error_code failed;
            if (std::filesystem::is_regular_file(dir / here, failed)) return cannot + "write <" + here + ">";
        }
        return cannot + (angled && name.starts_with(library) ? "there is no such file; " : "") + plugin_rule;
    }

    // Null if the path leaves the plugin's folder.
    std::optional<Found> load_plugin(const std::filesystem::path& path, const std::filesystem::path& plugin) {
        const auto within = path.lexically_normal().lexically_relative(plugin.lexically_normal());
        if (within.empty() || *within.begin() == "..") return {};
        auto file = load(path);
        if (file) file->plugin = plugin;
        return file;
    }

    std::optional<Found> load(const std::filesystem::path& path) {
        std::error_code failed;
        for (const auto& texts : source_.texts) {
            if (!texts) continue;
            if (const auto kept = texts->find(path.lexically_normal()); kept != texts->end())
                return Found{
                    "kept:" + kept->first.string(), kept->first.string(), kept->second, path.parent_path(), {}};
        }
        if (!std::filesystem::is_regular_file(path, failed)) return {};
        std::filesystem::path real = std::filesystem::weakly_canonical(path, failed);
        if (failed) real = path;
        auto text = read_file(path);
        if (!text) return {};
        if (std::find(result_.files.begin(), result_.files.end(), real) == result_.files.end())
            result_.files.push_back(real);
        // Relative includes are relative to where the file was found, not to where a link points.
        return Found{
            "disk:" + real.string(), path.lexically_normal().string(), std::move(*text), path.parent_path(), {}};
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
