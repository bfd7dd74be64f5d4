// SPDX-License-Identifier: Apache-2.0
#include "scene/difference.hpp"

#include <algorithm>

namespace restage::scene {

Edit difference(const Scene& before, const Scene& after, std::string label) {
    Edit edit{std::move(label), {}};
    each_kind([&]<class T>(const Kind<T>& kind) {
        const Table<T>&is = before.*kind.table, &will_be = after.*kind.table;
        for (Id<T> id{1}; id.value <= std::max(is.size(), will_be.size()); ++id.value) {
            const T *a = is.find(id), *b = will_be.find(id);
            if (a == b || (a && b && *a == *b)) continue;
            Change<T> change{id, {}, {}};
            if (a) change.before = *a;
            if (b) change.after = *b;
            edit.changes.push_back(std::move(change));
        }
    });
    each_single([&]<class T>(const Single<T>& single) {
        const T &a = (before.*single.one).value, &b = (after.*single.one).value;
        if (!(a == b)) edit.changes.push_back(ChangeOne<T>{a, b});
    });
    return edit;
}

} // namespace restage::scene
