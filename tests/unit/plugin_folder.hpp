// SPDX-License-Identifier: Apache-2.0
// A folder of plugins for a test, and a log whose lines it can read.
#pragma once

#include "base/file.hpp"
#include "paths.hpp"
#include "plugin/library.hpp"
#include "plugin/registry.hpp"
#include "temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace restage::test {

inline const std::filesystem::path built_plugins = restage::test::build_dir() / "tests" / "plugins_bad";

// `provides`: the list's contents; `needs`: the object's contents.
inline std::string manifest(const char* provides = R"("restage.material/1", "restage.table/1")",
                            const char* needs = R"("host": ">=0.2")", const char* id = "org.example.velvet") {
    return std::string(R"({"id": ")") + id + R"(", "provides": [)" + provides +
           R"(], "version": "1.0.0", "licence": "MIT", "needs": {)" + needs + R"(}, "library": "velvet"})";
}

struct PluginFolder {
    TemporaryFolder own;
    const std::filesystem::path& path = own.path();
    std::vector<std::string> lines;
    Log log{[this](LogLevel, std::string_view line) { lines.emplace_back(line); }};

    // `library`: a case of tests/plugins_bad, or null for none.
    std::filesystem::path add(const std::string& name, const std::string& json, const char* library) {
        const std::filesystem::path folder = path / name;
        std::filesystem::create_directories(folder);
        REQUIRE(write_file_atomic(folder / "plugin.json", json));
        REQUIRE(write_file_atomic(folder / "velvet.glsl", "// empty"));
        if (library)
            std::filesystem::copy_file(built_plugins / (std::string(library) + plugin::Library::extension()),
                                       folder / (std::string("velvet") + plugin::Library::extension()));
        return folder;
    }
    void scan(plugin::Registry& registry) { registry.scan(std::vector<plugin::SearchPath>{{path, true}}); }

    // The reason for refusing the only plugin.
    std::string refusal() {
        plugin::Registry registry(log);
        scan(registry);
        REQUIRE(registry.entries().size() == 1);
        CHECK(registry.entries()[0]->state == plugin::State::refused);
        CHECK(registry.materials().empty());
        const std::string reason = registry.entries()[0]->reason;
        CHECK(std::any_of(lines.begin(), lines.end(),
                          [&](const auto& l) { return l.find(reason) != std::string::npos; }));
        return reason;
    }
    std::string refusal_of(const std::string& json, const char* library) {
        std::filesystem::remove_all(path);
        add("p", json, library);
        return refusal();
    }
};

} // namespace restage::test
