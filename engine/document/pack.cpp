// SPDX-License-Identifier: Apache-2.0
#include "document/pack.hpp"

#include "base/file.hpp"
#include "base/json.hpp"
#include "base/temporary.hpp"
#include "document/project_json.hpp"
#include "document/session.hpp"
#include "io/zip_file.hpp"
#include "scene/placeholder.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

namespace restage::document {

namespace fs = std::filesystem;

namespace {

constexpr int most_levels_up = 3; // from a scene's folder to files that still count as its own
constexpr const char* files_folder = "files";
constexpr std::string_view file_read = "file"; // what importers report of further files that they read

fs::path real(const fs::path& path) {
    std::error_code code;
    const fs::path full = fs::weakly_canonical(path, code);
    return code ? path.lexically_normal() : full;
}
bool is_file(const fs::path& path) {
    std::error_code code;
    return fs::is_regular_file(path, code);
}
bool is_within(const fs::path& path, const fs::path& folder) {
    const fs::path relative = path.lexically_relative(folder);
    return !relative.empty() && *relative.begin() != "..";
}

// The files that a scene names or was read from, those that are missing, too.
std::set<fs::path> files_of(const scene::Scene& scene, const io::Report& report) {
    std::set<fs::path> files;
    const auto add = [&](const std::string& path) {
        if (fs::path(path).is_absolute()) files.insert(real(path));
    };
    scene.images.each([&](auto, const scene::Image& image) { add(image.path); });
    scene.meshes.each([&](auto, const scene::Mesh& mesh) { add(mesh.source_file); });
    const auto add_tables = [&](const scene::ParamSet& params) {
        params.each_value([&](const scene::Value& value) {
            if (value.type == model::ParamType::table) add(value.text);
        });
    };
    scene.materials.each([&](auto, const scene::Material& material) { add_tables(material.params); });
    scene.textures.each([&](auto, const scene::Texture& texture) { add_tables(texture.params); });
    for (const io::ReportEntry& entry : report.entries)
        if (entry.what == file_read) add(entry.file);
    return files;
}

bool is_absolute(const json& text) { return text.is_string() && fs::path(text.get<std::string>()).is_absolute(); }

// f(object, path): members of a project's text that are absolute paths.
template <class F>
void each_path(json& j, bool values, F&& f) {
    if (j.is_array())
        for (json& element : j)
            each_path(element, false, f);
    if (!j.is_object()) return;
    for (auto& [key, value] : j.items()) {
        const bool names_file = key == "file" || key == "path" || key == "source_file";
        if (!values && names_file && is_absolute(value))
            f(j, value);
        else
            each_path(value, key == "params" || key == "all_params", f); // a value named "file" is no such member
    }
}

class Packing {
  public:
    Packing(fs::path folder, const plugin::Registry& registry, const ReadOptions& options)
        : folder_(std::move(folder)), registry_(registry), options_(options) {}

    Result<Packed> run(json project, const std::string& name) {
        std::map<fs::path, std::string> scenes; // path -> importer
        std::set<fs::path> loose;
        each_path(project, false, [&](const json& holder, const json& path) {
            const fs::path file = real(path.get<std::string>());
            const auto format = holder.find("format");
            if (format != holder.end() && format->is_string() && holder.contains("file"))
                scenes.emplace(file, format->get<std::string>());
            else
                loose.insert(file);
        });
        std::size_t done = 0;
        for (const auto& [file, format] : scenes) {
            if (!report(0.6f * static_cast<float>(done++) / static_cast<float>(scenes.size()),
                        file.filename().string()))
                return cancelled("packing: stopped on request");
            if (!placed_.contains(file)) RESTAGE_CHECK(take_scene(file, format));
        }
        for (const fs::path& file : loose)
            if (!placed_.contains(file)) RESTAGE_CHECK(take(file, unique(file.filename())));
        each_path(project, false, [&](const json&, json& path) {
            if (const auto at = placed_.find(real(path.get<std::string>())); at != placed_.end())
                path = at->second.generic_string();
        });
        packed_.project = folder_ / (name + std::string(project_extension));
        RESTAGE_CHECK(write_file_atomic(packed_.project, pretty(project)));
        RESTAGE_CHECK(verify());
        return std::move(packed_);
    }

