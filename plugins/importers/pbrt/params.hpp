// SPDX-License-Identifier: Apache-2.0
// Typed parameter lists: "float radius" [ 1 ]. A look-up marks a parameter as used; unused ones are reported
// and kept verbatim. A value of the wrong kind is an error with its place.
#pragma once

#include "source.hpp"

#include <array>
#include <functional>

namespace restage::pbrt {

enum class ColorSpace { srgb, dci_p3, rec2020, aces2065_1 };

struct Param {
    std::string type, name;
    Location at;
    std::vector<double> numbers;
    std::vector<std::string> strings;
    std::vector<char> bools;
    ColorSpace color_space = ColorSpace::srgb;
    bool from_attribute = false; // an `Attribute` default: may go unused
    mutable bool used = false;
    mutable bool misfit = false; // looked up, but of the wrong kind: the default was used
    mutable std::string should_be; // v4: its value was used, though pbrt requires this type, and stops
};

class ParamList {
  public:
    std::vector<Param> params;
    // pbrt-v3's rules: a value of the wrong kind or type counts as absent (unused, marked `misfit`), not as an
    // error.
    bool lenient = false;

    void keep_last(); // for duplicates
    // The parameter of that name (the last one given), marked as used; nullptr if absent.
    const Param* find(std::string_view name) const;
    const Param* find(std::string_view name, std::string_view type) const;
    bool has(std::string_view name) const; // marks nothing

    double number(std::string_view name, double otherwise) const;
    int integer(std::string_view name, int otherwise) const;
    bool boolean(std::string_view name, bool otherwise) const;
    std::string string(std::string_view name, std::string otherwise) const;
    std::string texture(std::string_view name) const; // "" = absent or not a texture (then it stays unused)
    std::array<double, 3> triple(std::string_view name, std::array<double, 3> otherwise) const;
    const std::vector<double>* numbers(std::string_view name) const; // nullptr = absent
    // Integers in [lowest, highest]; throws naming the first that is not.
    std::vector<std::uint32_t> indices(std::string_view name, std::size_t bound) const;

    // For an existing parameter: whether it has that type. Lenient: if not, it counts as absent. Else the mismatch is
    // noted.
    bool typed(const Param& param, std::string_view type) const;
    // For an existing parameter: `fits`, or it is an error, or (lenient) counts as absent.
    bool taken(const Param& param, bool fits, const std::string& expected) const;
    void mark_all_used() const;
    // Each unused parameter, except Attribute defaults.
    void each_unused(const std::function<void(const Param&)>& visit) const;
};

// Whether anything in pbrt-v3 or v4 has a parameter of that name.
bool is_pbrt_parameter(std::string_view name);

// `"float radius" [ 1 ]`, numbers in the shortest form that reads back the same.
std::string to_text(const Param& param);
std::string to_text(const ParamList& list, std::string_view separator); // in the order of the file
std::string quote(std::string_view text);
std::string shortest(double value);
std::optional<double> parse_double(std::string_view text); // all of it

} // namespace restage::pbrt
