// SPDX-License-Identifier: Apache-2.0
// Quarantine: plugins that crashed the program, remembered until they change or are released. A note is a
// file in a folder, written by the crash handler (base/crash_note.hpp). Our own plugins are exempt.
#pragma once

#include "base/result.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace restage::plugin {

class Quarantine {
  public:
    explicit Quarantine(std::filesystem::path folder) : folder_(std::move(folder)) {} // empty: nothing is remembered

    // The file a crash must write to quarantine the plugin; its folder is created. "" = nothing is remembered.
    std::string note_of(const std::string& id) const;
    // The file's content: what the plugin was doing, and the stamp of its files.
    static std::string note(const std::string& doing, std::uint64_t stamp);
    // Why it is quarantined: "it crashed (SIGSEGV) while it was being loaded". nullopt if it is not, or if the stamp of
    // its files has changed: then it is released.
    std::optional<std::string> reason(const std::string& id, std::uint64_t stamp) const;
    Result<bool> release(const std::string& id) const; // true if it was quarantined

  private:
    std::filesystem::path folder_;
};

} // namespace restage::plugin