  private:
    struct Tree { // a scene and its files, as they are placed relative to each other
        fs::path from, to; // a folder, and the one in the pack
    };

    bool report(float done, const std::string& what) const {
        return !options_.progress || options_.progress(done, what);
    }

    fs::path unique(const fs::path& name) {
        fs::path made = fs::path(files_folder) / name;
        for (int i = 2; !taken_.insert(made).second; ++i)
            made = fs::path(files_folder) / (fmt::format("{} {}", name.stem().string(), i) + name.extension().string());
        return made;
    }

    Result<> take(const fs::path& file, const fs::path& to) {
        if (!is_file(file)) {
            packed_.problems.push_back(file.string() + " is missing");
            return {};
        }
        placed_.try_emplace(file, to);
        if (is_file(folder_ / to)) return {};
        std::error_code code;
        fs::create_directories((folder_ / to).parent_path(), code);
        fs::copy_file(file, folder_ / to, code);
        if (code)
            return fail(file.string() + ": cannot be copied to " + (folder_ / to).string() + ": " + code.message());
        ++packed_.files;
        packed_.bytes += fs::file_size(folder_ / to, code);
        return {};
    }

    Result<std::set<fs::path>> files_read(const fs::path& scene, const std::string& format) const {
        if (options_.isolate) {
            RESTAGE_TRY(const io::ImportedScene in,
                        read_scene(scene.string(), registry_, {.isolate = options_.isolate, .expose = false}, format));
            return files_of(in.scene, in.report);
        }
        RESTAGE_TRY(const io::ImportedScene in,
                    io::import_scene(scene.string(), registry_, {.format = format, .read_images = false}));
        return files_of(in.scene, in.report);
    }

    Result<> take_scene(const fs::path& scene, const std::string& format) {
        auto files = files_read(scene, format);
        if (!files) { // it cannot be read here either: as it is
            packed_.problems.push_back(files.error().message);
            return is_file(scene) ? take(scene, unique(scene.filename())) : Result<>();
        }
        files->insert(scene);
        Tree tree{.from = scene.parent_path(), .to = {}};
        const auto around = [&](const fs::path& file) {
            fs::path top = scene.parent_path();
            for (int up = 0; up <= most_levels_up && top != top.root_path(); ++up, top = top.parent_path())
                if (is_within(file, top)) return top;
            return fs::path();
        };
        for (const fs::path& file : *files)
            if (const fs::path top = around(file); !top.empty() && is_within(tree.from, top)) tree.from = top;
        tree.to = unique(scene.stem());
        trees_.push_back(tree);
        const fs::path beside = tree.to / scene.parent_path().lexically_relative(tree.from);
        for (const fs::path& file : *files) {
            const bool within = is_within(file, tree.from);
            // Elsewhere: beside the scene, where importers look for files of another machine.
            RESTAGE_CHECK(take(
                file,
                (within ? tree.to / file.lexically_relative(tree.from) : beside / file.filename()).lexically_normal()));
        }
        return {};
    }

