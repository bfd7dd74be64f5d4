// SPDX-License-Identifier: Apache-2.0
#include "document/linking.hpp"

#include "io/options.hpp"

#include <filesystem>
#include <utility>

namespace restage::document {

using namespace scene;

Result<Merged> link(Session& session, const io::ImportedScene& imported, const std::string& file,
                    const std::optional<Session::Stand>& stand) {
    const std::filesystem::path path = std::filesystem::absolute(file).lexically_normal();
    LinkSource source{.file = path.string(), .format = imported.importer, .options = {}};
    for (const auto& [id, value] : imported.options.entries())
        source.options.push_back(id + "=" + io::option_text(value));
    io::ImportedScene linked = imported;
    linked.scene = as_link(imported.scene, path.stem().string(), source);
    if (imported.scene.lights.live() > 0)
        linked.report.add(io::Fate::dropped, "lights", "a link shows the objects of its file only", path.string());
    return session.insert(linked, path.string(), stand);
}

ReadOptions reading_of(const LinkSource& source, const plugin::Registry& registry) {
    ParamSet given;
    for (const std::string& option : source.options)
        (void)io::set_text_option(option, given); // written by link()
    ParamSet options;
    if (const auto importer = registry.find_importer(source.format))
        for (const auto& [id, value] : given.entries())
            if (auto fits = io::fitting_option(*importer->table, id, value)) options.set(id, std::move(*fits));
    return {.expose = false, .import_options = std::move(options)};
}

Result<> reload_link(Session& session, Id<Group> id, const io::ImportedScene& imported) {
    const Group* link = session.scene().groups.find(id);
    const auto source = link ? link_source(*link) : std::nullopt;
    if (!source) return fail((link ? '"' + link->name + '"' : "the group") + " is not linked from a file");
    if (imported.scene.instances.live() == 0) return fail(source->file + ": contains no objects");
    RESTAGE_CHECK(session.edit(replace_link(session.scene(), id, as_link(imported.scene, link->name, *source))));
    return {};
}

} // namespace restage::document
