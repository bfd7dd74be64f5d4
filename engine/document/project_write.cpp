// SPDX-License-Identifier: Apache-2.0
// Writes differences from the base as JSON: removed items by reference, changed ones by the fields that differ,
// new ones by the fields that are not default.
#include "document/looks.hpp"
#include "document/project.hpp"
#include "document/project_fields.hpp"
#include "document/project_json.hpp"

#include "base/file.hpp"
#include "base/json.hpp"
#include "io/sun_disk.hpp"
#include "scene/links.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace restage::document {

using namespace scene;

namespace {

constexpr std::uint32_t coarse_sky_width = 32; // 12 KiB: enough for its light, too coarse to show the sun

class Writer {
  public:
    // `linked`: with its links, which the content's scene is without.
    Writer(const ProjectContent& content, const Scene& linked, const std::filesystem::path& folder)
        : content_(content), linked_(linked), folder_(folder) {
        // New items are numbered consecutively after the base's: holes left by undone edits are not differences.
        each_kind([&]<class T>(const Kind<T>& kind) {
            const auto& base = content.base.scene.*kind.table;
            std::uint32_t next = base.size();
            auto& numbers = numbers_[kind.name];
            (content.scene.*kind.table).each([&](Id<T> id, const T&) {
                if (id.value > base.size()) numbers[id.value] = ++next;
            });
            sizes_[kind.plural] = base.size();
        });
        content.base.scene.meshes.each([&](Id<Mesh> id, const Mesh& m) { known_[m.data.get()] = {{"of", ref(id)}}; });
        content.base.scene.images.each([&](Id<Image> id, const Image& i) { known_[i.data.get()] = {{"of", ref(id)}}; });
        const auto note_sky = [&](const Scene& scene) {
            if (const auto& sky = scene.environment.value; sky && !sky->sky.empty())
                if (const Image* image = scene.images.find(sky->image)) skies_.insert(image->data.get());
        };
        note_sky(content.scene);
        if (content.looks)
            for (const Look& look : content.looks->list)
                note_sky(*look.state);
    }

    json document() {
        json j;
        j["restage"] = project_version;
        if (content_.note)
            for (const auto& [key, text] : *content_.note)
                j["recovery"][key] = text;
        if (!content_.base.file.empty()) {
            path_in(j["base"]["file"], content_.base.file);
            j["base"]["format"] = content_.base.format;
            if (!content_.base.options.entries().empty()) j["base"]["options"] = to_json(content_.base.options);
            j["base"]["hash"] = fmt::format("{:016x}", content_.base.hash);
            j["base"]["sizes"] = sizes_;
        }
        const Scene &base = content_.base.scene, &now = content_.scene;
        each_single([&]<class T>(const Single<T>& single) {
            const T &before = (base.*single.one).value, &after = (now.*single.one).value;
            if constexpr (std::is_same_v<T, Id<Camera>>) {
                if (before != after) j[single.name] = ref(after);
            } else {
                changed_single(j, single.name, before, after);
            }
        });
        each_kind([&]<class T>(const Kind<T>& kind) {
            json part = things<T>();
            if (!part.empty()) j[kind.plural] = std::move(part);
        });
        if (content_.looks && !content_.looks->list.empty()) j["looks"] = looks(*content_.looks);
        for (const Id<Group> id : all_links(linked_))
            j["links"].push_back(link(id));
        return j;
    }

    // --- as a visitor of fields()
    // -------------------------------------------------------------------------------------
    template <class T>
    void operator()(const char* name, T& value) {
        (*out_)[name] = to_json(value);
    }
    void path(const char* name, std::string& path) { path_in((*out_)[name], path); }
    void mesh(Mesh& m) {
        (*out_)["data"] = data(m.data.get(), "mesh", [&] { return inline_mesh(*m.data); });
    }
    void image(Image& i) {
        if (const auto found = known_.find(i.data.get()); i.data && found != known_.end())
            (*out_)["pixels"] = found->second;
        else if (!i.path.empty())
            (*out_)["pixels"] = "file"; // it is read from its path
        else if (i.data &&
                 skies_.contains(i.data.get())) // it is regenerated; this coarse copy is used if its plugin is missing
            (*out_)["pixels"] = {{"sky", inline_image(io::coarse_sky(*i.data, coarse_sky_width))}};
        else
            (*out_)["pixels"] = data(i.data.get(), "image", [&] { return inline_image(*i.data); });
    }

