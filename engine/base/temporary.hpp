// SPDX-License-Identifier: Apache-2.0
// Temporary folders, also where the usual place for them is missing, full or not ours.
#pragma once

#include "base/result.hpp"

#include <filesystem>
#include <string>

namespace restage {

// An empty folder of our own, rwx for the user only, whose name begins with `name`: in the system's temporary folder
// (TMPDIR), else in $XDG_RUNTIME_DIR, /tmp, /var/tmp, /dev/shm, or the cache. Who asks removes it. Errors: none of
// these can be written. [any]
Result<std::filesystem::path> make_temporary_folder(const std::string& name);

} // namespace restage
