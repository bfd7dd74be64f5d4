// SPDX-License-Identifier: Apache-2.0
// Names of things. Our exporter writes them in comments that are read back here:
//   # name: "cup"              (or without quotes) the next thing: a shape, light, camera, environment or
//   ObjectInstance;
//                              before an AttributeBegin: the contents of that block
//   # mesh: "cup mesh"         the mesh of the next shape, if its name differs
//   # names: "cup" "saucer"    the members of the next ObjectInstance, if the object names them differently
//   # alone: "cup 2"           the next ObjectInstance is a single thing, not a group
//   # group: "kitchen" "table" the rest of this block is in these groups, outermost first
// Comments of other programs are interpreted heuristically: "# Name: cup", "# Object cup", or a few words before the
// thing or its block.
#include "builder.hpp"
#include "lexer.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace restage::pbrt {

namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) > 127; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view trimmed(std::string_view text, std::string_view what = " \t\r") {
    const auto begin = text.find_first_not_of(what);
    if (begin == text.npos) return {};
    return text.substr(begin, text.find_last_not_of(what) + 1 - begin);
}

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

// `"a" "b"`; none for anything else.
std::vector<std::string> quoted_strings(std::string_view text) {
    std::vector<std::string> out;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
        if (text[0] != '"') return {};
        std::size_t end = 1;
        while (end < text.size() && text[end] != '"')
            end += text[end] == '\\' ? 2 : 1;
        if (end >= text.size()) return {};
        out.push_back(unescape(text.substr(1, end - 1)));
        text.remove_prefix(end + 1);
    }
    return out;
}

// Whether it is a human-readable label, such as "left wall", and not a sentence, a ruler or commented-out pbrt text.
std::string guessed_label(std::string_view comment) {
    std::string_view text = trimmed(comment, " \t\r#-=*/_:");
    const std::size_t key_end = text.find_first_of(" \t:=");
    if (key_end != text.npos) { // of exporters: "Name: Cube.001", "Object: Cube", "mesh Cube"
        const std::string key = lower(text.substr(0, key_end));
        const bool assigns = trimmed(text.substr(key_end)).find_first_of(":=") == 0;
        if (!assigns && is_directive(text.substr(0, key_end))) return {}; // `# Shape "disk"`
        for (const char* known : {"name", "object", "mesh", "shape", "model", "geometry", "obj"})
            if (key == known && (assigns || text.find_first_of(" \t", key_end + 1) == text.npos))
                return std::string(trimmed(text.substr(key_end), " \t:=\"'"));
    }
    constexpr std::size_t longest = 40, most_words = 4;
    if (text.empty() || text.size() > longest || text.find_first_of("\"[]{}()<>;=\\") != text.npos) return {};
    if (!is_letter(text[0]) && !is_digit(text[0])) return {};
    std::size_t words = 0, letters = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        letters += is_letter(text[i]);
        words += text[i] != ' ' && (i == 0 || text[i - 1] == ' ');
    }
    if (words > most_words || letters * 2 < text.size() || is_directive(text.substr(0, text.find(' ')))) return {};
    return std::string(text);
}

} // namespace

// mesh_00012, Object3, 0007: numbered by a program.
bool is_generic_name(std::string_view name) {
    std::size_t letters = 0;
    while (letters < name.size() && is_letter(name[letters]))
        ++letters;
    for (const char c : name.substr(letters))
        if (!is_digit(c) && c != '_' && c != '-' && c != '.' && c != ' ') return false;
    const std::string word = lower(name.substr(0, letters));
    for (const char* generic :
         {"",        "mesh",    "trimesh", "trianglemesh", "shape",  "object",  "obj", "geometry", "geom",
          "part",    "group",   "model",   "node",         "poly",   "polygon", "ply", "default",  "untitled",
          "unnamed", "plymesh", "tri",     "out",          "output", "m",       "o",   "g"})
        if (word == generic) return true;
    return false;
}

RestageHandle Builder::group_at(const std::vector<std::string>& path) {
    RestageHandle group = 0;
    std::string key;
    for (const std::string& name : path) {
        (key += name) += '\n';
        RestageHandle& known = groups_[key];
        if (known == 0) {
            const RestageGroup made{.name = name.c_str(), .origin = import_.origin(), .parent = group};
            known = import_.out.group(import_.out.ctx, &made);
        }
        group = known;
    }
    return group;
}

// Called before the directive runs. A block uses the words before it as the label of its contents.
void Builder::read_comments(const Directive& d) {
    std::string label;
    for (const std::string_view comment : d.comments) {
        const std::string_view text = trimmed(comment);
        const auto colon = text.find(':');
        const auto strings = colon == text.npos ? std::vector<std::string>() : quoted_strings(text.substr(colon + 1));
        const std::string_view key = text.substr(0, std::min(colon, text.size()));
        if (key == "name" && colon != text.npos) {
            next_.name = strings.empty() ? std::string(trimmed(text.substr(colon + 1))) : strings[0];
        } else if (strings.empty()) {
            if (std::string guess = guessed_label(comment); !guess.empty()) label = std::move(guess);
        } else if (key == "mesh") {
            next_.mesh = strings[0];
        } else if (key == "names") {
            next_.members = strings;
        } else if (key == "alone") {
            next_.name = strings[0];
            next_.alone = true;
        } else if (key == "emission") {
            std::uint32_t count = 0;
            next_.material_shines = import_.out.material_table(import_.out.ctx, strings[0].c_str(), &count) != nullptr;
        } else if (key == "group") {
            state_.group = group_at(strings);
        } else if (std::string guess = guessed_label(comment); !guess.empty()) {
            label = std::move(guess);
        }
    }
    switch (d.verb) {
        case Verb::attribute_begin:
        case Verb::transform_begin:
        case Verb::import_begin:
            block_label_ = label;
            block_name_ = next_.name;
            next_ = {};
            return;
        case Verb::attribute_end:
        case Verb::transform_end:
        case Verb::import_end:
        case Verb::object_begin:
        case Verb::object_end:
        case Verb::world_begin:
            next_ = {};
            return;
        case Verb::make_named_material: // comments there describe the contents
        case Verb::make_named_medium:
        case Verb::texture:
            return;
        default:
            if (world_ && !label.empty()) next_.label = label;
    }
}

// The first that is not empty and not numbered by a program, else the first that is not empty.
std::string Builder::take_name(std::initializer_list<std::string_view> best_first) {
    const Next next = std::exchange(next_, {});
    if (!next.name.empty()) return next.name;
    if (!state_.name.empty()) return state_.name;
    for (const std::string_view name : best_first)
        if (!name.empty() && !is_generic_name(name)) return std::string(name);
    for (const std::string_view name : best_first)
        if (!name.empty()) return std::string(name);
    return "thing";
}

std::string Builder::shape_name(const Directive& d, const std::string& file_stem) {
    const auto found = material_names_.find(state_.material);
    const std::string material = found == material_names_.end() ? "" : found->second, label = next_.label;
    own_name_ = !next_.name.empty() || !state_.name.empty() || !label.empty() || !state_.label.empty() ||
                (!file_stem.empty() && !is_generic_name(file_stem));
    return take_name({file_stem, label, state_.label, material, open_object_, state_.area_light ? "area light" : "",
                      d.name == "trianglemesh" ? "triangles" : d.name});
}

} // namespace restage::pbrt
