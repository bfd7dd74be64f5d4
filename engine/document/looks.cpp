// SPDX-License-Identifier: Apache-2.0
#include "document/looks.hpp"

#include "scene/edits.hpp"
#include "scene/links.hpp"
#include "scene/uses.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <set>
#include <utility>

namespace restage::document {

using namespace scene;

namespace {

// The item as the look has it; names and structure are the document's.
template <class T>
T dressed(const T& now, const T& look) {
    T item = look;
    item.name = now.name;
    if constexpr (std::is_same_v<T, Instance>) {
        item.mesh = now.mesh;
        item.group = now.group;
    }
    return item;
}

template <class T>
inline constexpr bool is_kept = // a look brings it back
    std::is_same_v<T, Material> || std::is_same_v<T, Texture> || std::is_same_v<T, Image> || std::is_same_v<T, Medium>;

class Difference {
  public:
    Difference(const Scene& now, const Look& look) : now_(now), look_(*look.state) {
        result_.edit.label = "Go to look " + look.name;
    }

    LookChange run() {
        items<Texture>();
        items<Material>();
        items<Medium>();
        items<Light>();
        items<Instance>();
        sky();
        camera();
        Film film = now_.film.value;
        film.exposure = look_.film.value.exposure;
        film.development = look_.film.value.development;
        if (!(film == now_.film.value)) add(ChangeOne<Film>{now_.film.value, film});
        return std::move(result_);
    }

  private:
    void add(AnyChange change) { result_.edit.changes.push_back(std::move(change)); }
    template <class T>
    void skip(const T& item) {
        result_.skipped.push_back(
            fmt::format("{} \"{}\"", std::is_same_v<T, Instance> ? "object" : kind_name<T>, item.name));
    }

    template <class T>
    void items() {
        table<T>(now_).each([&](Id<T> id, const T& before) {
            const T* look = table<T>(look_).find(id);
            if (look == &before) return; // shared
            if (linked_.contains(id)) { // its file says what it is
                if constexpr (std::is_same_v<T, Instance>)
                    if (look) {
                        T after = before;
                        after.object_to_world = look->object_to_world;
                        after.hidden = look->hidden;
                        change(id, before, std::move(after));
                    }
            } else if (look)
                change(id, before, dressed(before, *look));
            else if constexpr (requires { before.hidden; }) {
                T after = before;
                after.hidden = true;
                change(id, before, std::move(after));
            }
        });
        if constexpr (requires(T item) { item.hidden; })
            table<T>(look_).each([&](Id<T> id, const T& item) {
                if (!item.hidden && !table<T>(now_).find(id)) skip(item);
            });
    }
    template <class T>
    void change(Id<T> id, const T& before, T after) {
        if (before == after) return;
        if (bring(after))
            add(Change<T>{id, before, std::move(after)});
        else
            skip(before);
    }

    // Whether everything that the item refers to is there, or was brought back.
    template <class T>
    bool bring(const T& item) {
        bool complete = true;
        visit_references(item, [&]<class X>(const Id<X>& target) { complete = complete && there(target); });
        return complete;
    }
    template <class X>
    bool there(Id<X> target) {
        if (table<X>(now_).find(target)) return true;
        if constexpr (is_kept<X>) {
            const X* kept = table<X>(look_).find(target);
            if (!kept) return false;
            if (!brought_.insert({kind_name<X>, target.value}).second) return true;
            if (!bring(*kept)) return false;
            add(Change<X>{target, std::nullopt, *kept});
            return true;
        }
        return false;
    }

    void sky() {
        const auto &before = now_.environment.value, &after = look_.environment.value;
        if (!bring(after)) return result_.skipped.push_back("the sky");
        if (!(before == after)) add(ChangeOne<std::optional<Environment>>{before, after});
        if (!after || after->sky.empty()) return;
        // Pictures made by a plugin are replaced in place.
        const Image *is = now_.images.find(after->image), *was = look_.images.find(after->image);
        if (is && was && is->data != was->data) {
            Image image = *is;
            image.data = was->data;
            add(Change<Image>{after->image, *is, std::move(image)});
        }
    }

    void camera() {
        const Id<Camera> id = look_.active_camera.value;
        const Camera *before = now_.cameras.find(id), *look = look_.cameras.find(id);
        if (!look) return;
        if (!before) return skip(*look);
        if (id != now_.active_camera.value) add(ChangeOne<Id<Camera>>{now_.active_camera.value, id});
        if (look != before) change(id, *before, dressed(*before, *look));
    }

