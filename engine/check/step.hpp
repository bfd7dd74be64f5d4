// SPDX-License-Identifier: Apache-2.0
// The data of a check: the result of a step, and a plugin's report.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace restage::check {

enum class Verdict { pass, fail, skipped };
const char* to_string(Verdict);

struct Figure { // a measurement
    std::string name;
    double value = 0;
    std::string unit = {};
};

struct StepResult {
    std::string step; // "chi-square"
    std::string of;   // one of the plugin's tables: "diffuse"; empty: the whole plugin
    Verdict verdict = Verdict::pass;
    std::string text; // fail: what is wrong and where; skipped: why; pass: a remark, or empty
    std::string cause; // fail: what usually causes it
    std::vector<Figure> figures = {};
    double seconds = 0;

    static StepResult passed(std::vector<Figure> figures, std::string text = {}) {
        return {.verdict = Verdict::pass, .text = std::move(text), .figures = std::move(figures)};
    }
    static StepResult failed(std::string text, std::vector<Figure> figures = {}) {
        return {.verdict = Verdict::fail, .text = std::move(text), .figures = std::move(figures)};
    }
    static StepResult skip(std::string why) { return {.verdict = Verdict::skipped, .text = std::move(why)}; }
};

struct PluginReport {
    std::string id;              // of the manifest; the folder if there is none
    std::filesystem::path folder;
    std::string kind, version;
    std::uint32_t seed = 0;
    bool quick = false;
    std::vector<StepResult> steps;
    std::vector<std::filesystem::path> pictures; // pages written
    double seconds = 0;
    std::string unable; // why steps could not run here (no Vulkan device): neither the plugin's fault nor a pass
    bool passed() const; // at least one step, none failed, and all could run
};

} // namespace restage::check
