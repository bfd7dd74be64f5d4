// SPDX-License-Identifier: Apache-2.0
// Collections: the tables of a scene as Python sees them; session.materials["Oak"], for light in session.lights.
#include "collections.hpp"

#include "scene/merge.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <limits>

namespace restage::python {

using namespace scene;

namespace {

// Edit distance, for "did you mean". Levenshtein 1966.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = diagonal + (std::tolower(a[i - 1]) != std::tolower(b[j - 1]));
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
        }
    }
    return row[b.size()];
}

template <class T>
std::vector<Handle<T>> all(const Collection<T>& c) {
    std::vector<Handle<T>> out;
    table<T>(c.in->scene()).each([&](Id<T> id, const T&) { out.push_back({c.in, id}); });
    return out;
}

template <class T>
std::vector<std::string> names(const Collection<T>& c) {
    std::vector<std::string> out;
    table<T>(c.in->scene()).each([&](Id<T>, const T& item) { out.push_back(item.name); });
    return out;
}

template <class T>
std::string word_of() { // the name in Python
    return std::is_same_v<T, Instance> ? "object" : std::string(kind_name<T>);
}

template <class T>
nb::builtin_exception not_there(const Collection<T>& c, const std::string& name) {
    std::string sentence = "there is no " + word_of<T>() + " called \"" + name + "\"";
    const std::string near = nearest_name(names(c), name);
    if (!near.empty()) sentence += "; did you mean \"" + near + "\"?";
    return nb::key_error(sentence.c_str());
}

template <class T>
void bind(nb::module_& m, const char* name, const char* element) {
    using C = Collection<T>;
    const std::string list_of = std::string("list[") + element + "]";
    const auto sig = [](const std::string& text) { return text; };
    const std::string iter_sig = sig("def __iter__(self) -> collections.abc.Iterator[" + std::string(element) + "]");
    nb::class_<C>(m, name, "All things of one kind in a scene: by name, by position, or by iteration.")
        .def("__len__", [](const C& c) { return table<T>(c.in->scene()).live(); })
        .def(
            "__iter__", [](const C& c) { return nb::iter(nb::cast(all(c))); }, nb::sig(iter_sig.c_str()))
        .def("__contains__",
             [](const C& c, const std::string& wanted) { return bool(find_by_name<T>(c.in->scene(), wanted)); })
        .def(
            "__getitem__",
            [](const C& c, const std::string& wanted) {
                const Id<T> id = find_by_name<T>(c.in->scene(), wanted);
                if (!id) throw not_there(c, wanted);
                return Handle<T>{c.in, id};
            },
            "name"_a, "The first of that name; KeyError if there is none.")
        .def(
            "__getitem__",
            [](const C& c, long index) {
                const auto list = all(c);
                const auto count = static_cast<long>(list.size()), at = index < 0 ? index + count : index;
                if (at < 0 || at >= count)
                    throw nb::index_error(
                        fmt::format("there is no {} {}: there are {}, counted from 0", word_of<T>(), index, count)
                            .c_str());
                return list[static_cast<std::size_t>(at)];
            },
            "index"_a, "By position, in the order of the file.")
        .def(
            "by_id",
            [](const C& c, std::uint32_t number) {
                const Handle<T> h{c.in, {number}};
                (void)h.get();
                return h;
            },
            "id"_a, "The one with this id, as in Picture.object_id and Picture.material_id.")
        .def(
            "match",
            [](const C& c, const std::string& pattern) {
                const nb::object fits = nb::module_::import_("fnmatch").attr("fnmatchcase");
                std::vector<Handle<T>> found;
                for (const auto& h : all(c))
                    if (nb::cast<bool>(fits(h.get().name, pattern))) found.push_back(h);
                return found;
            },
            "pattern"_a, "Those whose names match a shell pattern: \"Chair*\".")
        .def_prop_ro("names", &names<T>, "Their names, in order.")
        .def("__repr__", [list_of](const C& c) {
            return "<restage " + list_of + ", " +
                   (c.in->closed() ? "closed" : std::to_string(table<T>(c.in->scene()).live())) + ">";
        });
}

} // namespace

std::string nearest_name(const std::vector<std::string>& names, const std::string& name) {
    std::string best;
    std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
    for (const std::string& other : names)
        if (const std::size_t d = edit_distance(name, other); d < least) {
            least = d;
            best = other;
        }
    return best;
}

void bind_collections(nb::module_& m) {
    bind<Instance>(m, "Objects", "Object");
    bind<Group>(m, "Groups", "Group");
    bind<Material>(m, "Materials", "Material");
    bind<Texture>(m, "Textures", "Texture");
    bind<Light>(m, "Lights", "Light");
    bind<Camera>(m, "Cameras", "Camera");
}

} // namespace restage::python
