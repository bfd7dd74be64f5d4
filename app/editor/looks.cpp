// SPDX-License-Identifier: Apache-2.0
#include "looks.hpp"

#include "contexts.hpp"
#include "document/looks.hpp"
#include "document/variants.hpp"
#include "files.hpp"
#include "panel_context.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <memory>

namespace restage::editor {

using document::Looks;

namespace {

// Says what a request of looks could not do.
template <class T>
void report(SelectContext& e, const Result<T>& done) {
    if (!done) e.notices.add(LogLevel::error, done.error().message);
}

} // namespace

scene::Scene scene_as_seen(const SelectContext& e) {
    scene::Scene seen = e.scene();
    if (const auto id = seen.active_camera.value; e.views.now() && seen.cameras.find(id))
        seen.cameras.set(id, e.camera(), ++seen.clock);
    return seen;
}

void new_look(SelectContext& e) {
    e.change([&e](document::Session& s) {
        const scene::Camera camera = e.camera();
        report(e, document::new_look(s, "", &camera));
    });
}

void update_look(SelectContext& e, std::size_t index) {
    e.change([&e, index](document::Session& s) {
        const scene::Camera camera = e.camera();
        report(e, document::update_look(s, index, &camera));
    });
}

void go_to_look(SelectContext& e, std::size_t index) {
    e.change([&e, index](document::Session& s) {
        const auto went = document::go_to_look(s, index);
        report(e, went);
        if (!went) return;
        e.views.go(std::nullopt);
        if (!went->empty())
            e.notices.add(LogLevel::warning, fmt::format("Removed since the look was recorded, and so left out: {}",
                                                         fmt::join(*went, ", ")));
    });
}

void step_look(SelectContext& e, int by) {
    const Looks& looks = e.session().looks();
    const auto count = int(looks.list.size());
    if (count == 0) return;
    const int from = looks.current == Looks::none ? (by > 0 ? -1 : 0) : int(looks.current);
    go_to_look(e, std::size_t((from + by + count) % count));
}

bool has_variants(const DocumentContext& e) { return !document::variants_of(e.session()).empty(); }

void looks_from_variants(DocumentContext& e) {
    e.files().jobs.start(
        {.title = "Reading the variants"},
        [names = document::variants_of(e.session()), base = e.session().base(), document = e.document(),
         &registry = e.registry(),
         isolate = e.options().isolate](BackgroundJob&) -> std::function<void(PanelContext&)> {
            auto read = document::read_variants(base, names, registry, {.isolate = isolate});
            if (!read)
                return [message = read.error().message](PanelContext& editor) {
                    editor.notices.add(LogLevel::error, message);
                };
            return [document, variants = std::make_shared<const std::vector<document::Variant>>(std::move(*read))](
                       PanelContext& editor) {
                if (editor.document() != document) return; // another one is open now
                editor.change([&editor, variants](document::Session& session) {
                    const auto made = document::looks_from_variants(session, *variants);
                    report(editor, made);
                    if (made) editor.notices.add(LogLevel::info, fmt::format("New looks: {}", fmt::join(*made, ", ")));
                });
            };
        });
}

bool has_looks(const DocumentContext& e) { return !e.session().looks().list.empty(); }

bool has_current_look(const DocumentContext& e) { return e.session().looks().current != Looks::none; }

std::string difference_from_look(const SelectContext& e, std::size_t index) {
    const document::LookChange change = document::look_change(scene_as_seen(e), e.session().looks().list[index]);
    struct Count {
        std::string one, several;
        int count = 0;
    };
    std::map<std::string_view, Count> counts; // of tables' items
    std::vector<std::string> parts;
    for (const scene::AnyChange& one : change.edit.changes)
        std::visit(
            [&]<class C>(const C& c) {
                if constexpr (std::is_same_v<C, scene::Change<scene::Image>>)
                    return; // of the sky
                else if constexpr (requires { c.id; }) {
                    using Item = std::remove_cvref_t<decltype(*c.before)>;
                    if (!c.before) return; // brought back with what uses it
                    constexpr auto kind = std::get<scene::Kind<Item>>(scene::kinds);
                    const bool object = std::is_same_v<Item, scene::Instance>;
                    Count& count = counts[kind.name];
                    count = {object ? "object" : kind.name, object ? "objects" : kind.plural, count.count + 1};
                } else if constexpr (std::is_same_v<C, scene::ChangeOne<std::optional<scene::Environment>>>)
                    parts.emplace_back("sky");
                else if constexpr (std::is_same_v<C, scene::ChangeOne<scene::Film>>)
                    parts.emplace_back("exposure");
                else
                    counts[scene::kind_name<scene::Camera>] = {.one = "camera", .several = "cameras", .count = 1};
            },
            one);
    for (const auto& [kind, count] : counts)
        parts.push_back(kind == scene::kind_name<scene::Camera>
                            ? count.one
                            : fmt::format("{} {}", count.count, count.count > 1 ? count.several : count.one));
    return fmt::format("{}", fmt::join(parts, ", "));
}

} // namespace restage::editor
