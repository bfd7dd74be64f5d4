// SPDX-License-Identifier: Apache-2.0
#include "text.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace restage::pbrt_out {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::size_t skip_space(std::string_view s, std::size_t i) {
    while (i < s.size() && is_space(s[i]))
        ++i;
    return i;
}

// The index behind the quoted string that starts at i.
std::size_t skip_string(std::string_view s, std::size_t i) {
    for (++i; i < s.size() && s[i] != '"'; ++i)
        if (s[i] == '\\') ++i;
    return std::min(i + 1, s.size());
}

std::string unquote(std::string_view text) { // of quote()
    std::string out;
    for (std::size_t i = 1; i + 1 < text.size(); ++i) {
        if (text[i] != '\\' || i + 2 >= text.size()) {
            out += text[i];
            continue;
        }
        const char c = text[++i];
        out += c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c;
    }
    return out;
}

} // namespace

std::optional<double> read_number(std::string_view& text) {
    text.remove_prefix(skip_space(text, 0));
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end == text.data()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

std::string quote(std::string_view text) {
    std::string out = "\"";
    for (const char c : text)
        switch (c) {
            case '"':
            case '\\':
                out += '\\';
                out += c;
                break;
            case '\n':
                out += "\\n";
                break;
            case '\t':
                out += "\\t";
                break;
            case '\r':
                out += "\\r";
                break;
            default:
                out += c;
        }
    return out + '"';
}

Params& Params::add(std::string_view type, std::string_view name, std::string_view value) {
    entries_.push_back({std::string(type), std::string(name), std::string(value)});
    return *this;
}

Params& Params::add_rgb(std::string_view name, const std::array<float, 3>& c) {
    return add("rgb", name, number(c[0]) + " " + number(c[1]) + " " + number(c[2]));
}

Params& Params::add_raw(std::string_view s) {
    std::size_t i = skip_space(s, 0);
    while (i < s.size() && s[i] == '"') {
        const std::size_t declared = skip_string(s, i);
        std::string_view declaration = s.substr(i + 1, declared - i - 2);
        i = skip_space(s, declared);
        std::string value;
        if (i < s.size() && s[i] == '[') {
            std::size_t end = i + 1;
            while (end < s.size() && s[end] != ']')
                end = s[end] == '"' ? skip_string(s, end) : end + 1;
            value = s.substr(i + 1, end - i - 1);
            i = std::min(end + 1, s.size());
        } else {
            std::size_t end = i;
            if (end < s.size() && s[end] == '"')
                end = skip_string(s, end);
            else
                while (end < s.size() && !is_space(s[end]))
                    ++end;
            value = s.substr(i, end - i);
            i = end;
        }
        i = skip_space(s, i);
        const std::size_t trim = std::min(skip_space(value, 0), value.size());
        value.erase(0, trim);
        while (!value.empty() && is_space(value.back()))
            value.pop_back();
        declaration.remove_prefix(std::min(skip_space(declaration, 0), declaration.size()));
        const std::size_t space = declaration.find_first_of(" \t");
        if (space == std::string_view::npos) return *this; // not a parameter: the rest is not understood either
        const std::string_view name = declaration.substr(std::min(skip_space(declaration, space), declaration.size()));
        if (!has(name)) add(declaration.substr(0, space), name, value);
    }
    return *this;
}

void Params::remove(std::string_view name) {
    std::erase_if(entries_, [&](const Entry& e) { return e.name == name; });
}

void Params::remove_all_of(const Params& others) {
    for (const Entry& e : others.entries_)
        remove(e.name);
}

void Params::retype(bool for_v3) {
    for (Entry& e : entries_)
        if (e.type == "point" || e.type == "point3")
            e.type = for_v3 ? "point" : "point3";
        else if (e.type == "vector" || e.type == "vector3")
            e.type = for_v3 ? "vector" : "vector3";
        else if (e.type == "bool")
            e.value = e.value.find("true") != e.value.npos ? (for_v3 ? "\"true\"" : "true")
                                                           : (for_v3 ? "\"false\"" : "false");
}

bool Params::has(std::string_view name) const {
    return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == name; });
}

bool Params::stands_alone() const {
    return std::none_of(entries_.begin(), entries_.end(), [](const Entry& e) {
        return (e.type == "rgb" || e.type == "color") && e.name != "scale"; // v3's, made from a number
    });
}

std::vector<std::string> Params::files() const {
    std::vector<std::string> out;
    for (const Entry& e : entries_) {
        if (!e.value.starts_with('"')) continue;
        const std::string text = unquote(e.value);
        const bool named = e.name.ends_with("filename") || e.name.ends_with("file") || e.name == "mapname";
        const bool spectrum = text.find_first_of("./\\") != std::string::npos; // never in pbrt's own names
        if ((e.type == "string" && named && !text.empty()) || (e.type == "spectrum" && spectrum)) out.push_back(text);
    }
    return out;
}

std::string Params::value(std::string_view name) const {
    for (const Entry& e : entries_)
        if (e.name == name) return e.value;
    return "";
}

std::string Params::string(std::string_view name) const { return unquote(value(name)); }

void Params::map_strings(const std::function<std::string(const std::string&)>& f) {
    for (Entry& e : entries_)
        if (e.value.starts_with('"') && skip_string(e.value, 0) == e.value.size()) e.value = quote(f(unquote(e.value)));
}

std::string Params::text(std::string_view separator) const {
    std::string out;
    for (const Entry& e : entries_) {
        if (!out.empty()) out += separator;
        out += "\"" + e.type + " " + e.name + "\" [ " + e.value + " ]";
    }
    return out;
}

KeptLine split_directive(std::string_view line) {
    KeptLine out;
    std::size_t i = skip_space(line, 0), begin = i;
    while (i < line.size() && !is_space(line[i]) && line[i] != '"')
        ++i;
    out.word = line.substr(begin, i - begin);
    i = skip_space(line, i);
    if (i < line.size() && line[i] == '"') {
        const std::size_t end = skip_string(line, i);
        const std::string_view first = line.substr(i + 1, end - i - 2);
        // `Film "float iso" [..]`: the first string declares a parameter already.
        const std::size_t next = skip_space(line, end);
        const bool declares = first.find(' ') != std::string_view::npos && next < line.size() && line[next] != '"';
        if (!declares) {
            out.name = first;
            i = next;
        }
    }
    out.rest = line.substr(std::min(i, line.size()));
    return out;
}

} // namespace restage::pbrt_out
