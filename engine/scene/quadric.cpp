// SPDX-License-Identifier: Apache-2.0
#include "scene/quadric.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

namespace restage::scene {

namespace {

constexpr double pi = std::numbers::pi;

// `sphere "float radius" [ 2 ] "float zmin" -1`: the numbers by name, or nullopt if the line is not understood.
std::optional<std::map<std::string_view, double>> numbers_of(std::string_view text) {
    std::map<std::string_view, double> out;
    const auto skip = [&](std::string_view what) {
        text.remove_prefix(std::min(text.find_first_not_of(what), text.size()));
    };
    for (skip(" \t"); !text.empty(); skip(" \t[]")) {
        if (text[0] != '"') return std::nullopt;
        const std::size_t end = text.find('"', 1);
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view declaration = text.substr(1, end - 1);
        text.remove_prefix(end + 1);
        const std::size_t space = declaration.find(' ');
        if (space == std::string_view::npos || declaration.substr(0, space) != "float") return std::nullopt;
        skip(" \t[");
        double value = 0;
        const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
        text.remove_prefix(std::size_t(rest - text.data()));
        out[declaration.substr(declaration.find_first_not_of(' ', space))] = value;
    }
    return out;
}

double turned(const glm::dvec3& p) { // angle about z, in [0, 2 pi)
    const double phi = std::atan2(p.y, p.x);
    return phi < 0 ? phi + 2 * pi : phi;
}

} // namespace

std::optional<Quadric> quadric_of(const Mesh& mesh) {
    std::string_view line = mesh.primitive;
    const std::string_view type = line.substr(0, line.find(' '));
    Quadric q;
    if (type == "sphere")
        q.kind = Quadric::Kind::sphere;
    else if (type == "disk")
        q.kind = Quadric::Kind::disk;
    else if (type == "cylinder")
        q.kind = Quadric::Kind::cylinder;
    else
        return std::nullopt;
    const auto numbers = numbers_of(line.substr(type.size())); // several lines mean several shapes: not supported
    if (!numbers) return std::nullopt;
    const auto get = [&](const char* name, double otherwise) {
        const auto it = numbers->find(name);
        return it == numbers->end() ? otherwise : it->second;
    };
    q.radius = get("radius", 1);
    q.phi_max = std::clamp(get("phimax", 360), 0.0, 360.0) * pi / 180;
    if (!(q.radius > 0 && q.radius < 1e30 && q.phi_max > 0)) return std::nullopt;
    if (q.kind == Quadric::Kind::disk) {
        q.z_min = q.z_max = get("height", 0);
        q.inner = get("innerradius", 0);
        return q.inner >= 0 && q.inner < q.radius ? std::optional(q) : std::nullopt;
    }
    const double reach = q.kind == Quadric::Kind::sphere ? q.radius : 1;
    const double a = get("zmin", -reach), b = get("zmax", reach);
    q.z_min = std::min(a, b);
    q.z_max = std::max(a, b);
    if (q.kind == Quadric::Kind::sphere) {
        q.z_min = std::clamp(q.z_min, -q.radius, q.radius);
        q.z_max = std::clamp(q.z_max, -q.radius, q.radius);
    }
    return q.z_min < q.z_max ? std::optional(q) : std::nullopt;
}

bool Quadric::whole_sphere() const {
    return kind == Kind::sphere && z_min <= -radius && z_max >= radius && phi_max >= 2 * pi;
}

double Quadric::area() const {
    if (kind == Kind::disk) return phi_max / 2 * (radius * radius - inner * inner);
    return phi_max * radius * (z_max - z_min); // of a sphere: Archimedes
}

glm::dvec3 Quadric::normal(const glm::dvec3& p) const {
    if (kind == Kind::disk) return {0, 0, 1};
    return glm::normalize(kind == Kind::sphere ? p : glm::dvec3(p.x, p.y, 0));
}

glm::dvec2 Quadric::uv(const glm::dvec3& p) const {
    const double u = turned(p) / phi_max;
    if (kind == Kind::disk) return {u, (radius - std::hypot(p.x, p.y)) / (radius - inner)};
    if (kind == Kind::cylinder) return {u, (p.z - z_min) / (z_max - z_min)};
    const double from = std::acos(z_min / radius), to = std::acos(z_max / radius);
    return {u, (std::atan2(std::hypot(p.x, p.y), p.z) - from) / (to - from)};
}

glm::dvec3 Quadric::at(glm::dvec2 uv) const {
    const double phi = uv.x * phi_max;
    double r = radius, z = glm::mix(z_min, z_max, uv.y);
    if (kind == Kind::disk) {
        r = glm::mix(radius, inner, uv.y);
    } else if (kind == Kind::sphere) {
        const double theta = glm::mix(std::acos(z_min / radius), std::acos(z_max / radius), uv.y);
        r = radius * std::sin(theta);
        z = radius * std::cos(theta);
    }
    return {r * std::cos(phi), r * std::sin(phi), z};
}

} // namespace restage::scene