  private:
    template <class T>
    std::string ref(Id<T> id) const {
        const auto& base = table<T>(content_.base.scene);
        const bool old = id.value <= base.size();
        const T* item = old ? base.find(id) : table<T>(content_.scene).find(id);
        if (!item) return "";
        return fmt::format("#{} {}", old ? id.value : numbers_.at(kind_name<T>).at(id.value), item->name);
    }
    void path_in(json& out, const std::string& path) const {
        const std::filesystem::path p(path);
        if (folder_.empty() || !p.is_absolute()) {
            out = path;
            return;
        }
        const auto relative = p.lexically_relative(folder_);
        out = relative.empty() ? p.generic_string() : relative.generic_string();
    }
    template <class F>
    json data(const void* pointer, const char* which, F&& inline_data) {
        if (!pointer) return nullptr;
        if (const auto found = known_.find(pointer); found != known_.end()) return found->second;
        known_[pointer] = {{"same_as", current_}}; // for others that share it
        if (const DataSource* source = content_.sources.find(pointer)) {
            json j;
            path_in(j["file"], source->file);
            j["format"] = source->format;
            if (!source->options.entries().empty()) j["options"] = to_json(source->options);
            j[which] = fmt::format("#{} {}", source->id, source->name);
            return j;
        }
        return inline_data();
    }

    // --- values
    // --------------------------------------------------------------------------------------------------------
    static json to_json(const std::string& s) { return s; }
    static json to_json(bool b) { return b; }
    static json to_json(std::uint32_t n) { return n; }
    static json to_json(float x) { return number_json(x); }
    static json to_json(double x) { return number_json(x); }
    template <int N, class T>
    static json to_json(const glm::vec<N, T>& v) {
        json j = json::array();
        for (int i = 0; i < N; ++i)
            j.push_back(number_json(v[i]));
        return j;
    }
    static json to_json(const glm::dmat4& m) { // its columns
        json j = json::array();
        for (int c = 0; c < 4; ++c)
            j.push_back(to_json(m[c]));
        return j;
    }
    template <class T>
    json to_json(Id<T> id) {
        return id ? json(ref(id)) : json(nullptr);
    }
    template <class E>
        requires std::is_enum_v<E>
    static json to_json(E e) {
        const int i = int(e) - Names<E>::first;
        return i >= 0 && i < int(std::size(Names<E>::list)) ? json(Names<E>::list[i]) : json(int(e));
    }
    template <class T>
    json to_json(const std::optional<T>& x) {
        return x ? to_json(*x) : json(nullptr);
    }
    template <class T>
        requires std::is_class_v<T>
    json to_json(const T& item) {
        json j;
        json* const outer = std::exchange(out_, &j);
        T copy = item;
        fields(*this, copy);
        out_ = outer;
        return j;
    }
    json to_json(const std::vector<OriginValue>& list) {
        json j = json::array();
        for (const OriginValue& value : list)
            j.push_back({value.id, value.text});
        return j;
    }
    json to_json(const Value& v) {
        std::size_t used = 4;
        while (used > 0 && v.v[used - 1] == 0 && !std::signbit(v.v[used - 1]))
            --used;
        const bool plain = !v.texture && !v.material;
        const auto list = [&](std::size_t n) {
            json j = json::array();
            for (std::size_t i = 0; i < n; ++i)
                j.push_back(number_json(v.v[i]));
            return j;
        };
        // A short form for the most common.
        if (plain && v.text.empty()) {
            if (v.type == model::ParamType::number && used <= 1) return number_json(v.v[0]);
            if (v.type == model::ParamType::color && used <= 3) return list(3);
            if (v.type == model::ParamType::boolean && (v.i == 0 || v.i == 1)) return v.i == 1;
        }
        if (plain && v.type == model::ParamType::text && used == 0) return v.text;
        json j;
        j["type"] = type_names[std::size_t(v.type)];
        if (v.is_whole() && v.i != 0) j["v"] = json::array({v.i});
        if (used > 0) j["v"] = list(used);
        if (!v.text.empty()) {
            if (v.type == model::ParamType::table)
                path_in(j["file"], v.text);
            else
                j["text"] = v.text;
        }
        if (v.texture) j["texture"] = ref(v.texture);
        if (v.material) j["material"] = ref(v.material);
        return j;
    }
    json to_json(const ParamSet& params) {
        json j = json::object();
        for (const auto& [id, value] : params.entries())
            j[id] = to_json(value);
        return j;
    }

    // --- differences
    // --------------------------------------------------------------------------------------------------- Those members
    // of `now` that are not in `before`; null where only `before` has one.
    static json difference(const json& before, const json& now) {
        json j = json::object();
        for (const auto& [key, value] : now.items()) {
            const auto old = before.find(key);
            if (old == before.end() || *old != value) j[key] = value;
        }
        return j;
    }
    // Values one by one, if setting them in sequence gives the same order.
    void shorten_params(json& changed, const ParamSet& before, const ParamSet& now) {
        if (!changed.contains("params")) return;
        ParamSet replay = before;
        json j = json::object();
        for (const auto& [id, value] : before.entries())
            if (!now.find(id)) {
                replay.remove(id);
                j[id] = nullptr;
            }
        for (const auto& [id, value] : now.entries())
            if (const Value* old = before.find(id); !old || !(*old == value)) {
                replay.set(id, value);
                j[id] = to_json(value);
            }
        if (replay == now)
            changed["params"] = std::move(j);
        else {
            changed["all_params"] = to_json(now);
            changed.erase("params");
        }
    }

