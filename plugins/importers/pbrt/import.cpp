// SPDX-License-Identifier: Apache-2.0
#include "import.hpp"

#include "common/report.hpp"
#include "lexer.hpp"

#include <algorithm>

namespace restage::pbrt {

void Values::number(const char* id, double value) {
    values_.push_back({.type = RESTAGE_FLOAT, .id = id, .v = {static_cast<float>(value)}});
}
void Values::integer(const char* id, int value) { values_.push_back({.type = RESTAGE_INT, .id = id, .i = value}); }
void Values::boolean(const char* id, bool value) { values_.push_back({.type = RESTAGE_BOOL, .id = id, .i = value}); }
void Values::color(const char* id, Rgb c) {
    values_.push_back({.type = RESTAGE_COLOR,
                       .id = id,
                       .v = {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), 1.f}});
}
void Values::choice(const char* id, const char* value) {
    values_.push_back({.type = RESTAGE_ENUM, .id = id, .text = value});
}
void Values::table(const char* id, std::string path) {
    values_.push_back({.type = RESTAGE_TABLE, .id = id, .text = paths_.emplace_back(std::move(path)).c_str()});
}
void Values::texture(const char* id, RestageType type, RestageHandle handle) {
    values_.push_back({.type = static_cast<std::uint32_t>(type), .id = id, .ref = handle});
}
void Values::material(const char* id, RestageHandle handle) {
    values_.push_back({.type = RESTAGE_MATERIAL, .id = id, .ref = handle});
}

void Import::report(RestageFate fate, Location at, std::string what, std::string note) {
    // The folding key: everything in `what` but quoted names, so `Shape "curve"` of many lines is one line.
    std::string kind;
    bool quoted = false;
    for (const char c : what) {
        if (c == '"') quoted = !quoted;
        if (!quoted) kind += c;
    }
    const std::string key = std::to_string(fate) + '\n' + kind + '\n' + note;
    if (Line*& line = folded_[key]; line) {
        ++line->count;
    } else {
        lines_.push_back({fate, at, std::move(what), std::move(note)});
        line = &lines_.back();
    }
}

void Import::flush_report() {
    for (const Line& line : lines_) {
        std::string note = line.note;
        if (line.count > 1)
            note += (note.empty() ? "(" : " (") + std::to_string(line.count) + " times; this is the first)";
        out.report(out.ctx, line.fate, sources.name(line.at.file).c_str(), line.at.line, line.what.c_str(),
                   note.c_str());
    }
    lines_.clear();
    folded_.clear();
    for (std::uint32_t i = 1; i < sources.size(); ++i) // after the scene file itself: Include and Import
        told_.insert(sources.name(i));
    for (const std::string& file : told_)
        importing::tell_file_read(out, file);
}

const RestageOrigin* Import::origin(const std::string& lines) {
    const auto [it, is_new] = origins_.try_emplace(lines);
    OriginLines& made = it->second;
    if (!is_new) return &made.given;
    for (std::string_view rest = lines; !rest.empty();) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (!line.starts_with('=')) {
            made.verbatim.append(line).append("\n");
            continue;
        }
        const std::size_t space = std::min(line.find(' '), line.size());
        const char* id = made.strings.emplace_back(line.substr(1, space - 1)).c_str();
        const char* text = made.strings.emplace_back(line.substr(std::min(space + 1, line.size()))).c_str();
        made.values.push_back({.id = id, .text = text});
    }
    made.given = {.value_count = static_cast<std::uint32_t>(made.values.size()),
                  .format = format(),
                  .verbatim = made.verbatim.c_str(),
                  .values = made.values.data()};
    return &made.given;
}

std::string Import::keep_unused(const ParamList& params, const std::string& what, bool quiet) {
    std::string verbatim;
    params.each_unused([&](const Param& param) {
        const std::string name = "parameter \"" + param.type + " " + param.name + "\" ";
        if (!param.should_be.empty()) {
            warned(param.at, what,
                   name + "should be \"" + param.should_be + " " + param.name +
                       "\": pbrt stops there; its value is taken");
            return;
        }
        if (param.misfit)
            warned(param.at, what, name + "has a value of the wrong kind; the default is used instead");
        else if (!is_pbrt_parameter(param.name))
            warned(param.at, what, name + "is unknown to pbrt; written back as it is");
        else if (!quiet)
            kept(param.at, what, name + "means nothing to the renderer; written back as it is");
        (verbatim += to_text(param)) += '\n';
    });
    return verbatim;
}