    const Scene& now_;
    const Scene& look_;
    const LinkedItems linked_{now_};
    std::set<std::pair<std::string_view, std::uint32_t>> brought_;
    LookChange result_;
};

Result<> check_index(const Session& session, std::size_t index) {
    if (index < session.looks().list.size()) return {};
    return fail(fmt::format("there is no look {}; the document has {}", index + 1, session.looks().list.size()));
}

Result<> check_name(const Looks& looks, std::string_view name, const Look* of = nullptr) {
    if (name.empty()) return fail("a look needs a name");
    const Look* other = looks.find(name);
    if (other && other != of) return fail(fmt::format("there is a look \"{}\" already", name));
    return {};
}

std::string free_name(const Looks& looks, const std::string& name) {
    if (!looks.find(name)) return name;
    std::set<std::string> taken;
    for (const Look& look : looks.list)
        taken.insert(look.name);
    return next_name(name, taken);
}

// The current look stays the same one when another is inserted, or removed, at `index`.
void shift_current(Looks& looks, std::size_t index, bool inserted) {
    if (looks.current == Looks::none || looks.current < index) return;
    if (inserted)
        ++looks.current;
    else
        looks.current = looks.current == index ? Looks::none : looks.current - 1;
}

} // namespace

const Look* Looks::find(std::string_view name) const {
    const auto found = std::ranges::find(list, name, &Look::name);
    return found == list.end() ? nullptr : &*found;
}

std::shared_ptr<const Scene> look_state(const Scene& scene, const Camera* seen_from) {
    auto state = std::make_shared<Scene>(scene);
    state->meshes = {};
    state->groups = {};
    const Id<Camera> id = scene.active_camera.value;
    const Camera* camera = scene.cameras.find(id);
    if (camera && seen_from && camera->camera_to_world != seen_from->camera_to_world) {
        Camera moved = *camera;
        moved.camera_to_world = seen_from->camera_to_world;
        state->cameras.set(id, std::move(moved), ++state->clock);
    }
    return state;
}

LookChange look_change(const Scene& now, const Look& look) { return Difference(now, look).run(); }

Scene with_look(const Scene& now, const Look& look) {
    Scene scene = now;
    apply(scene, look_change(now, look).edit);
    return scene;
}

Scene with_kept(const Scene& now, const Looks& looks) {
    Scene scene = now;
    for (const Look& look : looks.list) {
        Edit edit = look_change(scene, look).edit;
        std::erase_if(edit.changes, [](const AnyChange& change) {
            return std::visit(
                []<class C>(const C& c) {
                    if constexpr (requires { c.id; }) return c.before.has_value();
                    return true;
                },
                change);
        });
        apply(scene, edit);
    }
    return scene;
}

Result<> new_look(Session& session, std::string name, const Camera* seen_from) {
    Looks looks = session.looks();
    if (name.empty()) name = free_name(looks, "Look 1");
    RESTAGE_CHECK(check_name(looks, name));
    const std::string label = "New look " + name;
    looks.current = looks.list.size();
    looks.list.push_back({std::move(name), look_state(session.scene(), seen_from)});
    return session.change_looks(std::move(looks), label);
}

Result<std::vector<std::string>> go_to_look(Session& session, std::size_t index) {
    RESTAGE_CHECK(check_index(session, index));
    Looks looks = session.looks();
    LookChange to = look_change(session.scene(), looks.list[index]);
    if (to.edit.changes.empty() && looks.current == index) return std::move(to.skipped); // there already
    looks.current = index;
    const std::string label = to.edit.label;
    RESTAGE_CHECK(session.change_looks(std::move(looks), label, std::move(to.edit)));
    return std::move(to.skipped);
}

Result<> update_look(Session& session, std::size_t index, const Camera* seen_from) {
    RESTAGE_CHECK(check_index(session, index));
    Looks looks = session.looks();
    looks.list[index].state = look_state(session.scene(), seen_from);
    looks.current = index;
    const std::string label = "Update look " + looks.list[index].name;
    return session.change_looks(std::move(looks), label);
}

Result<> rename_look(Session& session, std::size_t index, std::string name) {
    RESTAGE_CHECK(check_index(session, index));
    const Looks& before = session.looks();
    if (before.list[index].name == name) return {};
    RESTAGE_CHECK(check_name(before, name, &before.list[index]));
    Looks looks = before;
    looks.list[index].name = std::move(name);
    return session.change_looks(std::move(looks), "Rename look");
}

Result<> duplicate_look(Session& session, std::size_t index) {
    RESTAGE_CHECK(check_index(session, index));
    Looks looks = session.looks();
    Look copy = looks.list[index];
    copy.name = free_name(looks, copy.name);
    const std::string label = "Duplicate look " + looks.list[index].name;
    looks.list.insert(looks.list.begin() + std::ptrdiff_t(index) + 1, std::move(copy));
    shift_current(looks, index + 1, true);
    return session.change_looks(std::move(looks), label);
}

Result<> remove_look(Session& session, std::size_t index) {
    RESTAGE_CHECK(check_index(session, index));
    Looks looks = session.looks();
    const std::string label = "Delete look " + looks.list[index].name;
    looks.list.erase(looks.list.begin() + std::ptrdiff_t(index));
    shift_current(looks, index, false);
    return session.change_looks(std::move(looks), label);
}

Result<> move_look(Session& session, std::size_t from, std::size_t to) {
    RESTAGE_CHECK(check_index(session, from));
    RESTAGE_CHECK(check_index(session, to));
    if (from == to) return {};
    Looks looks = session.looks();
    const auto at = [&](std::size_t i) { return looks.list.begin() + std::ptrdiff_t(i); };
    if (from < to)
        std::rotate(at(from), at(from) + 1, at(to) + 1);
    else
        std::rotate(at(to), at(from), at(from) + 1);
    if (looks.current == from)
        looks.current = to;
    else if (looks.current != Looks::none && from < looks.current && looks.current <= to)
        --looks.current;
    else if (looks.current != Looks::none && to <= looks.current && looks.current < from)
        ++looks.current;
    return session.change_looks(std::move(looks), "Move look");
}

Result<> use_in_all_looks(Session& session, std::span<const Id<Instance>> ids) {
    Looks looks = session.looks();
    if (looks.list.empty()) return fail("there are no looks yet");
    for (Look& look : looks.list) {
        auto state = std::make_shared<Scene>(*look.state);
        ++state->clock;
        for (const Id<Instance> id : ids) {
            const Instance* now = session.scene().instances.find(id);
            if (!now) return fail(fmt::format("there is no object with id {}", id.value));
            while (state->instances.size() < id.value) // made since: slots are in order
                state->instances.set(state->instances.next(), std::nullopt, state->clock);
            state->instances.set(id, *now, state->clock);
        }
        look.state = std::move(state);
    }
    return session.change_looks(std::move(looks), "Use in all looks");
}

} // namespace restage::document
