// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of the model importers: a folder of files, the importers of this build, queries of the report.
#pragma once

#include "io/import.hpp"
#include "io/services.hpp"
#include "paths.hpp"
#include "plugin/registry.hpp"
#include "scene/tables.hpp"
#include "temporary_folder.hpp"

#include <array>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace restage::tests {

class ModelFiles {
  public:
    ModelFiles() {
        const plugin::SearchPath path[] = {{restage::test::build_dir() / "lib/restage/plugins", true}};
        registry.scan(path);
    }
    ModelFiles(const ModelFiles&) = delete;
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
    }
    io::ImportedScene load(const std::string& name, const io::ImportOptions& options = {}) const {
        auto in = io::import_scene(path(name), registry, options);
        if (!in) FAIL(in.error().message);
        return std::move(*in);
    }
    std::string error(const std::string& name) const {
        const auto in = io::import_scene(path(name), registry);
        return in ? "it was opened" : in.error().message;
    }

  private:
    Log log_{[](LogLevel, std::string_view) {}};
    test::TemporaryFolder folder_;

  public:
    plugin::Registry registry{log_, io::with_services()};
};

// Whether the report has such a line, at that place ("file:line", or a part of it), with that text.
inline bool says(const io::ImportedScene& in, io::Fate fate, const std::string& place, const std::string& words) {
    for (const auto& e : in.report.entries)
        if (const std::string line = io::to_string(e);
            e.fate == fate && line.find(place) != line.npos && line.find(words) != line.npos)
            return true;
    for (const auto& e : in.report.entries)
        UNSCOPED_INFO(io::to_string(e));
    return false;
}

} // namespace restage::tests
