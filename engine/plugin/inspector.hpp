// SPDX-License-Identifier: Apache-2.0
// Inspector: a plugin's part of the inspector (restage/inspector.h), and Widgets, which draw it: the editor
// implements them with its own, `restage check` with ones that simulate any user input. [main]
#pragma once

#include "base/result.hpp"
#include "model/param.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

struct RestageInspector1;

namespace restage::plugin {

// A parameter value passed between a plugin and the host.
struct PluginValue {
    const char* id = nullptr;
    std::optional<model::ParamType> type; // nullopt: type unknown to this program
    std::uint32_t ref = 0;                // of a texture or material; 0 = none
    int i = 0;                            // integer, boolean
    std::array<float, 4> v{};             // number, color
    const char* text = nullptr;           // choice, text, table
};

// See RestageUi1. Pointers are the plugin's own and may be null.
class Widgets {
  public:
    virtual void param(const char* id) = 0;
    virtual void hide(const char* id) = 0;
    virtual void slider(const char* id, const char* label, float min, float max, bool log_scale) = 0;
    virtual void color(const char* id, const char* label) = 0;
    virtual void texture(const char* id, const char* label) = 0;
    virtual int combo(const char* label, const char* const* choices, std::uint32_t count, int current) = 0;
    virtual bool button(const char* label, const char* tooltip) = 0;
    virtual void text(const char* text) = 0;
    virtual bool begin_group(const char* label) = 0;
    virtual void end_group() = 0;
    virtual void plot(const char* label, const float* values, std::uint32_t count, std::uint32_t channels, float x_min,
                      float x_max, float y_min, float y_max) = 0;
    virtual void curve(const char* label, const char* const* ids, std::uint32_t count) = 0;
    virtual void image(const char* label, const float* rgb, std::uint32_t width, std::uint32_t height) = 0;
    virtual std::optional<PluginValue> get(const char* id) = 0; // its text is valid until the next call
    virtual void set(const char* label, std::span<const PluginValue> values) = 0;

  protected:
    ~Widgets() = default;
};

class Inspector {
  public:
    static Result<Inspector> read(const RestageInspector1&); // the table must outlive it

    std::string material_type;

    void draw(Widgets&) const;

  private:
    const RestageInspector1* table_ = nullptr;
};

} // namespace restage::plugin
