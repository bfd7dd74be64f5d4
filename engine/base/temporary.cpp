// SPDX-License-Identifier: Apache-2.0
#include "base/temporary.hpp"

#include "base/file.hpp"

#include <cstdlib>
#include <random>
#include <system_error>
#include <vector>

namespace restage {

namespace fs = std::filesystem;

Result<fs::path> make_temporary_folder(const std::string& name) {
    std::vector<fs::path> places;
    std::error_code code;
    if (const auto usual = fs::temp_directory_path(code); !code) places.push_back(usual);
    if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && *runtime) places.emplace_back(runtime);
    places.insert(places.end(), {"/tmp", "/var/tmp", "/dev/shm"});
    if (const auto cache = cache_dir()) places.push_back(*cache);
    std::random_device random;
    std::string tried;
    for (const fs::path& place : places) {
        const fs::path folder = place / (name + "-" + std::to_string(random()) + "-" + std::to_string(random()));
        // Not create_directories: `place` must exist. An existing name is skipped.
        if (fs::create_directory(folder, code) && !code) {
            fs::permissions(folder, fs::perms::owner_all, code);
            if (!code) return folder;
            fs::remove(folder, code);
        }
        tried += (tried.empty() ? "" : ", ") + place.string();
    }
    return fail("cannot create a temporary folder; tried " + tried + ": set TMPDIR to a writable folder");
}

} // namespace restage
