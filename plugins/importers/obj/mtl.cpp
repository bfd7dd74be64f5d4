// SPDX-License-Identifier: Apache-2.0
#include "mtl.hpp"

#include "common/file.hpp"
#include "lines.hpp"

#include <algorithm>
#include <iterator>

namespace restage::obj {

namespace {

enum class What { color, number, texture };

struct Known {
    const char* key;   // usual spelling
    const char* lower; // any of the statement's spellings
    What what;
};
constexpr Known known_statements[] = {
    {"Ka", "ka", What::color},
    {"Kd", "kd", What::color},
    {"Ks", "ks", What::color},
    {"Ke", "ke", What::color},
    {"Tf", "tf", What::color},
    {"Tf", "kt", What::color},
    {"Ns", "ns", What::number},
    {"Ni", "ni", What::number},
    {"d", "d", What::number},
    {"Tr", "tr", What::number},
    {"illum", "illum", What::number},
    {"Pr", "pr", What::number},
    {"Pm", "pm", What::number},
    {"Ps", "ps", What::number},
    {"Pc", "pc", What::number},
    {"Pcr", "pcr", What::number},
    {"aniso", "aniso", What::number},
    {"anisor", "anisor", What::number},
    {"sharpness", "sharpness", What::number},
    {"map_Ka", "map_ka", What::texture},
    {"map_Kd", "map_kd", What::texture},
    {"map_Ks", "map_ks", What::texture},
    {"map_Ke", "map_ke", What::texture},
    {"map_Ns", "map_ns", What::texture},
    {"map_d", "map_d", What::texture},
    {"map_d", "map_opacity", What::texture},
    {"map_Pr", "map_pr", What::texture},
    {"map_Pm", "map_pm", What::texture},
    {"map_Ps", "map_ps", What::texture},
    {"bump", "bump", What::texture},
    {"bump", "map_bump", What::texture},
    {"norm", "norm", What::texture},
    {"norm", "map_kn", What::texture},
    {"disp", "disp", What::texture},
    {"disp", "map_disp", What::texture},
    {"refl", "refl", What::texture},
    {"refl", "map_refl", What::texture},
};

constexpr std::string_view known_options[] = {"-s",     "-o",      "-t",       "-mm",        "-bm",
                                              "-boost", "-texres", "-clamp",   "-blendu",    "-blendv",
                                              "-cc",    "-type",   "-imfchan", "-colorspace"};

// One, two or three; `name_follows`: "-s 2 2 7" is two numbers and a file.
void read_numbers(Words& words, std::array<double, 3>& to, bool name_follows) {
    for (double& value : to) {
        const auto word = words.peek();
        const auto read = word ? number(*word) : std::nullopt;
        if (!read) return;
        Words behind = words;
        behind.next();
        if (name_follows && behind.remainder().empty()) return;
        value = *read;
        words = behind;
    }
}

double read_number(Words& words, double otherwise) {
    const auto word = words.peek();
    const auto read = word ? number(*word) : std::nullopt;
    if (!read) return otherwise;
    words.next();
    return *read;
}

// Takes the options that follow.
void read_options(Words& words, MtlTexture& result, bool name_follows) {
    while (const auto option = words.peek()) {
        const std::string name = importing::lower(*option);
        if (std::ranges::find(known_options, name) == std::end(known_options)) return; // a file may begin with "-"
        words.next();
        if (name == "-s") {
            read_numbers(words, result.scale, name_follows);
        } else if (name == "-o") {
            read_numbers(words, result.offset, name_follows);
        } else if (name == "-t") {
            read_numbers(words, result.turbulence, name_follows);
        } else if (name == "-mm") {
            result.base = read_number(words, 0);
            result.gain = read_number(words, 1);
        } else if (name == "-bm") {
            result.bump = read_number(words, 1);
        } else if (name == "-boost" || name == "-texres") {
            read_number(words, 0);
        } else if (name == "-imfchan") {
            result.channel = importing::lower(words.next().value_or(""));
        } else if (name == "-colorspace") {
            result.colorspace = importing::lower(words.next().value_or(""));
        } else if (name == "-type") {
            words.next();
        } else { // -clamp, -blendu, -blendv, -cc
            const std::string value = importing::lower(words.peek().value_or(""));
            if (value == "on" || value == "off" || value == "1" || value == "0") words.next();
            if (name == "-clamp") result.clamp = value != "off" && value != "0";
        }
    }
}

// "-s 2 2 -bm .5 my file.png": options, then the name, which may have blanks or quotes. Some programs write options, or
// a comment, after it.
MtlTexture read_texture(std::string_view rest, std::uint32_t column) {
    MtlTexture result;
    Words words(rest, column);
    read_options(words, result, true);
    std::string_view file = words.remainder();
    for (std::size_t blank = file.find(' '); blank != file.npos; blank = file.find(' ', blank + 1)) {
        const std::string_view behind = file.substr(blank + 1);
        Words tail(behind, 0);
        const std::string word = importing::lower(tail.peek().value_or(""));
        const bool ends = behind.starts_with('#') || std::ranges::find(known_options, word) != std::end(known_options);
        if (!ends || file.find('.') >= blank) continue; // no name yet
        read_options(tail, result, false);
        file = file.substr(0, file.find_last_not_of(' ', blank) + 1);
        break;
    }
    if (file.size() >= 2 && file.front() == '"' && file.back() == '"') file = file.substr(1, file.size() - 2);
    result.file = file;
    return result;
}

void read_statement(const Known& known, const Statement& s, Mtl& material) {
    Words words(s.rest, s.column);
    const auto say = [&] {
        material.not_understood.try_emplace(std::string(s.word) + " " + std::string(s.rest), s.line);
    };
    switch (known.what) {
        case What::color: {
            std::array<double, 3> color{};
            std::size_t count = 0;
            for (; count < 3; ++count) {
                const auto word = words.next();
                const auto value = word ? number(*word) : std::nullopt;
                if (!value) break;
                color[count] = *value;
            }
            if (count == 0) return say(); // "spectral file.rfl", "xyz 1 1 1"
            if (count == 1) color[1] = color[2] = color[0];
            material.colors[known.key] = color;
            break;
        }
        case What::number: {
            auto word = words.next();
            if (word && importing::lower(*word) == "-halo") word = words.next();
            const auto value = word ? number(*word) : std::nullopt;
            if (!value) return say();
            if (std::string_view(known.key) == "Tr") {
                if (!material.numbers.contains("d")) material.numbers["d"] = 1 - *value;
            } else {
                material.numbers[known.key] = *value;
            }
            break;
        }
        case What::texture: {
            MtlTexture texture = read_texture(s.rest, s.column);
            if (texture.file.empty()) return say();
            material.textures[known.key] = std::move(texture);
            break;
        }
    }
    material.lines.try_emplace(known.key, s.line);
}

} // namespace

std::vector<Mtl> read_mtl(std::string_view text) {
    std::vector<Mtl> result;
    Statements statements(text);
    for (Statement s; statements.next(s);) {
        const std::string word = importing::lower(s.word);
        if (word == "newmtl") {
            result.push_back({.name = std::string(s.rest), .line = s.line});
            continue;
        }
        if (result.empty()) continue;
        const auto* found = std::find_if(std::begin(known_statements), std::end(known_statements),
                                         [&](const Known& k) { return word == k.lower; });
        if (found != std::end(known_statements))
            read_statement(*found, s, result.back());
        else
            result.back().not_understood.try_emplace(std::string(s.word), s.line);
    }
    return result;
}

} // namespace restage::obj
