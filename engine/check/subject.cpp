// SPDX-License-Identifier: Apache-2.0
#include "check/subject.hpp"

#include "base/file.hpp"
#include "base/json.hpp"
#include "io/services.hpp"

#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace restage::check {

namespace fs = std::filesystem;

const char* to_string(Verdict v) { return v == Verdict::pass ? "pass" : v == Verdict::fail ? "fail" : "skipped"; }

bool PluginReport::passed() const {
    if (!unable.empty()) return false;
    bool any = false;
    for (const StepResult& s : steps) {
        if (s.verdict == Verdict::fail) return false;
        any = any || s.verdict == Verdict::pass;
    }
    return any;
}

Subject::Subject(fs::path f, CheckOptions o, std::function<void()> a)
    : folder(std::move(f)),
      options(std::move(o)),
      alive(std::move(a)),
      log_([this](LogLevel level, std::string_view l) {
          if (level >= LogLevel::warning) log_lines.emplace_back(l);
      }) {
    // The manifest keys used only here; the manifest step reports its errors.
    const auto text = read_file(folder / "plugin.json");
    const auto json = parse_json<nlohmann::json>(text ? *text : "").value_or(nlohmann::json());
    if (json.is_object() && json.contains("exceptions") && json["exceptions"].is_array())
        for (const auto& e : json["exceptions"])
            if (e.is_object()) exceptions_[e.value("step", "")] = {e.value("limit", 0.0), e.value("why", "")};
}

Result<> Subject::load() {
    log_lines.clear();
    registry_ = std::make_unique<plugin::Registry>(log_, io::with_services());
    const plugin::SearchPath path[] = {{folder, true}};
    registry_->scan(path);
    for (const plugin::Entry* e : registry_->entries())
        entry_ = e;
    if (!entry_) return fail(folder.string() + ": there is no plugin.json in this folder");
    if (entry_->state == plugin::State::refused) return fail(entry_->reason);
    return {};
}

void Subject::choose(const plugin::MaterialEntry& material) {
    table_ = material.table;
    source_ = material.source;
    lab_.reset();
    densities_.reset();
    density_cases_.clear();
}

Result<gpu::Device*> Subject::device() {
    if (!device_) {
        auto made = gpu::Device::create({}, log_);
        if (!made) {
            no_device_ = made.error().message;
            return fail(no_device_);
        }
        device_ = std::move(*made);
        alive();
    }
    return device_.get();
}

Result<gpu::ShaderCompiler*> Subject::compiler() {
    if (!compiler_) {
        RESTAGE_TRY(const fs::path bin, executable_dir());
        const fs::path shaders = bin.parent_path() / "share/restage/shaders";
        if (!fs::exists(shaders / "check_lab.glsl"))
            return fail(shaders.string() + ": Restage's shaders are missing; the installation is incomplete");
        // No cache: compile time is measured.
        compiler_ = std::make_unique<gpu::ShaderCompiler>(gpu::ShaderCompilerOptions{.include_dirs = {shaders}});
    }
    return compiler_.get();
}

Result<BsdfLab*> Subject::lab() {
    if (!lab_) {
        RESTAGE_TRY(gpu::Device* const device_used, device());
        RESTAGE_TRY(gpu::ShaderCompiler* const compiler_used, compiler());
        RESTAGE_TRY(BsdfLab made, BsdfLab::create(*device_used, *compiler_used, material()));
        lab_ = std::make_unique<BsdfLab>(std::move(made));
        lab_->on_dispatch = alive;
    }
    return lab_.get();
}

const std::vector<DensityCase>& Subject::density_cases() {
    if (!density_cases_.empty()) return density_cases_;
    Engine e = random("density");
    const auto grid = config_grid(*table_, e, size(12, 4));
    std::vector<double> angles = {0, 45, 75, 89.9, 60, 85, 130, 90.1};
    if (options.quick) angles = {30, 80, 89.9, 130};
    for (const scene::ParamSet& set : grid)
        for (const double theta : angles)
            density_cases_.push_back({set, from_degrees(theta, uniform(e, 0, 360)), e()});
    return density_cases_;
}

// One in ten valid materials shows such a p by chance in one of its hundred configurations. It is measured again with
// four times the samples: chance does not repeat, and a fault becomes clearer. So are integrals that differ.
constexpr double suspicious = 1e-3, suspicious_sigma = 3;

