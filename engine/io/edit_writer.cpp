// SPDX-License-Identifier: Apache-2.0
#include "io/edit_writer.hpp"

#include "io/material_tables.hpp"
#include "io/run_action.hpp"
#include "io/scene_writer_calls.hpp"
#include "plugin/abi.hpp"
#include "scene/difference.hpp"
#include "scene/validate.hpp"

#include <algorithm>

namespace restage::io {

using namespace scene;

namespace {

// The kind of unnamed and numbered things, as SceneWriter calls it.
template <class T>
const char* name_key() {
    return std::is_same_v<T, Instance> ? "object" : kind_name<T>;
}

// f(Id<T>) for a handle of a kind; false if there is no such kind.
template <class F>
bool with_kind(std::uint32_t kind, RestageHandle handle, F&& f) {
    // RestageKind is in the order of scene::kinds.
    static_assert(RESTAGE_KIND_MESH == 1 && RESTAGE_KIND_CAMERA == std::tuple_size_v<decltype(kinds)>);
    std::uint32_t next = RESTAGE_KIND_MESH;
    bool found = false;
    each_kind([&]<class T>(const Kind<T>&) {
        if (next++ != kind) return;
        found = true;
        f(Id<T>{handle});
    });
    return found;
}

} // namespace

template <class T>
std::string EditWriter::called(Id<T> id) const {
    const T* item = scene::table<T>(scene).find(id);
    return std::string(kind_name<T>) + " " + (item ? "\"" + item->name + "\"" : std::to_string(id.value));
}

int EditWriter::take(const std::string& what, Result<Edit> edit) {
    if (!edit) {
        refuse(what, edit.error().message);
        return 0;
    }
    // Edits contain no new empty slots.
    bool lost = false;
    for (const AnyChange& change : edit->changes)
        std::visit(
            [&]<class C>(const C& c) {
                if constexpr (requires { c.id; })
                    lost |= !c.after &&
                            !(base_.*std::get<Kind<std::remove_cvref_t<decltype(*c.before)>>>(kinds).table).find(c.id);
            },
            change);
    if (lost) {
        refuse(what, "it was added by this run, and cannot be removed again");
        return 0;
    }
    apply(scene, *edit);
    return 1;
}

struct EditWriter::EditCalls : SceneWriter::Calls {
    template <class F>
    static int changed(void* ctx, const char* what, F&& f) noexcept {
        return Exchange::guarded<SceneWriter>(ctx, what,
                                              [&](SceneWriter& w) { return f(static_cast<EditWriter&>(w)); });
    }

