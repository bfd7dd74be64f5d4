// SPDX-License-Identifier: Apache-2.0
#include "workspace.hpp"

#include "query/navigation.hpp"

#include <algorithm>
#include <new>
#include <set>

namespace restage::python {

using namespace scene;

glm::dvec3 Workspace::up() {
    const Camera* camera = scene().cameras.find(scene().active_camera.value);
    return camera ? query::guess_up(*camera) : glm::dvec3(0, 1, 0);
}

bool Workspace::edit(Result<Edit> made) {
    Edit change = take(std::move(made));
    if (step_depth_ == 0) {
        session().end_gesture();
        return take(session().edit(std::move(change)));
    }
    if (!step_label_.empty()) change.label = step_label_;
    return take(session().edit(std::move(change), step_key_));
}

void Workspace::begin_step(std::string label) {
    if (step_depth_++ > 0) return; // an inner step is part of the outer one
    session().end_gesture();
    step_label_ = std::move(label);
    step_key_ = "python step " + std::to_string(++steps_);
}

void Workspace::end_step() {
    if (step_depth_ > 0) --step_depth_;
    if (step_depth_ == 0 && !closed_) session().end_gesture();
}

Workspace::~Workspace() {
    if (Host::forked()) new (std::nothrow) std::unique_ptr(std::move(renderer_)); // it would wait for its threads
}

RendererUse::RendererUse(Workspace& workspace) : in_(workspace) {
    Host::begin_threads();
    if (in_.renderer_thread_ == std::this_thread::get_id())
        throw Failure("the session is being rendered: its progress callback cannot render or close it");
    lock_ = std::unique_lock(in_.rendering_);
    in_.renderer_thread_ = std::this_thread::get_id();
}

Result<render::Renderer*> RendererUse::get(const RendererKey& key) {
    if (in_.renderer_ && key == in_.key_) return in_.renderer_.get();
    in_.renderer_.reset();
    render::RendererOptions options;
    options.device = key.device;
    options.tracer = key.tracer;
    options.threads = key.threads;
    options.strategy = key.strategy;
    options.shader_dir = Host::home() / "share/restage/shaders";
    RESTAGE_TRY(in_.renderer_,
                render::Renderer::create(options, render::material_lookup(in_.host_->registry()), in_.host_->log()));
    in_.key_ = key;
    return in_.renderer_.get();
}

void Workspace::close() {
    if (!Host::forked()) {
        RendererUse use(*this);
        use.drop();
    }
    closed_ = true;
}

// --- which objects
// ----------------------------------------------------------------------------------------------------

Objects objects_of(const Handle<Instance>& h) {
    (void)h.get();
    return {h.id};
}

Objects objects_of(const Handle<Group>& h) {
    (void)h.get();
    const Scene& s = h.in->scene();
    Objects found;
    s.instances.each([&](Id<Instance> id, const Instance& instance) {
        Id<Group> group = instance.group;
        while (group && group != h.id)
            group = s.groups.find(group) ? s.groups[group].parent : Id<Group>{};
        if (group) found.push_back(id);
    });
    return found;
}

Objects objects_of(const Selection& selection) {
    Objects left;
    for (const auto id : selection.objects)
        if (selection.in->scene().instances.find(id)) left.push_back(id);
    return left;
}

Objects objects_of(Workspace& workspace, nb::handle things) {
    const auto mine = [&](const Workspace* other) {
        if (other != &workspace) throw Failure("this object belongs to another session");
    };
    Handle<Instance> object;
    Handle<Group> group;
    Selection selection;
    if (nb::try_cast(things, object, false)) {
        mine(object.in.get());
        return objects_of(object);
    }
    if (nb::try_cast(things, group, false)) {
        mine(group.in.get());
        return objects_of(group);
    }
    if (nb::try_cast(things, selection, false)) {
        mine(selection.in.get());
        return objects_of(selection);
    }
    if (nb::isinstance<nb::str>(things) || !nb::isinstance<nb::iterable>(things))
        throw nb::type_error("expected objects, groups or selections of this session");
    Objects all;
    std::set<std::uint32_t> seen;
    for (const nb::handle one : things)
        for (const auto id : objects_of(workspace, one))
            if (seen.insert(id.value).second) all.push_back(id);
    return all;
}

} // namespace restage::python
