// SPDX-License-Identifier: Apache-2.0
// Reads a project file as its reimported base and one edit. References are found by id and name; if the base has
// changed, by name alone; missing items are errors that name them, or are skipped on request.
#include "document/project.hpp"
#include "document/project_looks.hpp"
#include "document/project_values.hpp"

#include "base/file.hpp"
#include "base/json.hpp"
#include "io/image_file.hpp"
#include "io/material_tables.hpp"
#include "io/options.hpp"
#include "io/sky.hpp"
#include "scene/bounds.hpp"
#include "scene/links.hpp"
#include "scene/merge.hpp"
#include "scene/validate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <set>
#include <utility>

namespace restage::document {

using namespace scene;
namespace fs = std::filesystem;

namespace {

// Placeholders for missing geometry or pixels: a cube, a grey pixel.
std::shared_ptr<const MeshData> stand_in_mesh() {
    auto mesh = std::make_shared<MeshData>();
    for (int i = 0; i < 8; ++i)
        mesh->positions.push_back(glm::vec3(i & 1, i >> 1 & 1, i >> 2) - 0.5f);
    mesh->triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    compute_bounds(*mesh);
    return mesh;
}
std::shared_ptr<const PixelData> stand_in_pixels() {
    return std::make_shared<const PixelData>(
        PixelData{.width = 1, .height = 1, .channels = 3, .values = {0.5f, 0.5f, 0.5f}});
}

std::string lower(std::string text) {
    for (char& c : text)
        c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    return text;
}

class Reader : public ValueReader {
  public:
    Reader(const std::string& path, const plugin::Registry& registry, const ReadOptions& options)
        : ValueReader(path), path_(path), registry_(registry), options_(options) {
        base_ = &doc_.base.scene;
    }

    Result<Document> run() {
        RESTAGE_TRY(const std::string text, read_file(path_));
        return run(text);
    }

    Result<Document> run(const std::string& text) {
        doc_.path = path_;
        RESTAGE_TRY(const json j, parse(text));
        if (const auto note = j.find("recovery"); note != j.end() && note->is_object())
            for (const auto& [key, value] : note->items())
                if (value.is_string()) doc_.note[key] = value.get<std::string>();
        if (const auto base = j.find("base"); base != j.end()) RESTAGE_CHECK(read_base(*base));

        json unknown = json::object();
        std::set<std::string_view> known{"restage", "recovery", "base", "looks", "links"};
        each_kind([&]<class T>(const Kind<T>& kind) {
            known.insert(kind.plural);
            if (const auto part = j.find(kind.plural); part != j.end()) read_things<T>(kind.plural, *part, unknown);
        });
        const Scene& base = doc_.base.scene;
        each_single([&](const auto& single) {
            known.insert(single.name);
            read_single(j, single.name, (base.*single.one).value, unknown);
        });
        for (const auto& [key, value] : j.items())
            if (!known.contains(key)) unknown[key] = value;
        if (!unknown.empty()) doc_.unknown = unknown.dump();

        if (!error_.empty()) return fail(error_);
        RESTAGE_CHECK(judge_lost());
        read_images();
        make_sky();
        doc_.changes.label = "Changes of " + fs::path(path_).filename().string();
        Scene result = base;
        apply(result, doc_.changes);
        if (const auto links = j.find("links"); links != j.end()) RESTAGE_CHECK(read_links(*links, result));
        for (const Problem& problem : validate(result))
            if (problem.severity == Problem::Severity::error && problem.sentence != no_camera) // it may still get one
                return fail(path_ + ": " + problem.sentence);
        io::report_tables(result, registry_, doc_.report, &base);
        if (const auto looks = j.find("looks"); looks != j.end()) {
            LookReader reader(path_, registry_, base, sizes_);
            RESTAGE_TRY(doc_.looks, reader.run(*looks, result, doc_.report));
        }
        return std::move(doc_);
    }

    using ValueReader::operator();

