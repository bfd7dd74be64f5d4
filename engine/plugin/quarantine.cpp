// SPDX-License-Identifier: Apache-2.0
// A note has three lines: stamp, activity, signal.
#include "plugin/quarantine.hpp"

#include "base/file.hpp"

#include <sstream>
#if !defined(_WIN32)
#include <unistd.h>
#endif

namespace restage::plugin {

namespace fs = std::filesystem;

std::string Quarantine::note_of(const std::string& id) const {
    std::error_code code;
    if (folder_.empty() || id.empty() || (fs::create_directories(folder_, code), code)) return {};
#if !defined(_WIN32)
    if (::access(folder_.c_str(), W_OK | X_OK) != 0) return {};
#endif
    return (folder_ / (id + ".txt")).string();
}

std::string Quarantine::note(const std::string& doing, std::uint64_t stamp) {
    return std::to_string(stamp) + "\n" + doing;
}

std::optional<std::string> Quarantine::reason(const std::string& id, std::uint64_t stamp) const {
    const std::string file = note_of(id);
    std::error_code code;
    if (file.empty() || !fs::exists(file, code)) return {};
    std::istringstream note(read_file(file).value_or(""));
    std::string then, doing, signal;
    std::getline(note, then), std::getline(note, doing), std::getline(note, signal);
    if (then != std::to_string(stamp)) { // another build gets another chance
        fs::remove(file, code);
        return {};
    }
    return "it crashed" + (signal.empty() ? "" : " (" + signal + ")") + " " + doing;
}

Result<bool> Quarantine::release(const std::string& id) const {
    std::error_code code;
    const std::string file = note_of(id);
    const bool was_in = !file.empty() && fs::remove(file, code);
    if (code) return fail(file + ": cannot be removed: " + code.message());
    return was_in;
}

} // namespace restage::plugin
