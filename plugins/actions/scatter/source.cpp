// SPDX-License-Identifier: Apache-2.0
#include "source.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace scatter {

namespace {

template <class T>
T sized() {
    T item{};
    item.size = sizeof item;
    return item;
}

// The groups that contain an object, innermost first.
std::vector<RestageHandle> groups_of(const RestageSceneReader1& scene, RestageHandle group) {
    std::vector<RestageHandle> all;
    auto item = sized<RestageGroup>();
    while (group && std::ranges::find(all, group) == all.end() && scene.group(scene.ctx, group, &item)) {
        all.push_back(group);
        group = item.parent;
    }
    return all;
}

// Bounds along three axes; `up` is the first.
struct Box {
    Vec axes[3];
    double low[3], high[3];

    explicit Box(Vec up) : axes{up, perpendicular(up), cross(up, perpendicular(up))} {
        std::fill_n(low, 3, std::numeric_limits<double>::infinity());
        std::fill_n(high, 3, -std::numeric_limits<double>::infinity());
    }
    void add(const RestageSceneReader1& scene, const RestageInstance& object) {
        auto mesh = sized<RestageMesh>();
        if (!scene.mesh(scene.ctx, object.mesh, &mesh)) return;
        const Affine to_world = Affine::from(object.object_to_world);
        for (std::size_t i = 0; i < mesh.vertex_count; ++i) {
            const float* p = mesh.positions + 3 * i;
            const Vec at = to_world.point({p[0], p[1], p[2]});
            for (int k = 0; k < 3; ++k)
                low[k] = std::min(low[k], dot(axes[k], at)), high[k] = std::max(high[k], dot(axes[k], at));
        }
    }
    bool empty() const { return !(low[0] <= high[0]); }
    Vec foot() const {
        return axes[0] * low[0] + axes[1] * ((low[1] + high[1]) / 2) + axes[2] * ((low[2] + high[2]) / 2);
    }
};

} // namespace

std::vector<Source> sources_of(const RestageSceneReader1& scene, const std::vector<RestageHandle>& selected, Vec up) {
    // Groups that contain an unselected object are not used.
    const std::set<RestageHandle> chosen(selected.begin(), selected.end());
    std::set<RestageHandle> split;
    auto object = sized<RestageInstance>();
    for (RestageHandle i = 1; i <= scene.count(scene.ctx, RESTAGE_KIND_INSTANCE); ++i)
        if (!chosen.contains(i) && scene.instance(scene.ctx, i, &object))
            for (const RestageHandle group : groups_of(scene, object.group))
                split.insert(group);
    std::vector<Source> sources;
    std::map<RestageHandle, std::size_t> by_group;
    for (const RestageHandle handle : selected) {
        if (!scene.instance(scene.ctx, handle, &object)) continue;
        RestageHandle outermost = 0;
        for (const RestageHandle group : groups_of(scene, object.group))
            if (!split.contains(group)) outermost = group;
        const auto [known, first] = by_group.try_emplace(outermost, sources.size());
        if (first || !outermost) {
            Source source{.name = object.name, .group = outermost, .objects = {}, .foot = {}};
            auto group = sized<RestageGroup>();
            if (outermost && scene.group(scene.ctx, outermost, &group)) source.name = group.name;
            sources.push_back(std::move(source));
        }
        (outermost ? sources[known->second] : sources.back()).objects.push_back(object);
    }
    std::vector<Source> found;
    for (Source& source : sources) {
        Box box(up);
        for (const RestageInstance& o : source.objects)
            box.add(scene, o);
        if (box.empty()) continue;
        source.foot = box.foot();
        found.push_back(std::move(source));
    }
    return found;
}

} // namespace scatter
