// SPDX-License-Identifier: Apache-2.0
// Checking a plugin in a separate process, so that it may crash, hang or print garbage: `restage check --in-process`
// reports its progress and results on standard output, as marked lines of JSON.
#pragma once

#include "check/subject.hpp"

#include <atomic>
#include <chrono>
#include <functional>

namespace restage::check {

struct Supervision {
    std::filesystem::path program; // the program `restage`
    std::filesystem::path folder;  // of the plugin
    CheckOptions options;
    std::chrono::milliseconds answer_limit{60'000}; // maximum time without output
    std::uint64_t memory_limit = 0;                 // bytes of address space; 0 = none
    std::function<void(const PluginReport& so_far, const StepResult&)> on_step;
    std::function<void(const std::string& step, const std::string& of)> on_begin;
    const std::atomic<bool>* cancel = nullptr;
};
Result<PluginReport> check_plugin(const Supervision&); // [worker] an error means it could not be started

// Resolves folders, ids, or what plugins provide ("diffuse") to plugin folders; none given = all.
Result<std::vector<std::filesystem::path>> find_plugins(const std::filesystem::path& program,
                                                        std::span<const std::string> names);

// The child's side.
void check_in_process(const std::filesystem::path& folder, const CheckOptions& options);

} // namespace restage::check