Result<const std::vector<DensityResult>*> Subject::densities() {
    if (!densities_) {
        RESTAGE_TRY(BsdfLab* const used, lab());
        std::vector<DensityResult> all;
        Jobs jobs;
        for (const DensityCase& c : density_cases()) {
            const std::size_t draws = size(1'000'000, 200'000);
            RESTAGE_TRY(DensityResult r, measure_density(*used, jobs, c, draws));
            if (r.chi.p < suspicious || r.integral_off(suspicious_sigma) > 1 || r.reach_off(suspicious_sigma) > 1) {
                DensityCase longer = c;
                longer.seed = ~c.seed;
                RESTAGE_TRY(r, measure_density(*used, jobs, longer, 4 * draws));
                r.again = true;
            }
            all.push_back(std::move(r));
        }
        densities_ = std::move(all);
    }
    return &*densities_;
}

std::optional<Exception> Subject::exception(const std::string& step) const {
    const auto it = exceptions_.find(step);
    return it == exceptions_.end() ? std::nullopt : std::optional(it->second);
}

Engine Subject::random(const char* step) const {
    return Engine(static_cast<std::uint32_t>(hash64(step, options.seed)));
}

std::string degrees(const Vec3& w) {
    const double theta = std::atan2(std::hypot(w[0], w[1]), w[2]) * 180 / std::numbers::pi;
    return fmt::format("{:.4g} degrees{}", theta, w[2] < 0 ? ", back side" : "");
}

std::string where(const scene::ParamSet& config, const Vec3& wo) {
    return fmt::format("{}; wo {} ({})", describe(config), describe(wo), degrees(wo));
}

void run_steps(Subject& subject, const std::function<void(const std::string&, const std::string&)>& begun,
               const std::function<void(const StepResult&)>& done, const std::function<void()>& measured) {
    std::string broken; // why the following steps are pointless
    std::size_t number = 0;
    const auto run_all = [&](const std::vector<Step>& steps, const std::string& of) {
        for (const Step& step : steps) {
            const std::string name = step.name;
            if (!subject.options.only.empty() && subject.options.only != name && name != "load") continue;
            if (++number <= subject.options.skip) { // already done; but later steps need the plugin
                if (name == "load")
                    if (auto loaded = subject.load(); !loaded) broken = loaded.error().message;
                continue;
            }
            begun(name, of);
            const auto start = std::chrono::steady_clock::now();
            StepResult result;
            if (!broken.empty()) {
                result = StepResult::skip(broken);
            } else {
                auto answer = step.run(subject);
                // It is not the plugin's fault if this machine cannot run GLSL.
                result = answer                        ? std::move(*answer)
                         : subject.no_device().empty() ? StepResult::failed(answer.error().message)
                                                       : StepResult::skip("not checked: " + subject.no_device());
            }
            result.step = name, result.of = of;
            if (result.verdict == Verdict::fail && result.cause.empty()) result.cause = step.cause;
            result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            // Without a manifest, a loaded library or GLSL that compiles there is nothing to measure.
            if (result.verdict == Verdict::fail && (name == "manifest" || name == "load" || name == "glsl"))
                broken = "step " + name + " failed";
            done(result);
        }
    };
    run_all(plugin_steps(), "");
    if (!broken.empty()) return;
    for (const auto& m : subject.registry().materials()) {
        broken.clear();
        subject.choose(m);
        run_all(material_steps(), m.table->type);
        if (measured && broken.empty() && subject.table().has_code()) measured();
    }
    for (const auto& entry : subject.registry().textures()) {
        broken.clear();
        subject.texture = entry;
        run_all(texture_steps(), entry.table->type);
    }
    broken.clear();
    for (const auto& entry : subject.registry().denoisers()) {
        subject.denoiser = entry.table;
        run_all(denoiser_steps(), entry.table->type);
    }
    for (const auto& entry : subject.registry().importers()) {
        subject.importer = entry.table;
        subject.importer_entry = entry;
        run_all(importer_steps(), entry.table->format);
    }
    for (const auto& entry : subject.registry().exporters()) {
        subject.exporter = entry.table;
        run_all(exporter_steps(), entry.table->format);
    }
    const auto catalogue = subject.registry().catalogue();
    for (const auto& entry : catalogue->actions) {
        subject.action = entry;
        run_all(action_steps(), entry.table->id);
    }
    for (const auto& entry : catalogue->panels) {
        subject.panel = entry;
        run_all(panel_steps(), entry.table->id);
    }
    subject.action = {}, subject.panel = {}; // the library may be closed
    for (const auto& entry : catalogue->skies) {
        subject.sky = entry;
        run_all(sky_steps(), entry.table->type);
    }
    subject.sky = {};
}

} // namespace restage::check
