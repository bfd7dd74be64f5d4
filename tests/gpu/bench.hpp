// SPDX-License-Identifier: Apache-2.0
// Shared by the material tests of this folder: device, compiler, the plugins of this build, and check::BsdfLab with
// exceptions in place of results, so that tests read as the formulas they compute.
#pragma once

#include "check/configs.hpp"
#include "plugin/registry.hpp"

#include <memory>
#include <vector>

namespace restage::test {

using check::BsdfAnswer, check::BsdfJob, check::Vec3, check::delta, check::reflect, check::transmit;
using check::choice, check::describe, check::luminance, check::random_config, check::white_config, check::wide_config;
using check::Engine, check::uniform, check::unit, check::unit3, check::direction, check::random_direction;

class Bench {
  public:
    static Bench& get(); // created on first use; throws a message about what is missing
    gpu::Device& device() { return *device_; }
    const gpu::ShaderCompiler& compiler() { return *compiler_; }
    std::vector<plugin::MaterialEntry> materials() const { return registry_.materials(); }
    plugin::MaterialEntry material(const char* type) const;

  private:
    Bench();
    Log log_;
    plugin::Registry registry_;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<gpu::ShaderCompiler> compiler_;
};

class BsdfLab {
  public:
    BsdfLab(Bench& bench, const plugin::MaterialEntry& material); // throws std::runtime_error
    std::vector<BsdfAnswer> run(std::span<const scene::ParamSet> configs, std::span<const BsdfJob> jobs,
                                std::uint32_t repeats = 1);
    const model::Material& table() const { return lab_.table(); }
    const std::filesystem::path& folder() const { return lab_.folder(); }

  private:
    check::BsdfLab lab_;
};

} // namespace restage::test