    // --- as a visitor of fields()
    // --------------------------------------------------------------------------------------
    void path(const char* name, std::string& value) {
        const json* j = member(name);
        if (!j) return;
        read(*j, value, name);
        if (!value.empty()) value = absolute(value);
    }
    void mesh(Mesh& m) {
        const json* j = member("data");
        if (!j) return;
        if (j->is_null())
            m.data = nullptr;
        else if (const auto data = shared<Mesh>(*j, "mesh", stand_in_mesh, new_meshes_))
            m.data = data;
        else if (auto inlined = read_inline_mesh(*j))
            m.data = new_meshes_[current_] = *inlined;
        else
            error("data", inlined.error().message);
    }
    void image(Image& i) {
        const json* j = member("pixels");
        if (!j) return;
        i.data = nullptr;
        if (*j == "file")
            from_file_.insert(current_id_);
        else if (j->is_null())
            return;
        else if (j->is_object() && j->contains("sky")) {
            sky_images_.insert(current_id_);
            const auto coarse = read_inline_image((*j)["sky"]);
            i.data = coarse ? *coarse : stand_in_pixels();
        } else if (const auto data = shared<Image>(*j, "image", stand_in_pixels, new_images_))
            i.data = data;
        else if (auto inlined = read_inline_image(*j))
            i.data = new_images_[current_] = *inlined;
        else
            error("pixels", inlined.error().message);
    }

  private:
    Result<json> parse(const std::string& text) const {
        auto parsed = parse_json<json>(text);
        if (!parsed) return fail(path_ + ":" + parsed.error().message + "; not a project file, or damaged");
        json& j = *parsed;
        const auto version = j.is_object() ? j.find("restage") : j.end();
        if (!j.is_object() || version == j.end() || !version->is_number_integer())
            return fail(path_ + ": this is JSON, but not a Restage project");
        if (version->get<int>() > project_version)
            return fail(
                fmt::format("{}: a newer Restage wrote this project (version {}, this one knows {}); open it there",
                            path_, version->get<int>(), project_version));
        return std::move(j);
    }

    static std::string text_of(const json& j, const char* name) {
        const auto found = j.find(name);
        return found != j.end() && found->is_string() ? found->get<std::string>() : "";
    }

    ParamSet import_options(const json& j) {
        ParamSet options;
        if (const auto found = j.find("options"); found != j.end()) read(*found, options, "options");
        return options;
    }

    // The import options of a file that its importer supports; the others are kept in the project, and reported.
    // `replaced`: it was replaced by another file, perhaps of another format.
    ParamSet fitting(const ParamSet& options, const std::string& format, const std::string& file, bool replaced,
                     io::Report& report) const {
        ParamSet fit;
        const auto importer = registry_.find_importer(format);
        const auto is_its = [&](const std::string& extension) { return lower(file).ends_with("." + extension); };
        const bool reads = importer && (!replaced || std::ranges::any_of(importer->table->extensions, is_its));
        for (const auto& [id, value] : options.entries()) {
            Result<Value> fits = fail("importer \"" + format + "\" does not read the file");
            if (reads) fits = io::fitting_option(*importer->table, id, value);
            if (fits)
                fit.set(id, std::move(*fits));
            else
                report.add(io::Fate::approximated, "import option \"" + id + "\"",
                           fits.error().message + "; the file is read without it", file);
        }
        return fit;
    }

    std::string absolute(const std::string& path) const { return (folder_ / path).lexically_normal().string(); }

    Result<> read_base(const json& j) {
        if (!j.is_object() || !j.contains("file") || !j["file"].is_string())
            return fail(path_ + ": base: expected a file");
        Base& base = doc_.base;
        const std::string named = j["file"].get<std::string>();
        base.file = options_.base.empty() ? absolute(named) : fs::absolute(options_.base).lexically_normal().string();
        std::error_code none;
        if (!fs::exists(base.file, none)) {
            if (options_.problem) *options_.problem = BaseProblem::missing;
            return fail(path_ + ": the scene it is based on is not at " + base.file +
                        "; put it back there, or open the project with its new location");
        }
        RESTAGE_TRY(const std::string bytes, read_file(base.file));
        base.hash = hash64(bytes);
        where_ = "base";
        const std::string format = text_of(j, "format");
        const ParamSet saved = import_options(j);
        if (!error_.empty()) return fail(error_);
        io::Report misfits;
        ReadOptions reading = options_;
        std::string reader; // the importer of the options
        if (!options_.import_options) {
            reading.import_options = fitting(saved, format, base.file, !options_.base.empty(), misfits);
            if (!reading.import_options->entries().empty()) reader = format;
        }
        RESTAGE_TRY(io::ImportedScene imported, read_scene(base.file, registry_, reading, reader));
        base.scene = std::move(imported.scene);
        base.format = imported.importer;
        base.options = std::move(imported.options);
        if (options_.import_options)
            doc_.unsaved = base.options != saved;
        else if (base.format == format)
            base.options = saved; // including the invalid ones
        doc_.report = std::move(imported.report);
        doc_.report.entries.insert(doc_.report.entries.end(), misfits.entries.begin(), misfits.entries.end());
        base_changed_ = !j.contains("hash") || j["hash"] != fmt::format("{:016x}", base.hash);
        const json sizes = j.contains("sizes") ? j["sizes"] : json::object();
        each_kind([&](const auto& kind) {
            const auto size = sizes.find(kind.plural);
            const bool has = size != sizes.end() && size->is_number_unsigned();
            sizes_[kind.name] = has ? size->template get<std::uint32_t>() : (base.scene.*kind.table).size();
        });
        return {};
    }