    // The emission that the reader reports for an object with an emissive material is not its own.
    static RestageHandle add_instance(void* ctx, const RestageInstance* given) {
        RestageInstance in = plugin::sized(*given);
        if (in.flags & RESTAGE_INSTANCE_EMITS_BY_MATERIAL)
            in.flags &= ~std::uint32_t(RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_TWO_SIDED);
        return instance(ctx, &in);
    }
    static int set_transform(void* ctx, RestageHandle handle, const double m[16]) {
        return changed(ctx, "transform", [&](EditWriter& w) {
            const Id<Instance> id{handle};
            return w.take("transform of " + w.called(id), scene::set_transform(w.scene, id, matrix(m)));
        });
    }
    static int set_material(void* ctx, RestageHandle handle, RestageHandle material) {
        return changed(ctx, "material", [&](EditWriter& w) {
            const Id<Instance> id{handle};
            return w.take("material of " + w.called(id), scene::set_material(w.scene, std::span(&id, 1), {material}));
        });
    }
    static int set_group(void* ctx, RestageHandle handle, RestageHandle group) {
        return changed(ctx, "group", [&](EditWriter& w) {
            const Id<Instance> id{handle};
            if (!w.known<Group>(group, "group of", w.called(id))) return 0;
            return w.take("group of " + w.called(id),
                          modify(w.scene, id, "Group", [&](Instance& i) { i.group = {group}; }));
        });
    }
    static int set_hidden(void* ctx, std::uint32_t kind, RestageHandle handle, int hidden) {
        return changed(ctx, "hide", [&](EditWriter& w) {
            const Id<Instance> instance{handle};
            if (kind == RESTAGE_KIND_INSTANCE)
                return w.take("hide " + w.called(instance),
                              scene::set_hidden(w.scene, std::span(&instance, 1), hidden != 0));
            if (kind == RESTAGE_KIND_LIGHT)
                return w.take("hide " + w.called(Id<Light>{handle}),
                              scene::set_hidden(w.scene, Id<Light>{handle}, hidden != 0));
            w.refuse("hide", "only objects and lights can be hidden, not kind " + std::to_string(kind));
            return 0;
        });
    }
    static int set_name(void* ctx, std::uint32_t kind, RestageHandle handle, const char* name) {
        return changed(ctx, "name", [&](EditWriter& w) {
            int done = 0;
            if (!with_kind(kind, handle, [&]<class T>(Id<T> id) {
                    const T* now = scene::table<T>(w.scene).find(id);
                    const bool same = now && now->name == text(name);
                    done = w.take("name of " + w.called(id),
                                  rename(w.scene, id, same ? now->name : w.unique_name(name_key<T>(), text(name))));
                }))
                w.refuse("name", "there is no kind " + std::to_string(kind));
            return done;
        });
    }
    static int set_param(void* ctx, std::uint32_t kind, RestageHandle handle, const RestageValue* given) {
        return changed(ctx, "parameter", [&](EditWriter& w) {
            const RestageValue in = plugin::sized(*given);
            const bool material = kind == RESTAGE_KIND_MATERIAL;
            if (!material && kind != RESTAGE_KIND_TEXTURE) {
                w.refuse("parameter", "only materials and textures have values, not kind " + std::to_string(kind));
                return 0;
            }
            const std::string who = material ? w.called(Id<Material>{handle}) : w.called(Id<Texture>{handle});
            const ParamSet values = w.params(&in, 1, who);
            if (values.entries().empty()) return 0; // refused
            const auto& [id, value] = values.entries()[0];
            return w.take("parameter of " + who, material ? param_edit(w.scene, w.registry_, {handle}, id, value)
                                                          : scene::set_param(w.scene, Id<Texture>{handle}, id, value));
        });
    }
    // Everything except its name and origin.
    template <class T, class Given>
    static int set_whole(void* ctx, const char* what, RestageHandle handle, const Given* given) {
        return changed(ctx, what, [&](EditWriter& w) {
            const Id<T> id{handle};
            auto after = w.read(*given);
            if (!after) return 0;
            return w.take(w.called(id), modify(w.scene, id, what, [&](T& now) {
                              after->name = now.name, after->origin = now.origin;
                              forget_edited(after->origin, "*");
                              now = std::move(*after);
                          }));
        });
    }
    static int set_light(void* ctx, RestageHandle handle, const RestageLight* in) {
        return set_whole<Light>(ctx, "light", handle, in);
    }
    static int set_camera(void* ctx, RestageHandle handle, const RestageCamera* in) {
        return set_whole<Camera>(ctx, "camera", handle, in);
    }
    static int set_active_camera(void* ctx, RestageHandle camera) {
        return changed(ctx, "active camera", [&](EditWriter& w) {
            return w.take("active camera", scene::set_active_camera(w.scene, {camera}));
        });
    }
    static int set_environment(void* ctx, const RestageEnvironment* in) {
        return changed(ctx, "environment", [&](EditWriter& w) {
            if (!in) return w.take("the environment", scene::set_environment(w.scene, std::nullopt));
            const auto before = w.scene.environment;
            w.scene.environment = {}; // for SceneWriter, which expects one at most
            environment(ctx, in);
            auto after = std::exchange(w.scene.environment, before).value;
            return after ? w.take("the environment", scene::set_environment(w.scene, std::move(after))) : 0;
        });
    }
    static int remove(void* ctx, std::uint32_t kind, const RestageHandle* handles, std::uint32_t count) {
        return changed(ctx, "remove", [&](EditWriter& w) {
            if (count == 0 || !handles) return 1;
            if (kind == RESTAGE_KIND_INSTANCE) {
                std::vector<Id<Instance>> ids;
                for (std::uint32_t i = 0; i < count; ++i)
                    ids.push_back({handles[i]});
                return w.take("remove " + w.called(ids[0]), remove_instances(w.scene, ids));
            }
            const Scene before = w.scene; // all or none
            int done = 1;
            for (std::uint32_t i = 0; i < count && done; ++i)
                if (!with_kind(kind, handles[i], [&]<class T>(Id<T> id) {
                        if constexpr (!std::is_same_v<T, Instance>)
                            done = w.take("remove " + w.called(id), scene::remove(w.scene, id));
                    })) {
                    w.refuse("remove", "there is no kind " + std::to_string(kind));
                    done = 0;
                }
            if (!done) w.scene = before;
            return done;
        });
    }
    static int select(void* ctx, RestageHandle handle) {
        return changed(ctx, "select", [&](EditWriter& w) {
            if (!w.known<Instance>(handle, "select", "", true)) return 0;
            if (std::ranges::find(w.chosen_, Id<Instance>{handle}) == w.chosen_.end()) w.chosen_.push_back({handle});
            return 1;
        });
    }
    static void report(void* ctx, int fate, const char* what, const char* note) {
        Calls::report(ctx, fate, nullptr, 0, what, note);
    }
    static int progress(void* ctx, float done, const char* what) {
        const int go_on = Calls::progress(ctx, done, what);
        auto& w = static_cast<EditWriter&>(*static_cast<SceneWriter*>(ctx));
        if (!go_on && w.stopped_at_ == 0) w.stopped_at_ = w.changes() + 1;
        return go_on;
    }
    static void error(void* ctx, const char* message) { Calls::error(ctx, nullptr, 0, 0, message); }
};

EditWriter::EditWriter(const Scene& base, const plugin::Registry& registry, Progress progress)
    : SceneWriter(registry, std::move(progress)), base_(base) {
    scene = base;
    ++scene.clock; // things pushed from now on are newer than the base
    each_table(scene, [&]<class T>(const Table<T>& things) {
        auto& taken = names_[name_key<T>()];
        things.each([&](Id<T>, const T& item) { taken.insert(item.name); });
    });
    edits_ = {.size = sizeof(RestageEditWriter1),
              .ctx = static_cast<SceneWriter*>(this),
              .add_mesh = EditCalls::mesh,
              .add_image = EditCalls::image,
              .add_texture = EditCalls::texture,
              .add_material = EditCalls::material,
              .add_medium = EditCalls::medium,
              .add_group = EditCalls::group,
              .add_instance = EditCalls::add_instance,
              .add_light = EditCalls::light,
              .add_camera = EditCalls::camera,
              .set_transform = EditCalls::set_transform,
              .set_material = EditCalls::set_material,
              .set_group = EditCalls::set_group,
              .set_hidden = EditCalls::set_hidden,
              .set_name = EditCalls::set_name,
              .set_param = EditCalls::set_param,
              .set_light = EditCalls::set_light,
              .set_camera = EditCalls::set_camera,
              .set_active_camera = EditCalls::set_active_camera,
              .set_environment = EditCalls::set_environment,
              .remove = EditCalls::remove,
              .select = EditCalls::select,
              .report = EditCalls::report,
              .error = EditCalls::error,
              .progress = EditCalls::progress,
              .material_table = EditCalls::material_table};
}

std::uint64_t EditWriter::changes() const {
    std::uint64_t sum = scene.clock; // of builders and of pushed things
    each_table(scene, [&](const auto& table) { sum += table.size(); });
    return sum;
}

std::uint64_t EditWriter::late() const { return stopped_at_ == 0 ? 0 : changes() + 1 - stopped_at_; }

Result<Edit> EditWriter::finish(Jobs& jobs, std::string label) {
    read_images(jobs, base_.clock);
    Edit edit = difference(base_, scene, std::move(label));
    if (edit.changes.empty()) return edit;
    RESTAGE_CHECK(check_edit(edit));
    if (const std::string problem = new_error(base_, scene); !problem.empty()) return fail(problem);
    return edit;
}

std::vector<Id<Instance>> EditWriter::selection() const {
    std::vector<Id<Instance>> ids;
    for (const Id<Instance> id : chosen_)
        if (scene.instances.find(id)) ids.push_back(id);
    if (!chosen_.empty()) return ids;
    for (std::uint32_t i = base_.instances.size() + 1; i <= scene.instances.size(); ++i)
        ids.push_back({i});
    return ids;
}

} // namespace restage::io
