// SPDX-License-Identifier: Apache-2.0
#include "query/thing_parts.hpp"

#include <array>
#include <cstddef>

namespace restage::query {

namespace {

using glm::dvec3;
using scene::Bounds;

constexpr double foot = 0.12;             // height of the part that stands on something, relative to the whole
constexpr double small_footprint = 0.35;  // of what is put onto something, relative to that
constexpr int cells = 24;                 // of a grid over a footprint, across
constexpr double wider = 1.1;             // than what lies on its edge: a panel, no leg
constexpr double thin = 0.02;             // height of rugs and sheets, relative to their length
constexpr double spans = 0.85;            // width of what is built onto something, relative to that
constexpr double steady = 0.1;            // width of what stands by itself, relative to its height
constexpr double least_support = 0.03;    // area that something stands on, relative to its footprint
constexpr double panel = 0.15;            // share of the surface of a panel or a socket that is on a wall
constexpr double within = 0.8;            // share of a box inside another that makes it a part

class Joiner {
  public:
    Joiner(std::span<Unit> units, const std::map<Pair, Contact>& touching)
        : units_(units), touching_(touching), joined_(units.size()) {}

    Union join() {
        std::vector<Pair> carried, leaning, standing; // carried, standing: the first on the second
        for (const auto& [pair, contact] : touching_) {
            const auto [u, v] = pair;
            Unit &a = units_[u], &b = units_[v];
            if (a.architecture || b.architecture) {
                Unit& fixed = a.architecture ? b : a;
                const auto& points = a.architecture ? contact.on_b : contact.on_a;
                fixed.anchored = true;
                if (!stands(fixed, a.architecture ? a : b, contact))
                    fixed.mounted += double(points.size()) / double(std::max<std::size_t>(fixed.points, 1));
            } else if (!a.own && !b.own) {
                const bool a_stands = stands(a, b, contact), b_stands = !a_stands && stands(b, a, contact);
                if (a_stands && is_small({u}, v))
                    standing.push_back({u, v});
                else if (b_stands && is_small({v}, u))
                    standing.push_back({v, u});
                else if (!a.mesh || a.mesh != b.mesh) { // else copies: a fence
                    if (a_stands || b_stands)
                        carried.push_back(a_stands ? Pair{u, v} : Pair{v, u});
                    else
                        leaning.push_back(pair);
                }
            }
        }
        drop_edges(carried, leaning);
        // What rests by itself has its own place.
        std::vector<Pair> unsteady;
        for (const Pair& pair : standing)
            if (rests({pair.first}, pair.second, {&pair, 1}))
                units_[pair.first].anchored = true;
            else
                unsteady.push_back(pair);
        // Large parts belong to what carries them, but for panels on a wall; so do parts that only other parts hold.
        for (const Pair& pair : carried)
            if (units_[pair.first].mounted < panel && units_[pair.second].mounted < panel)
                joined_.join(pair.first, pair.second);
            else
                leaning.emplace_back(std::minmax(pair.first, pair.second));
        for (const Pair& pair : leaning)
            if (!units_[pair.first].anchored && !units_[pair.second].anchored) joined_.join(pair.first, pair.second);
        // Parts may be small, and the whole large: a sofa on its legs.
        for (const auto& [key, pairs] : by_whole(standing))
            if (const auto whole = joined_with(key.first); whole.size() > 1 && !is_small(whole, key.second))
                joined_.join(key.first, key.second);
        // What does not rest by itself may do so with its other parts: a radio on thin rims.
        std::vector<Pair> held;
        for (const auto& [key, pairs] : by_whole(unsteady))
            if (const auto whole = joined_with(key.first); whole.size() > 1 && rests(whole, key.second, pairs))
                units_[key.first].anchored = true;
            else
                held.push_back(key);
        spread_anchors(units_, joined_);
        for (const Pair& pair : held)
            if (!units_[pair.first].anchored || !units_[pair.second].anchored) joined_.join(pair.first, pair.second);
        // The rest only leans together. It belongs together where a side has no place of its own, or is inside the
        // other.
        spread_anchors(units_, joined_);
        std::vector<bool> stood(units_.size(), false); // without a place of its own, but at something off the walls
        for (const auto& [u, v] : leaning) {
            if (!units_[u].anchored && units_[v].anchored && units_[v].mounted < panel) stood[u] = true;
            if (!units_[v].anchored && units_[u].anchored && units_[u].mounted < panel) stood[v] = true;
        }
        for (const Pair& pair : leaning) {
            const Unit &a = units_[pair.first], &b = units_[pair.second];
            const bool by_the_way = (!a.anchored && stood[pair.first] && b.mounted >= panel) ||
                                    (!b.anchored && stood[pair.second] && a.mounted >= panel);
            if (((!a.anchored || !b.anchored) && !by_the_way) || inside(a, b, touching_.at(pair).gap))
                joined_.join(pair.first, pair.second);
        }
        spread_anchors(units_, joined_);
        return std::move(joined_);
    }

