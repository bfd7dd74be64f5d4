// SPDX-License-Identifier: Apache-2.0
#include "render/guiding_map.hpp"

#include "shared/hash.h"
#include "shared/octahedral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace restage::render {
namespace {

constexpr int side = GUIDING_SIDE, cells = side * side;
constexpr std::size_t records_per_leaf = 512; // up to twice as many
constexpr float alike = 0.8f; // of normals, on each axis
constexpr std::size_t fewest = 64; // records that normals separate
constexpr std::uint32_t deepest = 24;
constexpr std::array shares = {0.f, 0.25f, 0.5f}; // of directions that the guide chooses; more lost in each scene tried
constexpr double least_left = 0.1; // of a leaf's light, for the guide
constexpr double uniform = 0.02; // part of each histogram that is spread evenly: of directions nothing is known of

struct Bounds {
    glm::vec3 lower{1e30f}, upper{-1e30f};
    void add(const glm::vec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    std::uint32_t widest() const {
        const glm::vec3 size = upper - lower;
        return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    }
};

std::size_t cell_of(const glm::vec3& w) {
    const glm::dvec2 p = shared::direction_to_octahedral(glm::dvec3(w)) * double(side);
    return std::size_t(std::clamp(int(p.y), 0, side - 1) * side + std::clamp(int(p.x), 0, side - 1));
}

// All records of a path are in the same half.
unsigned half_of(const GuidingRecord& r) {
    return shared::pcg_hash(std::uint32_t(r.order >> 4) ^ shared::pcg_hash(std::uint32_t(r.order >> 32))) & 1;
}

float coordinate(const GuidingRecord& r, std::uint32_t axis) {
    return axis < 3 ? r.position[int(axis)] : r.normal[int(axis - 3)];
}

// First by normals, until those of a leaf are alike, then into halves of as many records. Returns the number of records
// below the split; 0: they stay together.
std::size_t split(std::span<GuidingRecord> records, shared::GuidingNode& node) {
    Bounds places, normals;
    for (const GuidingRecord& r : records) {
        places.add(r.position);
        normals.add(r.normal);
    }
    const std::uint32_t n = normals.widest(), p = places.widest();
    const float lower = normals.lower[int(n)], upper = normals.upper[int(n)];
    if (upper - lower > alike && records.size() > fewest) {
        node.axis = 3 + n;
        node.split = 0.5f * (lower + upper);
        const auto above = std::stable_partition(records.begin(), records.end(), [&](const GuidingRecord& r) {
            return coordinate(r, node.axis) < node.split;
        });
        return std::size_t(above - records.begin());
    }
    if (records.size() < 2 * records_per_leaf || !(places.upper[int(p)] > places.lower[int(p)])) return 0;
    node.axis = p;
    const auto middle = records.begin() + std::ptrdiff_t(records.size() / 2);
    std::ranges::nth_element(records, middle, {},
                             [&](const GuidingRecord& r) { return std::pair(coordinate(r, p), r.order); });
    node.split = coordinate(*middle, p);
    return records.size() / 2;
}

using Histogram = std::array<double, cells>; // over the cells of the octahedral map, row by row

// Each record's light, as a diffuse surface scatters it, without what light sampling finds well. Of the light that a
// ray meets directly, 1 - E^2 / M is left, by the mean E and the second moment M of light sampling alone: with nothing
// between the lamp and these places M is E^2, through a small window it is far more. Few rays that met light do not
// tell the two apart, and then nothing is left. What is left has the balance heuristic's weight, as lamps shine far
// brighter than walls. 0 if little is left altogether.
std::vector<float> guided_light(std::span<const GuidingRecord> records) {
    double mean = 0, moment = 0, met = 0;
    for (const GuidingRecord& r : records) {
        if (!(r.light_pdf > 0)) continue;
        const double light = double(r.light) * std::abs(glm::dot(r.normal, r.direction));
        mean += light / r.pdf;
        moment += light * light / (double(r.pdf) * r.light_pdf);
        ++met;
    }
    const double found = moment > 0 ? mean * mean / (moment * double(records.size())) * (1 + 2 / std::sqrt(met)) : 1;
    const double left = 1 - std::min(found, 1.0);
    std::vector<float> out;
    double guided = 0, all = 0;
    for (const GuidingRecord& r : records) {
        const float cosine = std::abs(glm::dot(r.normal, r.direction));
        const double direct = left * r.light * std::sqrt(r.pdf / (r.pdf + r.light_pdf));
        out.push_back(float(std::hypot(r.radiance, direct)) * cosine);
        guided += (r.radiance + left * r.light) * cosine / r.pdf;
        all += (double(r.radiance) + r.light) * cosine / r.pdf;
    }
    return guided > least_left * all ? out : std::vector<float>(records.size());
}

// Of the light from each direction. Each record is a square of one cell's size around its direction, so that few make a
// smooth histogram. part: 0 or 1: of this half of the records; 2: of all
Histogram second_moments(std::span<const GuidingRecord> records, std::span<const float> light, unsigned part) {
    Histogram out{};
    for (std::size_t i = 0; i < records.size(); ++i) {
        const GuidingRecord& r = records[i];
        if (!(light[i] > 0) || half_of(r) == 1 - part) continue;
        const double value = double(light[i]) * light[i] / r.pdf;
        const glm::dvec2 p = shared::direction_to_octahedral(glm::dvec3(r.direction)) * double(side) - 0.5;
        const glm::dvec2 first = glm::floor(p), w = p - first;
        for (int k = 0; k < 4; ++k) {
            const glm::dvec2 corner(k & 1, k >> 1);
            const glm::dvec2 at = shared::octahedral_wrap((first + corner + 0.5) / double(side)) * double(side);
            const int x = std::clamp(int(at.x), 0, side - 1), y = std::clamp(int(at.y), 0, side - 1);
            out[std::size_t(y * side + x)] += value * (k & 1 ? w.x : 1 - w.x) * (k >> 1 ? w.y : 1 - w.y);
        }
    }
    return out;
}

// Probabilities of the cells; false: there is no light.
bool normalize(Histogram& h) {
    double sum = 0;
    for (double& v : h)
        sum += v = std::sqrt(v);
    for (double& v : h)
        v = sum > 0 ? v / sum * (1 - uniform) + uniform / cells : 1.0 / cells;
    return sum > 0;
}

// The share with the least second moment of the light that a diffuse surface scatters: a map of each half of the
// records is tried on the other.
float best_share(std::span<const GuidingRecord> records, std::span<const float> light) {
    std::array<double, shares.size()> moments{};
    for (unsigned part = 0; part < 2; ++part) {
        Histogram h = second_moments(records, light, part);
        normalize(h);
        for (std::size_t i = 0; i < records.size(); ++i) {
            const GuidingRecord& r = records[i];
            if (!(light[i] > 0) || half_of(r) == part) continue;
            const double bsdf = std::abs(glm::dot(r.normal, r.direction)) / std::numbers::pi;
            const double guide = h[cell_of(r.direction)] * cells / (4 * std::numbers::pi);
            for (std::size_t k = 0; k < shares.size(); ++k)
                moments[k] += double(light[i]) * light[i] / (r.pdf * (shares[k] * guide + (1 - shares[k]) * bsdf));
        }
    }
    return shares[std::size_t(std::ranges::min_element(moments) - moments.begin())];
}

shared::GuidingLeaf leaf(std::span<const GuidingRecord> records) {
    const std::vector<float> light = guided_light(records);
    Histogram h = second_moments(records, light, 2);
    shared::GuidingLeaf out{};
    out.share = normalize(h) ? best_share(records, light) : 0;
    double rows = 0;
    for (int y = 0; y < side; ++y) {
        const double row = std::accumulate(h.begin() + y * side, h.begin() + (y + 1) * side, 0.0);
        rows += row;
        out.rows[y] = y + 1 < side ? float(rows) : 1.f;
        double columns = 0;
        for (int x = 0; x < side; ++x) {
            columns += h[std::size_t(y * side + x)] / row;
            out.columns[y * side + x] = x + 1 < side ? float(columns) : 1.f;
        }
    }
    // Of the sums as they were rounded.
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const float* columns = out.columns + y * side;
            const double row = double(out.rows[y]) - (y ? double(out.rows[y - 1]) : 0.0);
            const double cell = double(columns[x]) - (x ? double(columns[x - 1]) : 0.0);
            out.density[y * side + x] = float(row * cell * cells / (4 * std::numbers::pi));
        }
    return out;
}

} // namespace