std::filesystem::path Import::resolve(const std::string& name, Location at) const {
    namespace fs = std::filesystem;
    std::error_code code;
    const auto find = [&](const std::string& as) {
        const fs::path path(as);
        if (path.is_absolute()) return path;
        const fs::path beside_main = folder_ / path;
        if (fs::exists(beside_main, code)) return beside_main;
        const fs::path beside_file = fs::path(sources.name(at.file)).parent_path() / path;
        return fs::exists(beside_file, code) ? beside_file : beside_main;
    };
    fs::path path = find(name);
    if (name.find('\\') != name.npos && !fs::exists(path, code)) { // a path from Windows
        std::string slashes = name;
        std::replace(slashes.begin(), slashes.end(), '\\', '/');
        path = find(slashes);
    }
    const fs::path real = fs::weakly_canonical(path, code);
    return code ? path : real;
}

void Import::make_files_absolute(ParamList& params, bool tell) {
    for (Param& param : params.params) {
        if (param.strings.size() != 1 || param.strings[0].empty()) continue;
        const bool file = param.type == "string" &&
                          (param.name.ends_with("filename") || param.name.ends_with("file") || param.name == "mapname");
        const bool spectrum_file = param.type == "spectrum" && !named_spectrum(param.strings[0]);
        if (!file && !spectrum_file) continue;
        const std::filesystem::path path = resolve(param.strings[0], param.at);
        std::error_code code;
        if (!std::filesystem::is_regular_file(path, code)) continue;
        param.strings[0] = path.string();
        if (tell) told_.insert(path.string());
    }
}

std::optional<Spectrum> Import::read_spectrum(const std::string& name, Location at) {
    const std::string path = resolve(name, at).string();
    if (const auto known = spectra_.find(path); known != spectra_.end()) return known->second;
    std::optional<Spectrum>& out_spectrum = spectra_[path];
    std::string reason;
    auto bytes = FileBytes::open(path, reason);
    // pbrt-v3 continues with a black one (paramset.cpp, AddSampledSpectrumFiles).
    const char* stand_in = v3() ? "; it is black" : "; the default is used instead";
    const auto black = [&] {
        if (v3()) out_spectrum = from_pairs({360, 0, 830, 0}, Ends::constant);
        return out_spectrum;
    };
    if (!bytes) {
        lost(at, "spectrum " + quote(name), reason + ": " + path + stand_in);
        return black();
    }
    Sources own; // messages name the spectrum file itself
    own.add(path, std::move(*bytes));
    Lexer lexer(own);
    lexer.push(0);
    std::vector<double> pairs;
    try {
        double value = 0;
        while (lexer.number(value))
            pairs.push_back(value);
        if (v3()) mend_pairs(at, "spectrum " + quote(name), pairs);
        if (lexer.peek().kind == TokenKind::end_of_file)
            out_spectrum = from_pairs(pairs, v3() ? Ends::constant : Ends::zero);
        else
            reason = "line " + std::to_string(lexer.here().line) + " is not a number";
    } catch (const ImportError& error) {
        reason = "line " + std::to_string(error.at.line) + ": " + error.message;
    }
    if (out_spectrum) return out_spectrum;
    lost(at, "spectrum " + quote(name),
         (reason.empty() ? std::string("wavelengths must rise and each needs a value") : reason) + ": " + path +
             stand_in);
    return black();
}

// pbrt-v3 ignores a last number without a partner, and sorts (paramset.cpp, spectrum.cpp).
void Import::mend_pairs(Location at, const std::string& what, std::vector<double>& numbers) {
    if (numbers.size() % 2 != 0) {
        numbers.pop_back();
        warned(at, what, "an odd number of values is given; the last one is left out");
    }
    std::vector<std::pair<double, double>> pairs;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
        pairs.emplace_back(numbers[i], numbers[i + 1]);
    const auto before = [](const auto& a, const auto& b) { return a.first < b.first; };
    if (!std::is_sorted(pairs.begin(), pairs.end(), before)) {
        warned(at, what, "its wavelengths do not rise; they are sorted");
        std::stable_sort(pairs.begin(), pairs.end(), before);
    }
    numbers.clear();
    for (const auto& [wavelength, value] : pairs)
        if (numbers.empty() || wavelength > numbers[numbers.size() - 2])
            numbers.insert(numbers.end(), {wavelength, value});
}

std::optional<Spectrum> Import::spectrum(const Param& param) {
    if (!param.strings.empty()) {
        if (auto named = named_spectrum(param.strings[0])) return named;
        return read_spectrum(param.strings[0], param.at);
    }
    std::vector<double> numbers = param.numbers;
    if (v3()) mend_pairs(param.at, "\"spectrum " + param.name + "\"", numbers);
    auto out_spectrum = from_pairs(numbers, v3() ? Ends::constant : Ends::zero);
    if (!out_spectrum)
        throw ImportError{
            param.at, "\"spectrum " + param.name + "\" needs pairs of wavelength [nm] and value, wavelengths rising"};
    return out_spectrum;
}

