// SPDX-License-Identifier: Apache-2.0
// Looks of a session: document/looks.hpp.
#include "document/looks.hpp"
#include "collections.hpp"
#include "document/variants.hpp"
#include "values.hpp"
#include "work.hpp"

#include <limits>

namespace restage::python {

namespace {

std::vector<std::string> names(Workspace& w) {
    std::vector<std::string> list;
    for (const document::Look& look : w.session().looks().list)
        list.push_back(look.name);
    return list;
}

std::size_t index_of(Workspace& w, const std::string& name) {
    const auto& list = w.session().looks().list;
    for (std::size_t i = 0; i < list.size(); ++i)
        if (list[i].name == name) return i;
    const std::string near = nearest_name(names(w), name);
    throw nb::key_error(
        ("there is no look called \"" + name + "\"" + (near.empty() ? "" : "; did you mean \"" + near + "\"?"))
            .c_str());
}

} // namespace

void bind_looks(nb::class_<Workspace>& c) {
    c.def_prop_ro("looks", &names,
                  "Names of the looks, in order: named variations of the document. See Session.new_look.")
        .def_prop_ro(
            "look",
            [](Workspace& w) -> std::optional<std::string> {
                const document::Looks& looks = w.session().looks();
                if (looks.current >= looks.list.size()) return std::nullopt;
                return looks.list[looks.current].name;
            },
            "The look recorded or gone to last, or None. The scene may have changed since.")
        .def(
            "new_look", [](Workspace& w, const std::string& name) { take(document::new_look(w.session(), name)); },
            "name"_a = "",
            "Records how things are now as a new look: places, visibility, materials and their values, lights, sky,\n"
            "exposure, camera. name: \"\" = \"Look 1\", \"Look 2\" ... One undo step, as are the other changes of "
            "looks.")
        .def(
            "looks_from_variants",
            [](Workspace& w) {
                const auto names = document::variants_of(w.session());
                const auto read = work(w.host(), nb::none(), [&](io::Progress) {
                    return document::read_variants(w.session().base(), names, w.host().registry());
                });
                return take(document::looks_from_variants(w.session(), read));
            },
            "A look for each material variant of a glTF file, in which only materials differ from how things are now; "
            "returns their names.\nError: the file has none.")
        .def(
            "go_to_look",
            [](Workspace& w, const std::string& name) {
                return take(document::go_to_look(w.session(), index_of(w, name)));
            },
            "name"_a,
            "Makes the scene look as recorded. Objects made since are hidden; those removed since are returned by "
            "name.\nKeyError: there is no such look.")
        .def(
            "update_look",
            [](Workspace& w, const std::string& name) { take(document::update_look(w.session(), index_of(w, name))); },
            "name"_a, "Records how things are now under this name. KeyError: there is no such look.")
        .def(
            "rename_look",
            [](Workspace& w, const std::string& name, std::string to) {
                take(document::rename_look(w.session(), index_of(w, name), std::move(to)));
            },
            "name"_a, "to"_a, "Gives a look another name. KeyError: there is no such look.")
        .def(
            "remove_look",
            [](Workspace& w, const std::string& name) { take(document::remove_look(w.session(), index_of(w, name))); },
            "name"_a, "Deletes a look; the scene stays as it is. KeyError: there is no such look.");
}

} // namespace restage::python
