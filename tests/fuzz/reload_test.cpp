// SPDX-License-Identifier: Apache-2.0
// A material's library is reloaded a hundred times, and so are the other kinds: nothing leaks. Intended for
// AddressSanitizer, whose leak checker runs at the end; without it, only loading and unloading are tested.
#include "base/log.hpp"
#include "io/services.hpp"
#include "paths.hpp"
#include "plugin/registry.hpp"

#include <catch2/catch_test_macros.hpp>
#include <cstdlib>

// NOLINTNEXTLINE(bugprone-reserved-identifier): the name is LeakSanitizer's; null where it is not linked
extern "C" __attribute__((weak)) int __lsan_do_recoverable_leak_check();

using namespace restage;
namespace fs = std::filesystem;

namespace {

// RESTAGE_RELOAD_PLUGIN names another plugin's folder: one that leaks shows that the test finds it.
fs::path material_folder() {
    const char* other = std::getenv("RESTAGE_RELOAD_PLUGIN");
    return other ? fs::path(other) : restage::test::build_dir() / "lib/restage/plugins/material-conductor";
}

void no_leaks() {
    if (&__lsan_do_recoverable_leak_check) CHECK(__lsan_do_recoverable_leak_check() == 0);
}

} // namespace

TEST_CASE("a hundred reloads of a material's library leak nothing", "[reload]") {
    Log silent([](LogLevel, std::string_view) {});
    {
        plugin::Registry registry(silent);
        const plugin::SearchPath path[] = {{material_folder(), true}};
        registry.scan(path);
        REQUIRE(registry.entries().size() == 1);
        const plugin::Entry& entry = *registry.entries()[0];
        INFO(entry.reason);
        REQUIRE(entry.state == plugin::State::loaded);
        for (int i = 0; i < 100; ++i) {
            const auto in_use = registry.materials(); // of the previous version, as held by a renderer
            const auto done = registry.reload(entry);
            INFO((done ? "" : done.error().message));
            REQUIRE(done);
            REQUIRE(registry.materials().size() == in_use.size());
        }
    }
    no_leaks();
}

TEST_CASE("creating and destroying registries leaks nothing", "[reload]") {
    Log silent([](LogLevel, std::string_view) {});
    for (int i = 0; i < 100; ++i) {
        plugin::Registry registry(silent, io::with_services());
        const auto plugins = restage::test::build_dir() / "lib/restage/plugins";
        const plugin::SearchPath paths[] = {{material_folder(), true}, {plugins / "importer-obj", true}};
        registry.scan(paths);
        REQUIRE(registry.materials().size() == 1);
        REQUIRE(registry.importers().size() == 1);
    }
    no_leaks();
}