    Result<> judge_lost() {
        if (lost_.empty()) {
            if (base_changed_)
                doc_.report.add(io::Fate::approximated, "project",
                                "its scene has changed on disk since it was saved; the changes still fit",
                                doc_.base.file);
            return {};
        }
        if (!options_.drop_lost) {
            if (options_.problem) *options_.problem = BaseProblem::changed;
            std::string list;
            for (std::size_t i = 0; i < std::min<std::size_t>(lost_.size(), 5); ++i)
                list += (i ? ", " : "") + lost_[i];
            if (lost_.size() > 5) list += fmt::format(" and {} more", lost_.size() - 5);
            return fail(
                fmt::format("{}: {} has changed since the project was saved and no longer has {}; restore it, open the "
                            "project with another scene, or leave these changes out",
                            path_, doc_.base.file, list));
        }
        for (const std::string& what : lost_)
            doc_.report.add(io::Fate::dropped, what, "it is no longer in the scene; changes to it were left out",
                            path_);
        return {};
    }

    // Data shared with another holder: an item of the base, a new one, or a file. Null: none of these.
    template <class T, class Stand, class New>
    auto shared(const json& j, const char* which, Stand&& stand_in, New& made) -> decltype(T{}.data) {
        if (!j.is_object()) return nullptr;
        if (j.contains("of")) {
            const auto id = resolve<T>(j["of"], which);
            const T* item = id ? table<T>(doc_.base.scene).find(*id) : nullptr;
            return item && item->data ? item->data : stand_in();
        }
        if (j.contains("same_as")) {
            const auto found =
                j["same_as"].is_string() ? made.find(j["same_as"].template get<std::string>()) : made.end();
            return found == made.end() ? stand_in() : found->second;
        }
        if (!j.contains("file") || !j["file"].is_string() || !j.contains(which)) return nullptr;
        const std::string file = absolute(j["file"].template get<std::string>());
        const Ref ref = parse_ref(j[which]).value_or(Ref{});
        const std::string format = text_of(j, "format");
        const ParamSet options = import_options(j);
        // The same file with other options is a different scene.
        auto [at, fresh] = imported_.try_emplace({file, j.contains("options") ? j["options"].dump() : ""});
        if (fresh) {
            auto scene = read_scene(file, registry_,
                                    {.isolate = options_.isolate,
                                     .expose = false,
                                     .import_options = fitting(options, format, file, false, doc_.report)},
                                    format);
            if (scene) {
                doc_.sources.note_all(scene->scene, file, format, options);
                at->second = std::move(scene->scene);
            } else {
                doc_.report.add(io::Fate::dropped, fs::path(file).filename().string(), scene.error().message, file);
            }
        }
        const auto& items = table<T>(at->second);
        const T* item = items.find({ref.number});
        if (!item || item->name != ref.name) item = items.find(find_by_name<T>(at->second, ref.name));
        if (item && item->data) return made[current_] = item->data;
        // A visible placeholder; when saved, it still refers to the same file.
        const auto data = stand_in();
        doc_.sources.note(data, {file, format, ref.number, ref.name, options});
        doc_.report.add(io::Fate::dropped, fmt::format("{} \"{}\"", kind_name<T>, ref.name),
                        "it is not in " + file + "; a placeholder replaces it", path_);
        return made[current_] = data;
    }

