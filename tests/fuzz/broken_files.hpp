// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of broken input: folders, the plugins, and limits on time and memory.
#pragma once

#include "base/log.hpp"
#include "io/services.hpp"
#include "paths.hpp"
#include "plugin/registry.hpp"
#include "temporary_folder.hpp"

#include <sys/resource.h>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

namespace restage::test {

inline const std::filesystem::path data_folder = restage::test::source_dir() / "tests/data";

inline std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

using Folder = TemporaryFolder;

class Importers {
  public:
    Importers() : registry(log_, io::with_services()) {
        const plugin::SearchPath path[] = {{restage::test::build_dir() / "lib/restage/plugins", true}};
        registry.scan(path);
    }

  private:
    Log log_{[](LogLevel, std::string_view) {}};

  public:
    plugin::Registry registry;
};

class Watch {
  public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    // How much the process has grown beyond its largest size so far. [MB]
    double grown() const { return peak() - peak_; }
    static double peak() {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return static_cast<double>(usage.ru_maxrss) / 1024;
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double peak_ = peak();
};

} // namespace restage::test
