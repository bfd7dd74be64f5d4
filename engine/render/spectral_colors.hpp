// SPDX-License-Identifier: Apache-2.0
// Colours as records of spectral mode store them (shared/spectral.h), and the tables that shaders need for it.
#pragma once

#include "base/jobs.hpp"
#include "scene/scene.hpp"

#include <glm/glm.hpp>

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace restage::render {

// For colours in RGB: linear sRGB. Fitted once per program, in about a second.
class SpectralColors {
  public:
    static const SpectralColors& get(Jobs&);

    // Results are `stored`: three words in a vec3. Values out of range are clamped.
    glm::vec3 reflectance(const glm::vec3& rgb) const; // [0, 1]
    glm::vec3 unbounded(const glm::vec3& rgb) const;   // [0, infinity): light, absorption, indices
    // Coefficients of a colour within [0, 1], interpolated like table_spectrum() in shaders/lib/spectral.glsl.
    glm::vec3 coefficients(const glm::vec3& rgb) const;

    std::span<const glm::uvec2> cells() const { return cells_; } // packed; see SceneData
    std::span<const glm::vec4> film() const { return film_; }

  private:
    explicit SpectralColors(Jobs&);
    std::vector<glm::uvec2> cells_;
    std::vector<glm::vec4> film_;
};

glm::uvec2 pack_coefficients(const glm::vec3&);
// What a spectrum of these coefficients is, times `scale`.
glm::vec3 stored_smooth(const glm::vec3& coefficients, float scale);

// Measured spectra of a scene, numbered as they are first asked for. An origin may hold one for a value, beside its
// colour or number: under the id "spectrum:" and the value's, as text "r g b nm value nm value ..."; r, g and b are
// the value that it stands for (a number three times), so that an edited value has none.
class SpectralCurves {
  public:
    // nullopt: there is none, or it is not of this value.
    std::optional<std::uint32_t> of_value(const scene::Origin&, std::string_view id, const glm::vec3& value);
    // Of light: divided by D65, of luminance 1; also for other brightnesses of its colour.
    std::optional<std::uint32_t> of_light(const scene::Origin&, std::string_view id, const glm::vec3& value);
    std::span<const glm::vec2> entries() const { return entries_; } // of all, see SceneData
    void clear();

  private:
    std::optional<std::uint32_t> find(const std::string& text, bool light);
    std::map<std::string, std::optional<std::uint32_t>> known_;
    std::vector<glm::vec2> entries_;
};

glm::vec3 stored_curve(std::uint32_t curve, float scale);
std::uint32_t stored_number(std::uint32_t curve); // instead of a float's bits

// Of a stored spectrum at the four wavelengths that `hero` chooses.
glm::vec4 spectrum_at(const glm::vec3& stored, float hero, std::span<const glm::vec2> curves);

} // namespace restage::render
