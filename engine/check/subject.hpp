// SPDX-License-Identifier: Apache-2.0
// The plugin under test and data shared by its steps: a private registry, the device, and the material's lab.
#pragma once

#include "check/configs.hpp"
#include "check/density.hpp"
#include "check/step.hpp"
#include "plugin/registry.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>

namespace restage::check {

struct CheckOptions {
    std::uint32_t seed = 1;
    bool quick = false;
    std::string only;               // a step's name; empty: all
    std::filesystem::path pictures; // folder for the pages; empty: none
    std::size_t skip = 0; // steps already done in a process that crashed
};

// plugin.json's "exceptions": [{"step": "energy", "limit": 1.015, "why": "..."}]: what a published model is known to
// violate, and by how much. The report states it; beyond its limit the step still fails.
struct Exception {
    double limit = 0;
    std::string why;
};

class Subject {
  public:
    Subject(std::filesystem::path folder, CheckOptions options, std::function<void()> alive);

    const std::filesystem::path folder;
    const CheckOptions options;
    const std::function<void()> alive; // a heartbeat for the supervisor
    std::function<void(const std::string&)> say_doing; // announces the activity a later crash belongs to; may be empty
    void doing(const std::string& what) const {
        if (say_doing) say_doing(what);
    }
    std::vector<std::string> log_lines; // warnings and errors of the last load

    Result<> load(); // scans this folder only
    plugin::Registry& registry() { return *registry_; }
    const plugin::Entry* entry() const { return entry_; } // null before load

    // The subject of the following steps if it is not a material.
    const model::Importer* importer = nullptr;
    plugin::ImporterEntry importer_entry; // of it
    const model::Exporter* exporter = nullptr;
    const plugin::Denoiser* denoiser = nullptr;
    plugin::ActionEntry action;
    plugin::PanelEntry panel;
    plugin::SkyEntry sky;
    std::optional<plugin::TextureEntry> texture;
    // The material of the following steps.
    void choose(const plugin::MaterialEntry& material);
    const model::Material& table() const { return *table_; }
    render::MaterialPlugin material() const { return {table_, folder, source_}; }
    Result<gpu::Device*> device();
    const std::string& no_device() const { return no_device_; } // why this machine cannot run GLSL; "" = it can
    Result<gpu::ShaderCompiler*> compiler();
    Result<BsdfLab*> lab(); // compiled at first use
    // Results of the material's density tests; measured at first use.
    Result<const std::vector<DensityResult>*> densities();
    const std::vector<DensityCase>& density_cases();

    std::optional<Exception> exception(const std::string& step) const;
    Engine random(const char* step) const; // independent of the random numbers of other steps
    std::size_t size(std::size_t full, std::size_t quick) const { return options.quick ? quick : full; }

  private:
    Log log_;
    std::unique_ptr<plugin::Registry> registry_;
    const plugin::Entry* entry_ = nullptr;
    const model::Material* table_ = nullptr;
    std::shared_ptr<const plugin::MaterialSource> source_; // keeps it alive
    std::map<std::string, Exception> exceptions_;
    std::unique_ptr<gpu::Device> device_;
    std::string no_device_;
    std::unique_ptr<gpu::ShaderCompiler> compiler_;
    std::unique_ptr<BsdfLab> lab_;
    std::vector<DensityCase> density_cases_;
    std::optional<std::vector<DensityResult>> densities_;
};

// "roughness=0.3, wo (0.5, 0, 0.866) (30 degrees)"
std::string where(const scene::ParamSet& config, const Vec3& wo);
std::string degrees(const Vec3& w);

struct Step {
    const char* name;
    const char* tests; // one line for --help and the documents
    Result<StepResult> (*run)(Subject&);
    const char* cause; // the usual cause of failure
    const char* calls = ""; // the plugin's native functions that it calls; "" = its GLSL
};
const std::vector<Step>& plugin_steps(); // of every plugin, once
const std::vector<Step>& material_steps(); // of every material of the plugin
const std::vector<Step>& texture_steps();
const std::vector<Step>& denoiser_steps();
const std::vector<Step>& importer_steps();
const std::vector<Step>& exporter_steps();
const std::vector<Step>& action_steps();
const std::vector<Step>& panel_steps();
const std::vector<Step>& sky_steps();
std::span<const std::vector<Step>* const> all_steps(); // every list, in the order of reports
const Step* find_step(const std::string& name); // null if there is none

// All steps in order. Calls `begun` before each, `done` after it; `measured` after those of a material whose GLSL
// compiles, while it is still current.
void run_steps(Subject& subject, const std::function<void(const std::string& step, const std::string& of)>& begun,
               const std::function<void(const StepResult&)>& done, const std::function<void()>& measured = {});

} // namespace restage::check