    // --- things
    // --------------------------------------------------------------------------------------------------------
    template <class T>
    void read_single(const json& j, const char* name, const T& before, json& unknown) {
        const auto found = j.find(name);
        if (found == j.end()) return;
        where_ = name;
        unknown_ = &unknown;
        T after = before;
        read(*found, after, name);
        unknown_ = nullptr;
        doc_.changes.changes.push_back(ChangeOne<T>{before, std::move(after)});
    }

    template <class T>
    void read_things(const char* kind, const json& part, json& unknown) {
        const auto& base = table<T>(doc_.base.scene);
        const auto list = [&](const char* name) {
            const auto found = part.is_object() ? part.find(name) : part.end();
            return part.is_object() && found != part.end() ? *found : json();
        };
        std::set<std::uint32_t> done;
        json below = json::object();
        const auto keep_unknown = [&](const char* what, const std::string& key, json&& rest) {
            if (rest.empty()) return;
            below[what][key] = std::move(rest);
            below[what][place_mark] = below[place_mark] = true;
        };
        where_ = kind;
        for (const json& ref : list("removed"))
            if (const auto id = resolve<T>(ref, "removed"); id && base.find(*id) && done.insert(id->value).second)
                doc_.changes.changes.push_back(Change<T>{*id, base[*id], std::nullopt});
        const json changed = list("changed"), added = list("added");
        for (const auto& [key, members] : changed.items()) {
            where_ = fmt::format("{}: {}", kind, key);
            const auto id = resolve<T>(key, "changed");
            if (!id || !base.find(*id) || !done.insert(id->value).second) continue;
            T item = base[*id];
            json rest = json::object();
            current_ = key;
            current_id_ = id->value;
            read_members(*this, members, item, key.c_str(), rest);
            keep_unknown("changed", key, std::move(rest));
            doc_.changes.changes.push_back(Change<T>{*id, base[*id], std::move(item)});
        }
        Id<T> next = base.next();
        for (const auto& [key, members] : added.items()) {
            where_ = fmt::format("{}: {}", kind, key);
            const auto ref = parse_ref(key);
            if (!ref || ref->number != sizes_[kind_name<T>] + (next.value - base.size()))
                return error("added", "new items must be numbered consecutively after those of the scene");
            T item;
            json rest = json::object();
            const std::size_t lost_before = lost_.size();
            current_ = key;
            current_id_ = next.value;
            read_members(*this, members, item, key.c_str(), rest);
            keep_unknown("added", key, std::move(rest));
            Change<T> change{next, std::nullopt, std::move(item)};
            if constexpr (std::is_same_v<T, Instance>)
                if (lost_.size() > lost_before && !change.after->mesh) change.after.reset(); // its mesh is lost
            doc_.changes.changes.push_back(std::move(change));
            ++next.value;
        }
        if (!below.empty()) unknown[kind] = std::move(below);
    }

    // A file that cannot be read is reported, and a placeholder keeps its place.
    Result<> read_links(const json& list, Scene& scene) {
        if (!list.is_array()) return fail(path_ + ": links: expected a list");
        for (const json& j : list) {
            where_ = fmt::format("links: {}", text_of(j, "name"));
            const std::string name = text_of(j, "name");
            LinkSource source{.file = text_of(j, "file"), .format = text_of(j, "format"), .options = {}};
            if (source.file.empty() || !j.contains("place"))
                return fail(path_ + ": links: expected a file and a place");
            source.file = absolute(source.file);
            ParamSet options;
            if (const auto given = j.find("options"); given != j.end() && given->is_array())
                for (const json& option : *given)
                    if (option.is_string()) {
                        source.options.push_back(option.get<std::string>());
                        RESTAGE_CHECK(io::set_text_option(source.options.back(), options));
                    }
            glm::dmat4 place(1);
            read(j["place"], place, "place");
            Id<Group> parent;
            if (const auto group = j.find("group"); group != j.end()) read(*group, parent, "group");
            if (!error_.empty()) return fail(error_);
            options = fitting(options, source.format, source.file, false, doc_.report);
            auto [at, fresh] = linked_.try_emplace({source.file, fmt::format("{}", fmt::join(source.options, " "))});
            if (fresh) {
                auto imported = read_scene(source.file, registry_,
                                           {.isolate = options_.isolate, .expose = false, .import_options = options},
                                           source.format);
                if (imported) {
                    doc_.sources.note_all(imported->scene, source.file, source.format, options);
                    at->second = std::move(imported->scene);
                } else {
                    doc_.report.add(io::Fate::dropped, "link \"" + name + "\"", imported.error().message, source.file);
                }
            }
            const bool found = at->second.instances.live() > 0;
            Edit edit =
                merge(scene, found ? as_link(at->second, name, source) : as_missing_link(name, source), "").edit;
            place_link(edit, place, j.contains("hidden") && j["hidden"] == true);
            for (AnyChange& change : edit.changes)
                if (auto* c = std::get_if<Change<Group>>(&change); c && link_source(*c->after))
                    c->after->parent = parent;
            apply(scene, edit);
            doc_.changes.changes.insert(doc_.changes.changes.end(), edit.changes.begin(), edit.changes.end());
        }
        return {};
    }

