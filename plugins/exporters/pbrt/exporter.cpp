// SPDX-License-Identifier: Apache-2.0
#include "exporter.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace restage::pbrt_out {

void Exporter::report(RestageFate fate, const std::string& what, const std::string& note) {
    lossy_ = lossy_ || fate != RESTAGE_KEPT;
    if (reported_.insert(std::to_string(fate) + what + '\n' + note).second)
        in_.report(in_.ctx, fate, what.c_str(), note.c_str());
}

Kept Exporter::kept(const RestageOrigin& origin, const std::string& what) {
    Kept out;
    const bool ours = std::string_view(origin.format) == format();
    const bool of_pbrt = std::string_view(origin.format).starts_with("pbrt-"); // the other version
    for (std::uint32_t i = 0; i < origin.value_count; ++i) { // if it can be parsed; else the value is written
        const RestageOriginValue& value = RESTAGE_AT(RestageOriginValue, origin.values, i);
        const std::string_view id = value.id;
        if (id == whole_light) continue; // picture_light's
        if (id.starts_with("spectrum:")) continue; // for the renderer; pbrt's own notation is beside it
        if (ours && id == "*")
            out.whole.emplace_back(value.text);
        else if (ours)
            out.for_values[std::string(id)] = value.text;
        else
            approximated(what, std::string("what ") + origin.format +
                                   " gave as spectra, or in its own form, is written as in this scene");
    }
    for (const std::string& line : lines(origin.verbatim)) {
        if (ours) {
            out.lines.push_back(line);
            continue;
        }
        const auto same = of_pbrt ? in_other_words(line, v3()) : std::nullopt;
        if (!same) out.foreign.push_back(line);
        if (same && !same->empty()) out.lines.push_back(*same);
    }
    for (const std::string& line : out.foreign)
        dropped(what,
                line + " of " + origin.format + " has no meaning in " + format() + "; it is written as a comment");
    return out;
}

bool Exporter::put_exact(Params& params, const Kept& k, const char* id, const float (&value)[3],
                         const std::string& what) {
    const auto line = k.for_values.find(id);
    if (line == k.for_values.end()) return false;
    std::string_view at = line->second;
    bool same = true;
    for (const float x : value) {
        const auto kept = read_number(at);
        same = same && kept && static_cast<float>(*kept) == x;
    }
    Params original;
    original.add_raw(at);
    if (same && original.stands_alone()) {
        params.remove_all_of(original);
        params.add_raw(at);
        return true;
    }
    approximated(what, same ? "its light was given in another colour space; its colour in sRGB is written"
                            : "its light was given by a spectrum or a picture; its current colour is written");
    return false;
}

void Exporter::tell_missing(const std::string& what, const std::string& file) {
    if (told_missing_.insert(file).second) dropped(what, "its file is missing; its name is written unchanged: " + file);
}

std::string Exporter::finished(Params& params, const std::string& what) {
    for (const std::string& file : params.files()) { // existing ones have absolute paths, or belong to this export
        std::error_code code;
        if (!out_.has(file) && !std::filesystem::is_regular_file(file, code)) tell_missing(what, file);
    }
    params.map_strings([&](const std::string& text) {
        const std::filesystem::path path(text);
        std::error_code code;
        return path.is_absolute() && std::filesystem::is_regular_file(path, code) ? places_.of(text) : text;
    });
    params.retype(v3());
    return params.text();
}

void Exporter::comment(const std::vector<std::string>& comment_lines, const char* indent) {
    for (const std::string& line : comment_lines)
        text_ += indent + ("# " + line) + "\n";
}

void Exporter::mark(const char* indent, const char* key, const std::vector<std::string>& strings) {
    text_ += std::string(indent) + "# " + key + ":";
    for (const std::string& text : strings)
        text_ += " " + quote(text);
    text_ += "\n";
}

void Exporter::only_for_us(std::size_t start) {
    std::string ours;
    for (const std::string& line : lines(std::string_view(text_).substr(start)))
        ours += "#restage " + line + "\n";
    text_.replace(start, text_.npos, ours);
}

std::string Exporter::unique_name(const char* kind, const std::string& name) {
    const std::string base = name.empty() ? kind : name;
    std::string result = base;
    for (unsigned i = 2; !names_[kind].insert(result).second; ++i)
        result = base + " " + std::to_string(i);
    return result;
}

std::string Exporter::extern_name(const char* kind, const Kept& k) {
    const KeptLine line = k.whole.size() == 1 ? split_directive(k.whole[0]) : KeptLine{};
    if (line.word != "extern") return "";
    names_[kind].insert(line.name);
    return line.name;
}

void Exporter::flag(Params& params, const char* name, bool value) const {
    const char* word = value ? "true" : "false";
    params.add("bool", name, v3() ? quote(word) : word);
}

bool Exporter::run(const std::string& scene_name) {
    const auto go_on = [&](float done, const char* what) { return in_.progress(in_.ctx, done, what) != 0; };
    text_ = std::string("# ") + (v3() ? "pbrt-v3" : "pbrt-v4") + " scene, written by Restage\n";
    if (!go_on(0, "settings")) return false;
    head();
    text_ += "WorldBegin\n";
    for (RestageHandle h = 1; h <= in_.count(in_.ctx, RESTAGE_KIND_MEDIUM); ++h)
        medium(h);
    environment();
    lights();
    if (!go_on(0.1f, "materials")) return false;
    for (RestageHandle h = 1; h <= in_.count(in_.ctx, RESTAGE_KIND_TEXTURE); ++h)
        texture(h);
    for (RestageHandle h = 1; h <= in_.count(in_.ctx, RESTAGE_KIND_MATERIAL); ++h)
        material(h);
    if (!go_on(0.3f, "shapes")) return false;
    shapes();
    if (v3()) text_ += "\nWorldEnd\n";
    if (!go_on(0.9f, "writing")) return false;
    out_.write(scene_name, text_);
    return true;
}

} // namespace restage::pbrt_out
