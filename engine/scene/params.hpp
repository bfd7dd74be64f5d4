// SPDX-License-Identifier: Apache-2.0
// ParamSet: the values of a material or texture, by parameter id. Knows no tables: unknown ids are
// kept.
#pragma once

#include "model/param.hpp"
#include "scene/id.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace restage::scene {

struct Texture;
struct Material;

using model::ParamType;

struct Value {
    ParamType type = ParamType::number;
    std::array<float, 4> v{}; // number, color
    int i = 0;                // integer; boolean: 0 or 1
    std::string text;         // choice, text; table: an absolute path
    Id<Texture> texture;      // replaces v
    Id<Material> material;    // material

    static Value number(float x) { return {.type = ParamType::number, .v = {x, 0, 0, 0}}; }
    static Value color(float r, float g, float b) { return {.type = ParamType::color, .v = {r, g, b, 0}}; }
    static Value integer(int i) { return {.type = ParamType::integer, .i = i}; }
    static Value boolean(bool b) { return {.type = ParamType::boolean, .i = b}; }
    static Value choice(std::string text) { return {.type = ParamType::choice, .text = std::move(text)}; }
    static Value table(std::string path) { return {.type = ParamType::table, .text = std::move(path)}; }
    // v[0] or i, depending on the type.
    float scalar() const { return is_whole() ? static_cast<float>(i) : v[0]; }
    int whole() const { return is_whole() ? i : static_cast<int>(v[0]); }
    bool is_whole() const { return type == ParamType::integer || type == ParamType::boolean; }
    bool has_text() const { return type == ParamType::choice || type == ParamType::text || type == ParamType::table; }
    bool operator==(const Value&) const = default;
};

// A handful of entries in order of first setting; a linear search beats a map at this size.
class ParamSet {
  public:
    const Value* find(std::string_view id) const;
    void set(std::string_view id, Value value); // replaces or appends
    void remove(std::string_view id);
    float number(std::string_view id, float fallback) const; // also of an integer or boolean
    int integer(std::string_view id, int fallback) const;    // also of a boolean
    std::string_view choice(std::string_view id, std::string_view fallback) const;
    std::array<float, 3> color(std::string_view id, std::array<float, 3> fallback) const;
    Id<Texture> texture(std::string_view id) const; // none if absent
    bool operator==(const ParamSet&) const = default;

    struct Entry {
        std::string id;
        Value value;
        bool operator==(const Entry&) const = default;
    };
    const std::vector<Entry>& entries() const { return entries_; }
    template <class F>
    void each_value(F&& f) { // f(Value&)
        for (Entry& entry : entries_)
            f(entry.value);
    }
    template <class F>
    void each_value(F&& f) const {
        for (const Entry& entry : entries_)
            f(entry.value);
    }

  private:
    std::vector<Entry> entries_;
};

// A table line's default as a value.
Value default_value(const model::Param&);
// Why the line cannot hold the value, to follow its name: " takes no texture"; "" if it can.
std::string misfit(const model::Param& line, const Value&);

} // namespace restage::scene