    static Result<std::shared_ptr<const PixelData>> read_pixels(const Image& image) {
        RESTAGE_TRY(PixelData pixels, io::read_image(image.path, image.encoding, image.gamma));
        return std::make_shared<const PixelData>(std::move(pixels));
    }

    // Files of new and changed images, on all cores.
    void read_images() {
        std::vector<Image*> work;
        for (AnyChange& change : doc_.changes.changes)
            if (auto* c = std::get_if<Change<Image>>(&change); c && c->after && from_file_.contains(c->id.value))
                work.push_back(&*c->after);
        std::vector<std::string> problems(work.size());
        Jobs().parallel_for(work.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) {
                auto pixels = options_.pixels ? options_.pixels(*work[i]) : read_pixels(*work[i]);
                if (pixels)
                    work[i]->data = std::move(*pixels);
                else
                    problems[i] = pixels.error().message;
            }
        });
        for (std::size_t i = 0; i < work.size(); ++i)
            if (!problems[i].empty())
                doc_.report.add(io::Fate::dropped, "image \"" + work[i]->name + "\"", problems[i], work[i]->path);
    }

    // Regenerates a sky's image from its values; if that fails, the saved coarse image stays in use.
    void make_sky() {
        const std::optional<Environment>* sky = &doc_.base.scene.environment.value;
        Image* image = nullptr;
        for (const AnyChange& change : doc_.changes.changes)
            if (auto* c = std::get_if<ChangeOne<std::optional<Environment>>>(&change)) sky = &c->after;
        if (!*sky || (*sky)->sky.empty() || !sky_images_.contains((*sky)->image.value)) return;
        for (AnyChange& change : doc_.changes.changes)
            if (auto* c = std::get_if<Change<Image>>(&change); c && c->after && c->id == (*sky)->image)
                image = &*c->after;
        if (!image) return;
        const auto plugin = io::find_sky(registry_, (*sky)->sky);
        auto made = plugin ? io::make_sky(*plugin, (*sky)->sky_params, options_.progress)
                           : Result<std::shared_ptr<const PixelData>>(fail("its plugin is missing"));
        if (made)
            image->data = std::move(*made);
        else
            doc_.report.add(io::Fate::approximated, "sky \"" + (*sky)->sky + "\"",
                            made.error().message + "; a coarse saved picture replaces it, and its values are kept",
                            path_);
    }

    const std::string& path_;
    const plugin::Registry& registry_;
    const ReadOptions& options_;
    Document doc_;
    bool base_changed_ = false;
    std::string current_;
    std::uint32_t current_id_ = 0;
    std::set<std::uint32_t> from_file_; // images
    std::set<std::uint32_t> sky_images_; // generated by sky plugins: of the scene, or of looks
    std::map<std::string, std::shared_ptr<const MeshData>> new_meshes_; // by reference
    std::map<std::string, std::shared_ptr<const PixelData>> new_images_;
    std::map<std::pair<std::string, std::string>, Scene> linked_; // files and import options, of links
    std::map<std::pair<std::string, std::string>, Scene> imported_; // files and import options, of meshes and images
};

} // namespace

Result<Document> read_project(const std::string& path, const plugin::Registry& registry, const ReadOptions& options) {
    return Reader(path, registry, options).run();
}

Result<Document> read_project_text(const std::string& text, const std::string& name, const plugin::Registry& registry) {
    return Reader(name, registry, {}).run(text);
}

} // namespace restage::document
