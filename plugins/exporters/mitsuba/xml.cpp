// SPDX-License-Identifier: Apache-2.0
#include "xml.hpp"

#include "common/text.hpp"

namespace restage::mitsuba_out {

using exporters::number;

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += static_cast<unsigned char>(c) < 32 ? '_' : c;
    }
    return out;
}

void Xml::indent() { text_.append(4 * (static_cast<std::size_t>(depth_) + open_.size()), ' '); }

void Xml::open(std::string_view tag, std::string_view type, std::string_view id, std::string_view name) {
    if (id.empty()) id = next_id_;
    indent();
    text_ += "<" + std::string(tag);
    for (const auto& [key, value] : {std::pair{" type", type}, {" id", id}, {" name", name}})
        if (!value.empty()) text_ += std::string(key) + "=\"" + escaped(value) + "\"";
    text_ += ">\n";
    open_.emplace_back(tag);
    next_id_.clear();
}

void Xml::close() {
    const std::string tag = open_.back();
    open_.pop_back();
    indent();
    text_ += "</" + tag + ">\n";
}

void Xml::leaf(std::string_view tag, std::string_view name, std::string_view value) {
    indent();
    text_ += "<" + std::string(tag) + " name=\"" + escaped(name) + "\" value=\"" + escaped(value) + "\"/>\n";
}

void Xml::leaf(std::string_view tag, std::string_view name, double value) { leaf(tag, name, number(value)); }
void Xml::leaf(std::string_view tag, std::string_view name, float value) { leaf(tag, name, number(value)); }

void Xml::rgb(std::string_view name, const std::array<float, 3>& c) {
    leaf("rgb", name, number(c[0]) + " " + number(c[1]) + " " + number(c[2]));
}

void Xml::point(std::string_view name, const std::array<double, 3>& p, std::string_view tag) {
    indent();
    text_ += "<" + std::string(tag) + " name=\"" + escaped(name) + "\" x=\"" + number(p[0]) + "\" y=\"" + number(p[1]) +
             "\" z=\"" + number(p[2]) + "\"/>\n";
}

void Xml::matrix(std::string_view name, const std::array<double, 16>& m) {
    open("transform", "", "", name);
    std::string rows; // of row vectors, as Mitsuba writes them
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            rows += (rows.empty() ? "" : " ") + number(m[4 * column + row]);
    indent();
    text_ += "<matrix value=\"" + rows + "\"/>\n";
    close();
}

void Xml::ref(std::string_view id, std::string_view name) {
    indent();
    text_ += "<ref id=\"" + escaped(id) + "\"";
    if (!name.empty()) text_ += " name=\"" + escaped(name) + "\"";
    text_ += "/>\n";
}

} // namespace restage::mitsuba_out
