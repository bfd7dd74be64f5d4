// SPDX-License-Identifier: Apache-2.0
// The stages of an import: bytes, statements, materials, shapes, a camera and a light.
#include "load.hpp"

#include "common/file.hpp"
#include "common/stage.hpp"
#include "importer.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>
#include <sstream>
#include <system_error>

namespace restage::obj {

namespace fs = std::filesystem;

Importer::Importer(const RestageSceneWriter1& writer, const fs::path& path, std::string_view text)
    : out_(writer),
      path_(path),
      text_(text),
      report_(writer, path.string()),
      placement_(writer, Up::y),
      merge_(flag_option(writer, "merge")) {}

namespace {

// A material's name normalised: ignores case, the number of blanks, and a trailing comment.
std::string bare(const std::string& name) {
    std::string result;
    std::istringstream words(lower(name));
    for (std::string word; words >> word && (result.empty() || word[0] != '#');)
        result += result.empty() ? word : " " + word;
    return result;
}

} // namespace

void Importer::read_libraries() {
    std::vector<std::pair<std::string, std::uint32_t>> names; // in the order of the file, each once
    const auto add = [&](const std::string& name, std::uint32_t line) {
        if (std::none_of(names.begin(), names.end(), [&](const auto& n) { return n.first == name; }))
            names.emplace_back(name, line);
    };
    for (const auto& [rest, line] : model_.libraries) {
        std::string name = rest;
        if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
        const auto exists = [&](const std::string& file) {
            std::error_code code;
            return fs::exists(find_file(path_.parent_path(), file), code);
        };
        // One name with blanks, or several; the longest that exists counts.
        std::vector<std::string> words;
        std::istringstream stream(name);
        for (std::string word; stream >> word && (words.empty() || word[0] != '#');)
            words.push_back(word);
        if (exists(name)) words = {name};
        for (std::size_t i = 0; i < words.size();) {
            std::string longest = words[i], so_far = words[i];
            std::size_t next = i + 1;
            for (std::size_t k = i + 1; k < words.size(); ++k)
                if (so_far += " " + words[k]; exists(so_far)) longest = so_far, next = k + 1;
            add(longest, line);
            i = next;
        }
    }
    for (const auto& [name, line] : names) {
        const fs::path file = find_file(path_.parent_path(), name);
        std::string reason;
        const auto text = read_file(file, reason);
        if (!text) {
            report_.dropped("mtllib " + quote(name),
                            "it cannot be read: " + reason + ": " + file.string() + "; its materials are grey", line);
            continue;
        }
        tell_file_read(out_, file.string());
        libraries_.push_back({file, read_mtl(*text)});
    }
}

// The last one of that name counts, as if they were read in sequence.
const Mtl* Importer::find(const std::string& name) const {
    const Mtl* found = nullptr;
    for (const bool exact : {true, false})
        for (const Library& library : libraries_)
            for (const Mtl& m : library.materials)
                if (exact ? m.name == name : !found && bare(m.name) == bare(name)) found = &m;
    return found;
}

// Statements without an equivalent in the scene.
void Importer::tell_leftovers() {
    std::map<std::string, const char*> notes = {
        {"l", "lines have no surface"},
        {"p", "points have no surface"},
        {"curv", "free-form curves are not read"},
        {"curv2", "free-form curves are not read"},
        {"surf", "free-form surfaces are not read; convert them to polygons"},
        {"t", "subdivision creases are not read; the cage is shown"},
        {"f with fewer than three corners", "it has no surface"},
        {"vt without its numbers", "they are taken as 0"},
        {"vn without its numbers", "they are taken as 0"},
    };
    for (const auto& [word, where] : model_.skipped) {
        if ((word == "l" && !model_.lines.empty() && stroked_) || (word == "p" && !model_.points.empty() && stroked_))
            continue;
        const auto known = notes.find(word);
        report_.dropped("statement " + quote(word),
                        std::string(known != notes.end() ? known->second : "it is not understood") +
                            (where.second > 1 ? " (" + std::to_string(where.second) + " lines)" : ""),
                        where.first);
    }
    if (model_.absent_count > 0)
        report_.approximated(
            "faces", model_.absent.first + "; such corners (" + std::to_string(model_.absent_count) + ") go without",
            model_.absent.second);
    if (model_.has_bent_polygons)
        report_.approximated("polygons",
                             "some are not flat; they are cut into triangles in projection along their normal");
    for (const auto& [name, line] : model_.materials)
        if (!find(name))
            report_.approximated("material " + quote(name), "no library has it; grey is used instead", line);
    std::size_t unused = 0, all = 0;
    for (const Library& library : libraries_)
        for (const Mtl& m : library.materials) {
            ++all;
            unused += std::none_of(made_.begin(), made_.end(), [&](const auto& made) {
                return made.first >= 0 && find(model_.materials[static_cast<std::size_t>(made.first)].first) == &m;
            });
        }
    if (unused)
        report_.dropped("materials", std::to_string(unused) + " of " + std::to_string(all) + " are used by no face");
    if (model_.origin != Vec3{})
        report_.kept("coordinates",
                     "they are large for the objects' size; these are kept relative to a point among them");
}

void Importer::run() {
    if (text_.starts_with("\xfe\xff") || text_.starts_with("\xff\xfe"))
        throw ImportError{"the file is UTF-16 text; save it as UTF-8", 1, 1, {}};
    if (const auto zero = text_.find('\0'); zero != text_.npos)
        throw ImportError{"byte " + std::to_string(zero) + " is zero: this is not a text file", 0, 0, {}};
    model_ = read_model(text_, [&](double done) {
        return out_.progress(out_.ctx, static_cast<float>(0.7 * done), "reading the model") != 0;
    });
    read_libraries();
    smooth();
    for (std::size_t i = 0; i < model_.shapes.size(); ++i) {
        const float share = 0.7f + 0.3f * static_cast<float>(i) / static_cast<float>(model_.shapes.size());
        if (!out_.progress(out_.ctx, share, "making objects")) throw Cancelled{};
        shape(model_.shapes[i]);
    }
    merged();
    if (model_.shapes.empty()) strokes();
    if (objects_ == 0) {
        tell_leftovers();
        report_.flush();
        throw ImportError{"the file holds no faces"};
    }
    report_.kept("model", std::to_string(objects_) + " objects, " + std::to_string(triangles_) + " triangles, " +
                              std::to_string(made_.size()) + " materials");
    tell_leftovers();
    add_camera(out_, report_, bounds_, placement_.up);
    add_film(out_);
    add_studio(out_, report_, placement_.up);
}

// A statement of one letter, followed by as many numbers.
bool begins_with_numbers(std::string_view line, char letter, int count) {
    if (line.size() < 2 || line[0] != letter || (line[1] != ' ' && line[1] != '\t')) return false;
    line.remove_prefix(1);
    for (; count > 0; --count) {
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        if (line.starts_with('+')) line.remove_prefix(1);
        double number = 0;
        const char* end = std::from_chars(line.data(), line.data() + line.size(), number).ptr;
        if (end == line.data()) return false;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    }
    return true;
}

int probe(const char* path, const void* head, std::size_t head_size) {
    if (has_extension(path, "obj")) return 90;
    if (!head) return 0;
    // Any other extension: count lines that only this format has.
    const std::string_view text(static_cast<const char*>(head), head_size);
    if (text.find('\0') != text.npos) return 0;
    int vertices = 0, faces = 0;
    for (std::size_t at = 0; at < text.size(); at = std::min(text.find('\n', at), text.size()) + 1) {
        const std::string_view line = text.substr(at, std::min(text.find('\n', at), text.size()) - at);
        vertices += begins_with_numbers(line, 'v', 3);
        faces += begins_with_numbers(line, 'f', 1) || line.starts_with("mtllib ");
    }
    return vertices >= 3 ? (faces ? 60 : 30) : 0;
}

int load(const char* path, const RestageSceneWriter1* out) {
    if (!path || !out) return 0;
    return guarded_load(path, *out, [&] {
        std::error_code code;
        fs::path full = fs::weakly_canonical(path, code);
        if (code) full = path;
        std::string reason;
        const auto text = read_file(full, reason);
        if (!text) throw ImportError{"the file cannot be read: " + reason, 0, 0, {}};
        Importer(*out, full, *text).run();
    });
}

} // namespace restage::obj