std::optional<Spectrum> Import::spectrum(const ParamList& params, std::string_view name) {
    const Param* param = params.has(name) ? params.find(name) : nullptr;
    if (!param || param->type != "spectrum") return std::nullopt;
    const auto sampled = spectrum(*param);
    if (sampled)
        approximated(param->at, "spectra",
                     "reduced to linear sRGB; with --spectral those of materials, lights and media stay spectra");
    return sampled;
}

std::optional<Spectrum> Import::given_spectrum(const ParamList& params, std::string_view name) {
    const Param* param = params.has(name) ? params.find(name) : nullptr;
    if (!param) return std::nullopt;
    if (param->type == "blackbody" && !param->numbers.empty()) return blackbody(param->numbers[0]);
    if (param->type != "spectrum") return std::nullopt;
    if (!param->strings.empty())
        if (auto glass = named_dispersion(param->strings[0])) return glass;
    return spectrum(*param);
}

Rgb Import::limited(Rgb color, const Param& param, Role role) {
    const double top = role == Role::albedo ? 1 : 1e30;
    Rgb out_color{std::clamp(color.r, 0.0, top), std::clamp(color.g, 0.0, top), std::clamp(color.b, 0.0, top)};
    const double change =
        std::abs(out_color.r - color.r) + std::abs(out_color.g - color.g) + std::abs(out_color.b - color.b);
    if (change > 1e-3 * (1 + std::abs(color.r) + std::abs(color.g) + std::abs(color.b)))
        approximated(
            param.at, "\"" + param.type + " " + param.name + "\"",
            role == Role::albedo ? "out of [0,1] in linear sRGB; clamped" : "negative in linear sRGB; clamped to 0");
    return out_color;
}

std::optional<Rgb> Import::color(const ParamList& params, std::string_view name, Role role) {
    if (!params.has(name)) return std::nullopt;
    const Param* param = params.find(name);
    if (param->type == "texture") return std::nullopt;
    if (params.lenient) { // pbrt-v3 identifies a parameter by its type as well; it reads colours in complete triples
        const bool spectrum_type = param->type == "spectrum";
        const bool rgb = param->type == "rgb" || param->type == "color" || param->type == "xyz";
        const std::size_t needed = rgb ? 3 : 1;
        const bool is_color = spectrum_type || rgb || param->type == "blackbody";
        if (!is_color || (!spectrum_type && param->numbers.size() < needed)) {
            param->used = false;
            param->misfit = true;
            return std::nullopt;
        }
    }
    const auto need = [&](std::size_t count, const char* what) {
        if (param->numbers.size() < count || param->numbers.empty())
            throw ImportError{param->at, "\"" + param->type + " " + param->name + "\" needs " + what};
    };
    if (param->type == "rgb" || param->type == "color") {
        need(3, "three numbers");
        const Rgb given{param->numbers[0], param->numbers[1], param->numbers[2]};
        return limited(to_srgb(given, param->color_space, role != Role::light), *param, role);
    }
    if (param->type == "xyz") {
        need(3, "three numbers");
        return limited(xyz_to_rgb({param->numbers[0], param->numbers[1], param->numbers[2]}), *param, role);
    }
    if (param->type == "blackbody") {
        need(1, "a temperature [K]");
        const Spectrum emitted = blackbody(param->numbers[0]);
        // v3 has temperature and scale, relative to a peak of 1; v4 makes the light's luminance 1, its scale is
        // separate.
        const double scale = param->numbers.size() > 1 ? param->numbers[1] : 1;
        if (v3()) return limited(rgb_equal_energy(emitted) * scale, *param, Role::light);
        return limited((role == Role::light ? rgb_of_light(emitted) : rgb_of_reflectance(emitted)) * scale, *param,
                       role);
    }
    if (param->type == "spectrum") {
        const auto sampled = spectrum(*param);
        if (!sampled) return std::nullopt;
        approximated(param->at, "spectra",
                     "reduced to linear sRGB; with --spectral those of materials, lights and media stay spectra");
        if (v3()) return limited(rgb_equal_energy(*sampled), *param, role == Role::albedo ? Role::unbounded : role);
        return limited(role == Role::light ? rgb_of_light(*sampled) : rgb_of_reflectance(*sampled), *param, role);
    }
    if (param->numbers.size() == 1) return Rgb{param->numbers[0], param->numbers[0], param->numbers[0]};
    throw ImportError{param->at, "parameter \"" + param->type + " " + param->name +
                                     "\" should be a colour: rgb, spectrum or blackbody"};
}

} // namespace restage::pbrt
