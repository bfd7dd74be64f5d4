// SPDX-License-Identifier: Apache-2.0
// Shared by the export tests: the built plugins, a temporary folder, and a scene with
// every kind of thing.
#pragma once

#include "base/file.hpp"
#include "io/export.hpp"
#include "io/services.hpp"
#include "paths.hpp"
#include "plugin/registry.hpp"
#include "scene/edits.hpp"
#include "scene/tables.hpp"
#include "temporary_folder.hpp"

#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace restage::test {

struct Plugins { // all built plugins
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log, io::with_services()};
    Plugins() {
        registry.scan(
            std::vector<plugin::SearchPath>{{restage::test::build_dir() / "lib" / "restage" / "plugins", true}});
        for (const auto* entry : registry.entries()) {
            INFO(entry->name() << ": " << entry->reason);
            if (!entry->manifest.provides_any("restage.denoiser")) // not part of this
                CHECK(entry->state == plugin::State::loaded);
        }
        REQUIRE(registry.find_importer("pbrt"));
        REQUIRE(registry.find_exporter("pbrt"));
    }
};

struct Folder {
    TemporaryFolder own;
    const std::filesystem::path& path = own.path();
    std::string file(const char* name) const { return (path / name).string(); }
    std::map<std::string, std::string> contents() const {
        std::map<std::string, std::string> all;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
            if (entry.is_regular_file())
                all[entry.path().lexically_relative(path).generic_string()] = read_file(entry.path()).value();
        return all;
    }
};

inline io::ExportOptions version(const char* v) { // of pbrt
    io::ExportOptions options;
    options.values.set("version", scene::Value::choice(v));
    return options;
}

inline std::string joined(const std::vector<std::string>& lines) {
    std::string all;
    for (const auto& line : lines)
        all += line + "\n";
    return all;
}

glm::dmat4 place(double x, double turn, glm::dvec3 scale = glm::dvec3(1));

// Every kind of thing, with numbers that have no short decimal form.
struct Everything {
    scene::Scene scene;
    template <class T>
    scene::Id<T> add(T item) {
        const scene::Id<T> id = scene::table<T>(scene).next();
        scene::apply(scene, scene::insert(scene, std::move(item), "add"));
        return id;
    }
    scene::Id<scene::Material> material(const char* name, const char* type,
                                        std::vector<std::pair<const char*, scene::Value>> values) {
        scene::Material m{.name = name, .type = type};
        for (auto& [id, value] : values)
            m.params.set(id, std::move(value));
        return add(std::move(m));
    }
    void instance(const char* name, scene::Id<scene::Mesh> mesh, scene::Id<scene::Material> m, double x, double turn) {
        add(scene::Instance{.name = name, .mesh = mesh, .material = m, .object_to_world = place(x, turn)});
    }

    explicit Everything(bool v4); // what pbrt-v4 or v3 can hold
};

} // namespace restage::test
