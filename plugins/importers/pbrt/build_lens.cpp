// SPDX-License-Identifier: Apache-2.0
// Camera "realistic": its lens file gives the focal length and the stop of the thin lens used instead.
#include "builder.hpp"
#include "lexer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::pbrt {

namespace {

struct ThinLens {
    double focal_length = 0, stop = 0; // [mm]; stop: diameter
};

// Rows of radius, thickness, index and aperture diameter, front to rear [mm]; radius 0 is the aperture stop. A paraxial
// ray from infinity, surface by surface (Hecht, "Optics", sec. 6.2).
std::optional<ThinLens> reduce(const std::vector<double>& rows) {
    if (rows.empty() || rows.size() % 4 != 0) return std::nullopt;
    ThinLens out;
    double height = 1, angle = 0, index = 1;
    for (std::size_t i = 0; i < rows.size(); i += 4) {
        const double radius = rows[i], next = rows[i + 2] == 0 ? 1 : rows[i + 2];
        if (radius == 0) {
            out.stop = rows[i + 3];
        } else {
            angle = (index * angle - height * (next - index) / radius) / next;
            index = next;
        }
        if (i + 4 < rows.size()) height += rows[i + 1] * angle;
    }
    out.focal_length = -1 / angle;
    return out.focal_length > 0 && std::isfinite(out.focal_length) ? std::optional(out) : std::nullopt;
}

} // namespace

// Angle of the shorter side of the film, lens and focus; false: the lens file is missing or unusable.
bool Builder::realistic_camera(const Directive& d, RestageCamera& out) {
    const std::string file = d.params.string("lensfile", "");
    const double aperture = d.params.number("aperturediameter", 1), focus = d.params.number("focusdistance", 10);
    d.params.find("simpleweighting");
    d.params.find("aperture"); // v4: its shape
    std::string reason;
    auto bytes = FileBytes::open(import_.resolve(file, d.at), reason);
    if (file.empty() || !bytes) {
        import_.dropped(d.at, "lens " + quote(file), file.empty() ? "the camera names none" : reason);
        return false;
    }
    Sources own;
    own.add(file, std::move(*bytes));
    Lexer lexer(own);
    lexer.push(0);
    std::vector<double> rows;
    try {
        for (double value = 0; lexer.number(value);)
            rows.push_back(value);
    } catch (const ImportError&) { // NOLINT(bugprone-empty-catch): a word among the numbers: reduce refuses the
                                   // rest, or it suffices
    }
    const auto lens = reduce(rows);
    if (!lens) {
        import_.dropped(d.at, "lens " + quote(file),
                        "it holds no rows of radius, thickness, index and aperture that make a lens");
        return false;
    }
    const ParamList none;
    const ParamList& film = film_ ? film_->params : none;
    const double width = film.integer("xresolution", 1280), height = film.integer("yresolution", 720),
                 diagonal = film.number("diagonal", 35); // [mm]
    const double shorter = diagonal * std::min(width, height) / std::hypot(width, height);
    out.fov = static_cast<float>(2 * std::atan(shorter / 2 / lens->focal_length) * 180 / std::numbers::pi);
    const double stop = lens->stop > 0 ? std::min(aperture, lens->stop) : aperture;
    out.lens_radius = static_cast<float>(std::max(stop, 0.0) / 2 * 1e-3); // the scene is in metres then
    out.focal_distance = static_cast<float>(focus > 0 ? focus : 10);
    return std::isfinite(out.fov) && out.fov > 0;
}

} // namespace restage::pbrt