  private:
    // Whether a touches b only with its underside.
    static bool stands(const Unit& a, const Unit& b, const Contact& contact) {
        if (a.box.center().z < b.box.center().z) return false;
        std::vector<double> heights;
        for (const auto* points : {&contact.on_a, &contact.on_b})
            for (const dvec3& p : *points)
                heights.push_back(p.z - a.box.lower.z);
        const auto high = heights.begin() + std::ptrdiff_t(0.95 * double(heights.size() - 1));
        std::nth_element(heights.begin(), high, heights.end());
        return *high <= std::max(foot * a.box.size().z, 3 * contact.gap);
    }

    // A table that stands on its legs, with an edge on a panel of the wall, only leans there.
    void drop_edges(std::vector<Pair>& carried, std::vector<Pair>& leaning) {
        const auto holds_it = [&](const Pair& pair) { return rests({pair.first}, pair.second, {&pair, 1}); };
        std::vector<std::uint32_t> held; // by one unit
        for (const Pair& pair : carried)
            if (holds_it(pair)) held.push_back(pair.first);
        std::erase_if(carried, [&](const Pair& pair) {
            const Rectangle& top = units_[pair.first].footprint;
            const Rectangle under(units_[pair.second].outline, top.angle);
            const bool wide = under.size.x > wider * top.size.x || under.size.y > wider * top.size.y;
            if (!wide || std::ranges::find(held, pair.first) == held.end() || holds_it(pair)) return false;
            leaning.emplace_back(std::minmax(pair.first, pair.second));
            return true;
        });
    }

    // Whether `outline`, seen on this footprint, is several pieces that are small together and each by itself: plates.
    static bool small_pieces(std::span<const glm::dvec2> outline, const Rectangle& under) {
        const glm::dvec2 x(std::cos(under.angle), std::sin(under.angle)), y(-x.y, x.x);
        const glm::dvec2 lower = under.center - 0.5 * under.size;
        std::array<bool, cells * cells> covered{};
        for (const glm::dvec2& p : outline) {
            const glm::dvec2 at = (glm::dvec2(glm::dot(p, x), glm::dot(p, y)) - lower) / under.size * double(cells);
            const glm::ivec2 cell(glm::floor(glm::clamp(at, -1.0, double(cells))));
            if (cell.x < 0 || cell.y < 0 || cell.x >= cells || cell.y >= cells) return false;
            covered[std::size_t(cell.y * cells + cell.x)] = true;
        }
        const auto all = std::ranges::count(covered, true);
        std::size_t pieces = 0;
        for (std::size_t first = 0; first < covered.size(); ++first) {
            if (!covered[first]) continue;
            glm::ivec2 low(cells), high(-1);
            std::vector<std::size_t> open{first};
            covered[first] = false;
            while (!open.empty()) {
                const glm::ivec2 at(open.back() % cells, open.back() / cells);
                open.pop_back();
                low = glm::min(low, at), high = glm::max(high, at);
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx) {
                        const glm::ivec2 to = at + glm::ivec2(dx, dy);
                        const bool in = to.x >= 0 && to.y >= 0 && to.x < cells && to.y < cells;
                        if (in && std::exchange(covered[std::size_t(to.y * cells + to.x)], false))
                            open.push_back(std::size_t(to.y * cells + to.x));
                    }
            }
            ++pieces;
            if (std::max(high.x - low.x, high.y - low.y) + 1 > spans * cells) return false;
        }
        return pieces > 1 && double(all) <= small_footprint * cells * cells;
    }

