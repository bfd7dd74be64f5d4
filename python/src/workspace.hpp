// SPDX-License-Identifier: Apache-2.0
// Workspace: a session as held by Python, with its renderer; and handles of the things in it. Scene and history are
// touched only with the GIL; code without it works on a copy of the scene.
#pragma once

#include "host.hpp"

#include "document/session.hpp"
#include "render/renderer.hpp"
#include "scene/bounds.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace restage::python {

struct RendererKey { // a renderer's settings
    std::string device, tracer;
    unsigned threads = 0;
    render::Strategy strategy = render::Strategy::mis;
    bool operator==(const RendererKey&) const = default;
};

class Workspace : public std::enable_shared_from_this<Workspace> {
  public:
    explicit Workspace(std::shared_ptr<Host> host) : host_(std::move(host)), session_(host_->registry()) {}
    ~Workspace();
    Workspace(const Workspace&) = delete;

    Host& host() { return *host_; }
    document::Session& session() {
        if (closed_) throw Failure("the session is closed");
        return session_;
    }
    const scene::Scene& scene() { return session().scene(); }
    glm::dvec3 up();

    // Every change of the scene goes through here: within a step it joins the step's entry of the history.
    bool edit(Result<scene::Edit>);
    void begin_step(std::string label);
    void end_step();

    void close(); // waits for renders of other threads. [no GIL]
    bool closed() const { return closed_; }

  private:
    std::shared_ptr<Host> host_;
    document::Session session_;
    bool closed_ = false;
    std::string step_label_, step_key_;
    unsigned step_depth_ = 0, steps_ = 0;

    std::mutex rendering_;
    std::atomic<std::thread::id> renderer_thread_;
    RendererKey key_;
    std::unique_ptr<render::Renderer> renderer_;

    friend class RendererUse;
};

// The session's renderer, for one thread at a time; the constructor waits for others. [no GIL]
class RendererUse {
  public:
    explicit RendererUse(Workspace&);
    ~RendererUse() { in_.renderer_thread_ = std::thread::id(); }
    RendererUse(const RendererUse&) = delete;
    RendererUse& operator=(const RendererUse&) = delete;
    Result<render::Renderer*> get(const RendererKey&); // rebuilt if the key differs
    void drop() { in_.renderer_.reset(); }

  private:
    Workspace& in_;
    std::unique_lock<std::mutex> lock_;
};

// A thing of the scene: session and id. The handle stays valid after the thing is removed, and reports that.
template <class T>
struct Handle {
    std::shared_ptr<Workspace> in;
    scene::Id<T> id;

    const T& get() const {
        const T* found = scene::table<T>(in->scene()).find(id);
        if (!found)
            throw Failure("there is no " + std::string(scene::kind_name<T>) + " with id " + std::to_string(id.value) +
                          " any more; it was removed or undone");
        return *found;
    }
    // f(T&) changes a copy; one edit.
    template <class F>
    void change(std::string label, F&& f) const {
        in->edit(scene::modify(in->scene(), id, std::move(label), std::forward<F>(f)));
    }
    bool operator==(const Handle& other) const { return in == other.in && id == other.id; }
};

using Objects = std::vector<scene::Id<scene::Instance>>;
struct Selection { // several objects, handled as one
    std::shared_ptr<Workspace> in;
    Objects objects;
};

Objects objects_of(const Handle<scene::Instance>&);
Objects objects_of(const Handle<scene::Group>&); // of the group and its subgroups, those that still exist
Objects objects_of(const Selection&);            // those that still exist
// Any mixture of objects, groups and selections of one session.
Objects objects_of(Workspace&, nb::handle things);

// Common members of all handles: id, name, ==, hash, repr. `name_of_class` for repr: "Material".
template <class T>
void bind_handle(nb::class_<Handle<T>>& c, const char* name_of_class) {
    using H = Handle<T>;
    c.def_prop_ro(
         "id", [](const H& h) { return h.id.value; },
         "Number of the thing, from 1, unique in a session; the values of Picture.object_id and material_id.")
        .def_prop_rw(
            "name", [](const H& h) { return h.get().name; },
            [](const H& h, std::string name) { h.in->edit(scene::rename(h.in->scene(), h.id, std::move(name))); },
            "Name; setting it renames the thing.")
        .def_prop_ro(
            "exists",
            [](const H& h) { return !h.in->closed() && scene::table<T>(h.in->scene()).find(h.id) != nullptr; },
            "False once it is removed, or its creation undone.")
        .def("__eq__",
             [](const H& a, nb::handle b) {
                 H other;
                 return nb::try_cast(b, other, false) && a == other;
             })
        .def("__hash__", [](const H& h) { return std::hash<const void*>{}(h.in.get()) ^ (h.id.value * 0x9e3779b9u); })
        .def("__repr__", [name_of_class](const H& h) {
            const T* found = h.in->closed() ? nullptr : scene::table<T>(h.in->scene()).find(h.id);
            return std::string("<restage.") + name_of_class + " " + std::to_string(h.id.value) +
                   (found ? " \"" + found->name + "\">" : " (gone)>");
        });
}

nb::class_<Handle<scene::Instance>> bind_things(nb::module_&); // objects, groups, selections; the class Object
void bind_materials(nb::module_&);
void bind_textures(nb::module_&);
void bind_add_texture(nb::class_<Workspace>&); // after the types of its arguments
void bind_lights(nb::module_&);    // lights, cameras, the sky
void bind_session(nb::module_&, nb::class_<Workspace>&);
void bind_geometry(nb::class_<Workspace>&, nb::class_<Handle<scene::Instance>>&); // meshes, new cameras and groups
void bind_actions(nb::module_&, nb::class_<Workspace>&);
void bind_render(nb::module_&, nb::class_<Workspace>&);
void bind_sky(nb::class_<Workspace>&); // those of plugins
void bind_looks(nb::class_<Workspace>&);
void bind_bsdf(nb::module_&);

} // namespace restage::python
