// SPDX-License-Identifier: Apache-2.0
#include "document/actions.hpp"

#include "scene/uses.hpp"

namespace restage::document {

using namespace scene;

namespace {

// Rebases an edit made against `base` onto `now`.
class Rebase {
  public:
    Rebase(const Scene& base, const Scene& now) : base_(base), now_(now) {}

    Result<> operator()(Edit& edit) const {
        if (replaced()) return fail("another document has been opened meanwhile");
        std::string problem;
        for (AnyChange& change : edit.changes)
            std::visit([&](auto& c) { move(c, problem); }, change);
        if (!problem.empty()) return fail(problem + ": run it again");
        Scene after = now_;
        apply(after, edit);
        // Things to be removed may be in use by now.
        if (const std::string error = io::new_error(now_, after); !error.empty()) return fail(error);
        return {};
    }
    template <class T>
    Id<T> moved(Id<T> id) const { // new ids follow the existing ones
        const std::uint32_t old = scene::table<T>(base_).size();
        return id.value > old ? Id<T>{id.value - old + scene::table<T>(now_).size()} : id;
    }

  private:
    // Opening a document gives everything in it newer versions than before (Session::take).
    bool replaced() const {
        bool all = true;
        each_single([&](const auto& single) { all &= (now_.*single.one).version > base_.clock; });
        return all;
    }
    template <class T>
    void move(Change<T>& c, std::string& problem) const {
        if (c.before && scene::table<T>(now_).version(c.id) != scene::table<T>(base_).version(c.id))
            problem = std::string(kind_name<T>) + " \"" + c.before->name + "\" has changed meanwhile";
        if (!c.before) c.id = moved(c.id);
        if (c.after) refer(*c.after, problem);
    }
    template <class T>
    void move(ChangeOne<T>& c, std::string& problem) const {
        const auto& one = std::get<Single<T>>(singles);
        if ((now_.*one.one).version != (base_.*one.one).version)
            problem = std::string(one.who) + " has changed meanwhile";
        refer(c.after, problem);
    }
    template <class T>
    void refer(T& item, std::string& problem) const {
        visit_references(item, [&]<class X>(Id<X>& target) {
            if (scene::table<X>(base_).find(target) && !scene::table<X>(now_).find(target))
                problem = std::string(kind_name<X>) + " \"" + scene::table<X>(base_)[target].name +
                          "\" has been removed meanwhile";
            target = moved(target);
        });
    }

    const Scene& base_;
    const Scene& now_;
};

} // namespace

Result<> rebase_action(const Scene& now, io::ActionResult& result) {
    if (now.clock == result.base.clock) return {};
    const Rebase rebase(result.base, now);
    if (auto done = rebase(result.edit); !done) return fail(result.edit.label, done.error());
    for (Id<Instance>& id : result.selection)
        id = rebase.moved(id);
    result.base = now;
    return {};
}

Result<ActionDone> apply_action(Session& session, io::ActionResult result) {
    RESTAGE_CHECK(rebase_action(session.scene(), result));
    ActionDone done{.changed = false, .selection = {}, .report = std::move(result.report)};
    if (!result.edit.changes.empty()) {
        RESTAGE_TRY(done.changed, session.edit(std::move(result.edit)));
        session.end_gesture();
    }
    for (const Id<Instance> id : result.selection)
        if (session.scene().instances.find(id)) done.selection.push_back(id);
    return done;
}

Result<plugin::ActionEntry> find_action(const plugin::Registry& registry, std::string_view id) {
    const auto catalogue = registry.catalogue();
    std::string known;
    for (const plugin::ActionEntry& entry : catalogue->actions) {
        if (entry.table->id == id) return entry;
        known += (known.empty() ? "" : ", ") + entry.table->id;
    }
    return fail("there is no action \"" + std::string(id) + "\"; " +
                (known.empty() ? "no plugin with actions is loaded" : "known: " + known));
}

Result<ActionDone> run_action(Session& session, std::string_view id, const io::ActionRun& run) {
    RESTAGE_TRY(const plugin::ActionEntry entry, find_action(session.registry(), id));
    RESTAGE_TRY(io::ActionResult result, io::run_action(session.scene(), session.registry(), entry, run));
    return apply_action(session, std::move(result));
}

} // namespace restage::document