GuidingMap GuidingMap::make(std::vector<GuidingRecord>& records, Jobs& jobs) {
    GuidingMap map;
    std::ranges::sort(records, {}, &GuidingRecord::order);
    std::vector<std::span<GuidingRecord>> parts; // of the leaves
    struct Part {
        std::uint32_t node, depth;
        std::span<GuidingRecord> records;
    };
    std::vector<Part> open{{0, 0, records}};
    map.nodes.push_back({});
    while (!open.empty()) {
        const Part part = open.back();
        open.pop_back();
        shared::GuidingNode node{
            .split = std::numeric_limits<float>::infinity(), .axis = 0, .next = part.node, .leaf = 0};
        map.depth = std::max(map.depth, part.depth);
        const std::size_t below = part.depth < deepest ? split(part.records, node) : 0;
        if (below > 0) {
            node.next = std::uint32_t(map.nodes.size());
            map.nodes.resize(map.nodes.size() + 2);
            open.push_back({node.next + 1, part.depth + 1, part.records.subspan(below)});
            open.push_back({node.next, part.depth + 1, part.records.first(below)});
        } else {
            node.leaf = std::uint32_t(parts.size());
            parts.push_back(part.records);
        }
        map.nodes[part.node] = node;
    }
    map.leaves.resize(parts.size());
    jobs.parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t k = begin; k < end; ++k)
            map.leaves[k] = leaf(parts[k]);
    });
    return map;
}

std::uint32_t GuidingMap::leaf_of(const glm::vec3& p, const glm::vec3& normal) const {
    std::uint32_t at = 0;
    for (std::uint32_t k = 0; k < depth; ++k) {
        const shared::GuidingNode& node = nodes[at];
        const float x = node.axis < 3 ? p[int(node.axis)] : normal[int(node.axis - 3)];
        at = node.next + (x >= node.split ? 1 : 0);
    }
    return nodes[at].leaf;
}

float GuidingMap::density(std::uint32_t leaf, const glm::vec3& w) const { return leaves[leaf].density[cell_of(w)]; }

} // namespace restage::render