    // Whether there is room beside `whole` on unit b; a rug's furniture may be as large as the rug.
    bool is_small(const std::vector<std::uint32_t>& whole, std::uint32_t b) {
        const Rectangle& under = units_[b].footprint;
        const Unit& first = units_[whole.front()];
        const bool sheet = units_[b].box.size().z <= thin * std::max(under.size.x, under.size.y);
        const bool stacked = whole.size() == 1 && first.mesh && first.mesh == units_[b].mesh;
        if (sheet || stacked) return true;
        const std::vector<glm::dvec2> outline = outline_of(whole);
        const glm::dvec2 across = Rectangle(outline, under.angle).size / glm::max(under.size, glm::dvec2(1e-300));
        const bool one_small = Rectangle::smallest(outline).area() <= small_footprint * under.area() &&
                               std::max(across.x, across.y) <= spans;
        return one_small || small_pieces(outline, under);
    }
    std::vector<glm::dvec2> outline_of(const std::vector<std::uint32_t>& whole) {
        std::vector<glm::dvec2> outline;
        for (const std::uint32_t u : whole)
            outline.insert(outline.end(), units_[u].outline.begin(), units_[u].outline.end());
        return outline;
    }

    // Whether `whole`, parts of which stand on unit b, rests there by its weight: it could be taken away, or be
    // somewhere else on it.
    bool rests(const std::vector<std::uint32_t>& whole, std::uint32_t b, std::span<const Pair> standing) {
        Bounds box;
        for (const std::uint32_t u : whole)
            box.add(units_[u].box);
        std::vector<glm::dvec2> points;
        double reach = 0;
        for (const auto& [a, on] : standing) {
            const Contact& contact = touching_.at({std::min(a, b), std::max(a, b)});
            const bool first = a < b ? !contact.on_a.empty() : contact.on_b.empty(); // its own points if there are any
            const auto& own = first ? contact.on_a : contact.on_b;
            for (const dvec3& p : own)
                points.emplace_back(p);
            reach = std::max(reach, contact.gap);
        }
        const Rectangle footprint = Rectangle::smallest(outline_of(whole));
        Rectangle where(points, footprint.angle);
        if (std::min(where.size.x, where.size.y) < steady * box.size().z) return false;
        where.size += 2 * reach;
        if (where.area() < least_support * footprint.area()) return false;
        const glm::dvec2 off = glm::abs(footprint.center - where.center);
        return glm::all(glm::lessThan(off, 0.5 * where.size + 0.1 * footprint.size));
    }
    static bool inside(const Unit& a, const Unit& b, double slack) { // of each other
        const Bounds p = grown(a.box, slack), q = grown(b.box, slack);
        const dvec3 common = glm::max(glm::min(p.upper, q.upper) - glm::max(p.lower, q.lower), dvec3(0));
        const auto volume = [](const dvec3& s) { return s.x * s.y * s.z; };
        return volume(common) >= within * std::min(volume(p.size()), volume(q.size()));
    }

    // What stands on a unit, by the first unit of the whole it belongs to.
    std::map<Pair, std::vector<Pair>> by_whole(const std::vector<Pair>& standing) {
        std::map<Pair, std::vector<Pair>> result;
        for (const Pair& pair : standing)
            if (const std::uint32_t root = joined_.root(pair.first); root != joined_.root(pair.second))
                result[{root, pair.second}].push_back(pair);
        return result;
    }
    std::vector<std::uint32_t> joined_with(std::uint32_t unit) {
        std::vector<std::uint32_t> whole;
        for (std::uint32_t u = 0; u < units_.size(); ++u)
            if (joined_.root(u) == joined_.root(unit)) whole.push_back(u);
        return whole;
    }
    std::span<Unit> units_;
    const std::map<Pair, Contact>& touching_;
    Union joined_;
};

} // namespace

Union join_units(std::span<Unit> units, const std::map<Pair, Contact>& touching) {
    return Joiner(units, touching).join();
}

void spread_anchors(std::span<Unit> units, Union& joined) {
    std::vector<bool> anchored(units.size(), false); // by root
    for (std::uint32_t u = 0; u < units.size(); ++u)
        if (units[u].anchored) anchored[joined.root(u)] = true;
    for (std::uint32_t u = 0; u < units.size(); ++u)
        units[u].anchored = anchored[joined.root(u)];
}

} // namespace restage::query
