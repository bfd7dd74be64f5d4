// SPDX-License-Identifier: Apache-2.0
// ParamSet: the values of a material or texture, by parameter id. Knows nothing of tables: ids that no table knows are
// kept and travel along.
#pragma once

#include "scene/id.hpp"

#include <restage/params.h>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::scene {

struct Texture;
struct Material;

struct Value {
    RestageType type = RESTAGE_FLOAT;
    std::array<float, 4> v{};
    std::string text;      // ENUM, TEXT; TABLE: an absolute path
    Id<Texture> texture;   // stands for v
    Id<Material> material; // MATERIAL

    static Value number(float x) { return {.type = RESTAGE_FLOAT, .v = {x, 0, 0, 0}}; }
    static Value color(float r, float g, float b) { return {.type = RESTAGE_COLOR, .v = {r, g, b, 0}}; }
    static Value integer(int i) { return {.type = RESTAGE_INT, .v = {static_cast<float>(i), 0, 0, 0}}; }
    static Value boolean(bool b) { return {.type = RESTAGE_BOOL, .v = {b ? 1.f : 0.f, 0, 0, 0}}; }
    static Value choice(std::string text) { return {.type = RESTAGE_ENUM, .text = std::move(text)}; }
    static Value table(std::string path) { return {.type = RESTAGE_TABLE, .text = std::move(path)}; }
    bool operator==(const Value&) const = default;
};

// A handful of entries in order of first setting; a linear search beats a map at this size.
class ParamSet {
  public:
    const Value* find(std::string_view id) const;
    void set(std::string_view id, Value value); // replaces or appends
    void remove(std::string_view id);
    float number(std::string_view id, float fallback) const;
    std::string_view choice(std::string_view id, std::string_view fallback) const;
    std::array<float, 3> color(std::string_view id, std::array<float, 3> fallback) const;
    Id<Texture> texture(std::string_view id) const; // none when absent
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

// The value a table line stands for when nothing is set.
Value default_value(const RestageParam&);
// Index of `choice` in "a|b|c", or nullopt.
std::optional<int> choice_index(std::string_view choices, std::string_view choice);

} // namespace restage::scene
