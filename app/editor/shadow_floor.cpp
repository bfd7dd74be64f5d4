// SPDX-License-Identifier: Apache-2.0
#include "shadow_floor.hpp"

#include "document/session.hpp"
#include "editor.hpp"
#include "scene/shadow_floor.hpp"

namespace restage::editor {

void add_shadow_floor(Editor& e) {
    e.change([&e](document::Session& session) {
        auto made = scene::add_shadow_floor(session.scene(), e.up(), "diffuse");
        if (!made) return e.notices.add(LogLevel::error, made.error().message);
        if (const auto done = session.edit(std::move(made->edit)); !done)
            return e.notices.add(LogLevel::error, done.error().message);
        const InstanceId ids[] = {made->floor};
        e.selection.set(ids);
    });
}

} // namespace restage::editor
