// SPDX-License-Identifier: Apache-2.0
// Quarantine: plugins that crashed the program, remembered until they change or somebody lets them out. A note is a
// file in a folder, written by the crash itself (base/crash_note.hpp). Our own plugins are never in it.
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

    // The file a crash must write to put the plugin in; its folder is made. "" = nothing is remembered.
    std::string note_of(const std::string& id) const;
    // What the file must hold: what the plugin was doing, and the stamp of its files.
    static std::string note(const std::string& doing, std::uint64_t stamp);
    // Why it is kept out: "it crashed (SIGSEGV) while it was being loaded". Nothing when it was never in, or when its
    // files have another stamp now: then it is let out.
    std::optional<std::string> reason(const std::string& id, std::uint64_t stamp) const;
    Result<bool> release(const std::string& id) const; // true: it was in

  private:
    std::filesystem::path folder_;
};

} // namespace restage::plugin