    // Reads the packed project. A file that it lacks, but which is at that place of the original scene (through a
    // link), is added.
    Result<> verify() {
        const fs::path here = real(folder_);
        std::set<fs::path> files;
        for (int attempt = 0;; ++attempt) {
            if (!report(0.7f + 0.15f * static_cast<float>(attempt), "checking"))
                return cancelled("packing: stopped on request");
            ReadOptions reading;
            reading.isolate = options_.isolate;
            Session session(registry_);
            if (auto opened = session.open(packed_.project.string(), reading); !opened)
                return fail("the packed project cannot be opened", opened.error());
            files = files_of(session.scene(), session.report());
            files.merge(files_of(session.base().scene, {}));
            if (attempt > 0 || !add_linked(files, here)) {
                for (const scene::Missing& missing : scene::missing_things(session.scene()))
                    if (missing.kind == "mesh" && !fs::path(missing.file).is_absolute()) // else told already
                        packed_.problems.push_back("mesh \"" + missing.name + "\" is missing: " + missing.file);
                break;
            }
        }
        for (const fs::path& file : files)
            if (!is_within(file, here) && is_file(file))
                packed_.problems.push_back(file.string() +
                                           " is named by its whole path and will not be found on another machine");
        return {};
    }

    bool add_linked(const std::set<fs::path>& files, const fs::path& here) {
        bool any = false;
        for (const fs::path& file : files)
            for (const Tree& tree : trees_) {
                const fs::path inside = here / tree.to;
                if (!is_within(file, inside) || is_file(file)) continue;
                const fs::path original = tree.from / file.lexically_relative(inside);
                if (is_file(original)) any = take(original, file.lexically_relative(here)).has_value() || any;
            }
        return any;
    }

    fs::path folder_;
    const plugin::Registry& registry_;
    const ReadOptions& options_;
    Packed packed_;
    std::vector<Tree> trees_;
    std::map<fs::path, fs::path> placed_; // original -> relative to the folder
    std::set<fs::path> taken_;
};

struct Scratch { // a folder that is removed unless kept
    fs::path path;
    bool keep = false;
    explicit Scratch(fs::path p) : path(std::move(p)) {}
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    ~Scratch() {
        std::error_code ignored;
        if (!keep) fs::remove_all(path, ignored);
    }
};

} // namespace

bool is_packed(const fs::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    return extension == ".zip";
}

Result<Packed> pack_project(const std::string& project, const fs::path& out, const plugin::Registry& registry,
                            const ReadOptions& options) {
    RESTAGE_TRY(json text, parse_json<json>(project));
    const fs::path place = fs::absolute(out).lexically_normal();
    const bool zip = is_packed(place);
    const std::string name = (zip ? place.stem() : place.filename()).string();
    if (name.empty() || name == "." || name == "..")
        return fail(out.string() + ": is no name of a folder to pack into");
    std::error_code code;
    if (!zip && fs::exists(place, code) && !fs::is_empty(place, code))
        return fail(out.string() + ": is not an empty folder; choose a new one");
    fs::path folder = place;
    if (zip) {
        RESTAGE_TRY(folder, make_temporary_folder("restage-pack"));
    }
    Scratch scratch(folder);
    fs::create_directories(folder, code);
    if (code) return fail(folder.string() + ": cannot be created: " + code.message());
    RESTAGE_TRY(Packed packed, Packing(folder, registry, options).run(std::move(text), name));
    scratch.keep = !zip;
    if (zip) {
        RESTAGE_CHECK(io::write_zip(place, folder, options.progress));
        packed.project = place;
    }
    return packed;
}

Result<fs::path> unpack_project(const fs::path& archive, const io::Progress& progress) {
    const fs::path full = fs::absolute(archive).lexically_normal(), folder = full.parent_path() / full.stem();
    std::error_code code;
    if (!fs::exists(folder, code)) RESTAGE_CHECK(io::unpack_zip(full, folder, progress));
    if (const fs::path named = folder / (full.stem().string() + std::string(project_extension)); is_file(named))
        return named;
    std::vector<fs::path> projects; // the archive was renamed
    for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code))
        if (is_project(at->path())) projects.push_back(at->path());
    if (projects.size() == 1) return projects[0];
    return fail(archive.string() + ": " + (projects.empty() ? "there is no project" : "there are several projects") +
                " in " + folder.string() + ", where it is unpacked; open a scene file there");
}

} // namespace restage::document
