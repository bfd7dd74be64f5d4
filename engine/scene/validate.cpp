// SPDX-License-Identifier: Apache-2.0
#include "scene/validate.hpp"

#include "scene/tables.hpp"
#include "scene/uses.hpp"

#include <algorithm>
#include <map>

namespace restage::scene {

namespace {

constexpr std::size_t listed_of_a_kind = 8;

class Findings {
  public:
    // Problems of the same `kind` are counted together.
    void add(Problem::Severity severity, const std::string& kind, std::string sentence) {
        auto& [seen, worst] = counts_[kind];
        worst = std::max(worst, severity);
        if (++seen <= listed_of_a_kind) problems_.push_back({severity, std::move(sentence)});
    }
    void error(const std::string& kind, std::string s) { add(Problem::Severity::error, kind, std::move(s)); }

    std::vector<Problem> take() {
        for (const auto& [kind, count] : counts_)
            if (count.seen > listed_of_a_kind)
                problems_.push_back(
                    {count.worst, std::to_string(count.seen - listed_of_a_kind) + " more of this kind: " + kind});
        return std::move(problems_);
    }

  private:
    struct Count {
        std::size_t seen = 0;
        Problem::Severity worst = Problem::Severity::warning;
    };
    std::vector<Problem> problems_;
    std::map<std::string, Count> counts_;
};

template <class T>
std::string called(const T& item) {
    return std::string(kind_name<T>) + " \"" + item.name + "\"";
}

void check_references(const Scene& scene, Findings& out) {
    for_each_reference(scene, [&]<class X>(Id<X> target, const std::string& who) {
        if (!table<X>(scene).find(target))
            out.error("dangling reference",
                      who + ": " + kind_name<X> + " " + std::to_string(target.value) + " does not exist");
    });
}

// References among items of one kind must not form a cycle. Iterative depth-first search, three
// colours.
template <class T, class Next>
void check_cycles(const Scene& scene, Findings& out, Next&& next) {
    const Table<T>& slots = table<T>(scene);
    enum Color : char { white, gray, black };
    std::vector<Color> color(slots.size() + 1, white);
    struct Frame {
        Id<T> id;
        std::vector<Id<T>> children;
        std::size_t visited = 0;
    };
    const auto frame = [&](Id<T> id) { return Frame{id, next(slots[id])}; };
    slots.each([&](Id<T> root, const T&) {
        if (color[root.value] != white) return;
        std::vector<Frame> path{frame(root)};
        color[root.value] = gray;
        while (!path.empty()) {
            Frame& top = path.back();
            if (top.visited == top.children.size()) {
                color[top.id.value] = black;
                path.pop_back();
                continue;
            }
            const Id<T> child = top.children[top.visited++];
            if (!slots.find(child) || color[child.value] == black) continue;
            if (color[child.value] == gray) {
                out.error("circle", called(slots[top.id]) + " contains itself through " + called(slots[child]));
                continue;
            }
            color[child.value] = gray;
            path.push_back(frame(child));
        }
    });
}

template <class T>
std::vector<Id<T>> params_of_kind(const ParamSet& params) {
    std::vector<Id<T>> result;
    visit_references(params, [&]<class X>(Id<X> id) {
        if constexpr (std::is_same_v<X, T>) result.push_back(id);
    });
    return result;
}

// Items' own values: validate_values.cpp.
void check_things(const Scene& scene, Findings& out) {
    const auto add = [&](const auto& thing) {
        for (ValueProblem& p : value_problems(thing))
            out.add(p.severity, p.kind, std::move(p.sentence));
    };
    each_table(scene, [&]<class T>(const Table<T>& table) {
        table.each([&](Id<T>, const T& thing) {
            if constexpr (std::is_same_v<T, Instance>) {
                if (!thing.mesh) out.error("instance", called(thing) + " has no mesh");
                if (!thing.material) out.error("instance", called(thing) + " has no material");
            }
            add(thing);
        });
    });
    if (scene.environment.value) add(*scene.environment.value);
    if (!scene.active_camera.value) out.error("camera", no_camera);
    add(scene.film.value);
    add(scene.settings.value);
}

} // namespace

std::vector<Problem> validate(const Scene& scene) {
    Findings out;
    check_references(scene, out);
    check_cycles<Texture>(scene, out, [](const Texture& t) { return params_of_kind<Texture>(t.params); });
    check_cycles<Material>(scene, out, [](const Material& m) { return params_of_kind<Material>(m.params); });
    check_cycles<Group>(scene, out, [](const Group& g) { return std::vector<Id<Group>>{g.parent}; });
    check_things(scene, out);
    return out.take();
}

} // namespace restage::scene
