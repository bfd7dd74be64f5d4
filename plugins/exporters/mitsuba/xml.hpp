// SPDX-License-Identifier: Apache-2.0
// Elements of Mitsuba's XML as text: https://mitsuba.readthedocs.io/en/stable/src/key_topics/scene_format.html
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace restage::mitsuba_out {

// For an attribute: quoted characters as entities; those that XML cannot hold as '_'.
std::string escaped(std::string_view);

class Xml {
  public:
    explicit Xml(int depth) : depth_(depth) {}
    // <tag type= id= name=>; empty ones are left out.
    void open(std::string_view tag, std::string_view type, std::string_view id = "", std::string_view name = "");
    void name_next(std::string_view id) { next_id_ = id; } // the id of the next element that is opened without one
    void close();
    void put(std::string_view name, float value) { leaf("float", name, value); }
    void put(std::string_view name, double value) { leaf("float", name, value); }
    void put(std::string_view name, int value) { leaf("integer", name, std::to_string(value)); }
    void put(std::string_view name, std::string_view value) { leaf("string", name, value); }
    void flag(std::string_view name, bool value) { leaf("boolean", name, value ? "true" : "false"); }
    void rgb(std::string_view name, const std::array<float, 3>&);
    void point(std::string_view name, const std::array<double, 3>&, std::string_view tag = "point");
    void matrix(std::string_view name, const std::array<double, 16>& column_major);
    void ref(std::string_view id, std::string_view name = "");
    void add(const Xml& other) { text_ += other.text_; }
    const std::string& text() const { return text_; }

  private:
    void leaf(std::string_view tag, std::string_view name, std::string_view value);
    void leaf(std::string_view tag, std::string_view name, double value);
    void leaf(std::string_view tag, std::string_view name, float value);
    void indent();
    std::string text_;
    std::string next_id_;
    std::vector<std::string> open_;
    int depth_;
};

} // namespace restage::mitsuba_out