    template <class T>
    void changed_single(json& j, const char* name, const T& before, const T& now) {
        if (before == now) return;
        const json a = to_json(before), b = to_json(now);
        j[name] = a.is_object() && b.is_object() ? difference(a, b) : b;
    }

    template <class T>
    json things() {
        const auto &base = table<T>(content_.base.scene), &now = table<T>(content_.scene);
        json removed = json::array(), changed, added;
        for (std::uint32_t i = 1; i <= std::max(base.size(), now.size()); ++i) {
            const Id<T> id{i};
            const T *before = base.find(id), *after = now.find(id);
            if (before && after ? *before == *after : !before && !after) continue;
            current_ = ref(id);
            if (!after)
                removed.push_back(current_);
            else if (!before)
                added[current_] = difference(to_json(T{}), to_json(*after));
            else {
                json d = difference(to_json(*before), to_json(*after));
                if constexpr (std::is_same_v<T, Material> || std::is_same_v<T, Texture>)
                    shorten_params(d, before->params, after->params);
                if (!d.empty()) changed[current_] = std::move(d);
            }
        }
        json part;
        if (!removed.empty()) part["removed"] = std::move(removed);
        if (!changed.empty()) part["changed"] = std::move(changed);
        if (!added.empty()) part["added"] = std::move(added);
        return part;
    }

    // Its file and where it stands: the objects are read again.
    json link(Id<Group> id) {
        const Group& group = linked_.groups[id];
        const LinkSource source = *link_source(group);
        json j{{"name", group.name}};
        path_in(j["file"], source.file);
        j["format"] = source.format;
        if (!source.options.empty()) j["options"] = source.options;
        j["place"] = to_json(place_of(linked_, id));
        const std::vector<Id<Instance>> objects = objects_of(linked_, id);
        if (std::ranges::all_of(objects, [&](Id<Instance> one) { return linked_.instances[one].hidden; }))
            j["hidden"] = true;
        if (content_.scene.groups.find(group.parent)) j["group"] = ref(group.parent);
        return j;
    }

    // Each as what changes when one goes to it.
    json looks(const Looks& looks) {
        json list = json::array();
        for (std::size_t i = 0; i < looks.list.size(); ++i) {
            json j;
            j["name"] = looks.list[i].name;
            if (i == looks.current) j["current"] = true;
            for (const AnyChange& change : look_change(content_.scene, looks.list[i]).edit.changes)
                std::visit([&](const auto& c) { look_part(j, c); }, change);
            list.push_back(std::move(j));
        }
        return list;
    }
    template <class T>
    void look_part(json& j, const Change<T>& c) {
        if (std::is_same_v<T, Image> || !c.before || !c.after) return; // skies are made again
        json d = difference(to_json(*c.before), to_json(*c.after));
        if constexpr (std::is_same_v<T, Material> || std::is_same_v<T, Texture>)
            shorten_params(d, c.before->params, c.after->params);
        if (!d.empty()) j[std::get<Kind<T>>(kinds).plural][ref(c.id)] = std::move(d);
    }
    template <class T>
    void look_part(json& j, const ChangeOne<T>& c) {
        const char* name = std::get<Single<T>>(singles).name;
        if constexpr (std::is_same_v<T, Id<Camera>>)
            j[name] = ref(c.after);
        else
            changed_single(j, name, c.before, c.after);
    }

    const ProjectContent& content_;
    const Scene& linked_;
    const std::filesystem::path& folder_;
    json sizes_;
    std::map<std::string, std::map<std::uint32_t, std::uint32_t>> numbers_; // by kind: id -> number in the file
    std::map<const void*, json> known_; // data -> its holder
    std::set<const void*> skies_; // pixels generated by sky plugins
    std::string current_;
    json* out_ = nullptr;
};

// Members unknown when the file was read are written back in place, unless the place is gone.
void put_back(json& into, const json& unknown) {
    for (const auto& [key, value] : unknown.items()) {
        const auto found = into.find(key);
        if (found == into.end()) {
            if (!value.is_object() || !value.contains(place_mark)) into[key] = value;
        } else if (found->is_object() && value.is_object())
            put_back(*found, value);
    }
}

} // namespace

std::string project_text(const ProjectContent& content, const std::filesystem::path& folder) {
    const Scene own = without_links(content.scene);
    const Scene whole = content.looks ? with_kept(own, *content.looks) : own;
    const ProjectContent kept{.base = content.base,
                              .scene = whole,
                              .sources = content.sources,
                              .unknown = content.unknown,
                              .looks = content.looks,
                              .note = content.note};
    json j = Writer(kept, content.scene, folder).document();
    if (!content.unknown.empty()) {
        json unknown = parse_json<json>(content.unknown).value_or(json());
        if (unknown.is_object()) put_back(j, unknown);
    }
    erase_marks(j);
    return pretty(j);
}

} // namespace restage::document
