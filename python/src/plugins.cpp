// SPDX-License-Identifier: Apache-2.0
// Plugins and reports for Python.
#include "host.hpp"
#include "plugin/provides.hpp"
#include "workspace.hpp"

namespace restage::python {

namespace {

struct PluginInfo { // a copy: the state at the time of the call
    std::string id, version, kind, licence, reason;
    std::filesystem::path folder;
    bool loaded = false;
    std::vector<std::string> provides;
};

std::vector<PluginInfo> describe(const std::vector<const plugin::Entry*>& entries) {
    std::vector<PluginInfo> out;
    for (const plugin::Entry* e : entries)
        out.push_back({.id = e->manifest.id,
                       .version = e->manifest.version,
                       .kind = e->manifest.kind(),
                       .licence = e->manifest.licence,
                       .reason = e->reason,
                       .folder = e->folder,
                       .loaded = e->state == plugin::State::loaded,
                       .provides = plugin::provides(Host::get()->registry(), *e)});
    return out;
}

void bind_report(nb::module_& m) {
    nb::class_<io::ReportEntry>(m, "ReportEntry", "The fate of one thing in a file.")
        .def_prop_ro(
            "fate", [](const io::ReportEntry& e) { return io::to_string(e.fate); }, "kept, approximated or dropped.")
        .def_ro("file", &io::ReportEntry::file, "The file, or \"\".")
        .def_ro("line", &io::ReportEntry::line, "The line; 0 = the whole file.")
        .def_ro("what", &io::ReportEntry::what, "The thing: 'material \"oak\"'.")
        .def_ro("note", &io::ReportEntry::note, "What was lost, or \"\".")
        .def("__repr__", [](const io::ReportEntry& e) { return "<restage.ReportEntry " + io::to_string(e) + ">"; })
        .def("__str__", [](const io::ReportEntry& e) { return io::to_string(e); });
    nb::class_<io::Report>(m, "Report", "The fates of the things in a file on import or export.")
        .def_ro("entries", &io::Report::entries, "All lines: a list of ReportEntry.")
        .def_prop_ro(
            "kept", [](const io::Report& r) { return r.count(io::Fate::kept); }, "Number of things kept.")
        .def_prop_ro(
            "approximated", [](const io::Report& r) { return r.count(io::Fate::approximated); },
            "Number of things approximated.")
        .def_prop_ro(
            "dropped", [](const io::Report& r) { return r.count(io::Fate::dropped); }, "Number of things dropped.")
        .def("__len__", [](const io::Report& r) { return r.entries.size(); })
        .def("__str__",
             [](const io::Report& r) {
                 std::string text;
                 for (const auto& e : r.entries)
                     text += io::to_string(e) + "\n";
                 return text;
             })
        .def("__repr__", [](const io::Report& r) {
            return "<restage.Report: " + std::to_string(r.count(io::Fate::kept)) + " kept, " +
                   std::to_string(r.count(io::Fate::approximated)) + " approximated, " +
                   std::to_string(r.count(io::Fate::dropped)) + " dropped>";
        });
}

} // namespace

void bind_plugins(nb::module_& m) {
    bind_report(m);
    nb::class_<PluginInfo>(m, "Plugin", "A plugin that was found.")
        .def_ro("id", &PluginInfo::id, "\"org.example.velvet\".")
        .def_ro("version", &PluginInfo::version, "Its own version.")
        .def_ro("kind", &PluginInfo::kind, "material, importer, exporter or denoiser.")
        .def_ro("licence", &PluginInfo::licence, "Licence, from its manifest.")
        .def_ro("folder", &PluginInfo::folder, "Its folder.")
        .def_ro("loaded", &PluginInfo::loaded, "False: it was refused, and `reason` says why.")
        .def_ro("reason", &PluginInfo::reason, "Why it was refused, one sentence; else \"\".")
        .def_ro("provides", &PluginInfo::provides, "\"material velvet\", ...")
        .def("__repr__", [](const PluginInfo& p) {
            return "<restage.Plugin " + (p.id.empty() ? p.folder.string() : p.id) + " " + p.version +
                   (p.loaded ? ">" : " REFUSED: " + p.reason + ">");
        });
    m.def(
        "plugins", [] { return describe(Host::get()->registry().entries()); },
        "All plugins found, including refused ones: a list of Plugin.");
    m.def(
        "load_plugins",
        [](const std::filesystem::path& folder) {
            const auto found = Host::get()->load(folder);
            for (const plugin::Entry* entry : found)
                if (entry->state != plugin::State::loaded) throw Failure(entry->reason);
            return describe(found);
        },
        "folder"_a,
        "Loads the plugins in a folder (one with a plugin.json, or up to three folders above such). Returns them;\n"
        "raises restage.Error with the reason if one is refused.");
    m.def(
        "reload_plugins",
        [] {
            nb::dict news;
            const auto host = Host::get();
            for (const plugin::Reload& reload : host->registry().reload_changed())
                news[nb::cast(reload.plugin->name())] = nb::cast(reload.error);
            host->flush_log();
            return news;
        },
        nb::sig("def reload_plugins() -> dict[str, str]"),
        "Reloads the material plugins whose files have changed. Also while a session renders: its next\n"
        "render uses the new version. Returns, by id, \"\" or why the new version was refused (the previous one stays\n"
        "in use): an error in its GLSL with file and line, for example.");
}

} // namespace restage::python
