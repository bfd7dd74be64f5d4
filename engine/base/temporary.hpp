// SPDX-License-Identifier: Apache-2.0
// Temporary folders, even if the usual place for them is missing, full or not writable.
#pragma once

#include "base/result.hpp"

#include <filesystem>
#include <string>

namespace restage {

// A new empty folder, rwx for the user only, whose name begins with `name`: in the system's temporary folder
// (TMPDIR), else in $XDG_RUNTIME_DIR, /tmp, /var/tmp, /dev/shm, or the cache. The caller removes it. Error: none of
// these is writable. [any]
Result<std::filesystem::path> make_temporary_folder(const std::string& name);

} // namespace restage
