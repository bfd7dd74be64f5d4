// SPDX-License-Identifier: Apache-2.0
#include "shown_scene.hpp"

#include "scene/tables.hpp"

#include <utility>

namespace restage::editor {

using namespace scene;

namespace {

// Changes of `from` since that version, with a version of `to`.
void copy_changes(const Scene& from, Version since, Scene& to) {
    ++to.clock;
    each_kind([&]<class T>(const Kind<T>& kind) {
        (from.*kind.table).each_changed(since, [&](Id<T> id, const T* item) {
            (to.*kind.table).set(id, item ? std::optional<T>(*item) : std::nullopt, to.clock);
        });
    });
    each_single([&](const auto& single) {
        const auto& one = from.*single.one;
        if (one.version > since) (to.*single.one) = {one.value, to.clock};
    });
}

} // namespace

const Scene& ShownScene::follow(const Scene& scene, std::uint64_t document, const Trial& trial) {
    if (document != document_) {
        shown_.reset();
        undo_.reset();
        document_ = document;
        trial_ = 0;
    }
    // NOLINTNEXTLINE(bugprone-return-const-ref-from-parameter): the document's, which outlives the call
    if (!shown_ && !trial.build) return scene;
    if (!shown_) {
        shown_ = scene; // shares its data
        seen_ = scene.clock;
    }
    const std::uint64_t wanted = trial.build ? trial.number : 0;
    if (scene.clock == seen_ && wanted == trial_) return *shown_;
    if (undo_) apply(*shown_, *std::exchange(undo_, std::nullopt));
    if (scene.clock != seen_) copy_changes(scene, seen_, *shown_);
    seen_ = scene.clock;
    trial_ = wanted;
    if (trial.build)
        if (auto edit = trial.build(*shown_); edit && !edit->changes.empty()) {
            apply(*shown_, *edit);
            undo_ = inverse(*edit);
        }
    return *shown_;
}

} // namespace restage::editor
