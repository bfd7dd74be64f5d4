// SPDX-License-Identifier: Apache-2.0
// Ends an import: the file is ours but malformed. Thrown inside an importer, caught in its load().
#pragma once

#include <restage/scene_io.h>
#include <cstdint>
#include <exception>
#include <new>
#include <string>

namespace restage::importing {

struct ImportError {
    std::string message{};
    std::uint32_t line = 0, column = 0; // 0 = of the whole file
    std::string file{};                 // "" = the file being loaded
};
struct Cancelled {}; // the user cancelled

// Runs body() -> void; 1 = done, 0 = broken or stopped. Lets no exception through.
template <class Body>
int guarded_load(const char* path, const RestageSceneWriter1& out, Body&& body) noexcept {
    try {
        body();
        return 1;
    } catch (const Cancelled&) { // NOLINT(bugprone-empty-catch): returns 0
    } catch (const ImportError& error) {
        out.error(out.ctx, error.file.empty() ? path : error.file.c_str(), error.line, error.column,
                  error.message.c_str());
    } catch (const std::bad_alloc&) {
        out.error(out.ctx, path, 0, 0, "out of memory while reading the file; close other programs or simplify it");
    } catch (const std::exception& error) {
        try {
            out.error(out.ctx, path, 0, 0,
                      (std::string("the importer failed (a bug, please report it): ") + error.what()).c_str());
        } catch (...) {
            out.error(out.ctx, path, 0, 0, "the importer failed (a bug, please report it)");
        }
    }
    return 0;
}

} // namespace restage::importing
