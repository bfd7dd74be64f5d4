// SPDX-License-Identifier: Apache-2.0
// pbrt's text: numbers in the shortest form that reads back the same, quoted strings, parameters, and the parameters of
// lines that were kept verbatim.
#pragma once

#include "common/text.hpp"

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::pbrt_out {

using namespace exporters;

std::optional<double> read_number(std::string_view& text); // strips it, and space before it, from the start of the text
std::string quote(std::string_view); // with pbrt's escapes

// A list of parameters as text: `"float radius" [ 1 ]` each.
class Params {
  public:
    Params& add(std::string_view type, std::string_view name, std::string_view value); // value as in the brackets
    Params& add_float(std::string_view name, double value) { return add("float", name, number(value)); }
    Params& add_float(std::string_view name, float value) { return add("float", name, number(value)); }
    Params& add_int(std::string_view name, long long value) { return add("integer", name, std::to_string(value)); }
    Params& add_rgb(std::string_view name, const std::array<float, 3>& rgb);
    Params& add_string(std::string_view name, std::string_view value) { return add("string", name, quote(value)); }
    Params& add_raw(std::string_view parameters); // one or more, as kept verbatim; existing names win
    void remove(std::string_view name);
    void remove_all_of(const Params& others); // by name
    void retype(bool for_v3); // point, vector and "true" for v3, point3, vector3 and true for v4
    bool has(std::string_view name) const;
    // Context-free: no colours, which depend on the current ColorSpace.
    bool stands_alone() const;
    std::vector<std::string> files() const; // those naming a file: "string filename", "spectrum eta" of a file, ...
    std::string value(std::string_view name) const; // "" = absent
    std::string string(std::string_view name) const; // without its quotes; "" = absent
    void map_strings(const std::function<std::string(const std::string&)>&); // each single-string value
    bool empty() const { return entries_.empty(); }
    std::string text(std::string_view separator = " ") const;

  private:
    struct Entry {
        std::string type, name, value;
    };
    std::vector<Entry> entries_;
};

// `Film "rgb" "float iso" [ 100 ]` -> word Film, name rgb, rest the parameters.
struct KeptLine {
    std::string word, name, rest;
};
KeptLine split_directive(std::string_view line);

} // namespace restage::pbrt_out
