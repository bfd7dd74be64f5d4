// SPDX-License-Identifier: Apache-2.0
#include "gpu/bench.hpp"
#include "io/services.hpp"
#include "paths.hpp"

#include <stdexcept>

namespace restage::test {
namespace {

template <class T>
T value(Result<T> result, const std::string& doing) {
    if (!result) throw std::runtime_error(doing + ": " + result.error().message);
    return std::move(*result);
}

} // namespace

Bench& Bench::get() {
    static Bench bench;
    return bench;
}

Bench::Bench()
    : log_([](LogLevel level, std::string_view line) {
          if (level == LogLevel::error) throw std::runtime_error(std::string(line));
      }),
      registry_(log_, io::with_services()) {
    const plugin::SearchPath paths[] = {{restage::test::build_dir() / "lib/restage/plugins", true}};
    registry_.scan(paths);
    for (const plugin::Entry* entry : registry_.entries())
        if (entry->state == plugin::State::refused)
            throw std::runtime_error(entry->name() + " was refused: " + entry->reason);
    device_ = value(gpu::Device::create({}, log_), "device");
    compiler_ = std::make_unique<gpu::ShaderCompiler>(
        gpu::ShaderCompilerOptions{.include_dirs = {restage::test::source_dir() / "shaders"},
                                   .cache_dir = restage::test::build_dir() / "test_cache/spirv"});
}

plugin::MaterialEntry Bench::material(const char* type) const {
    const auto entry = registry_.find_material(type);
    if (!entry) throw std::runtime_error(std::string("no plugin provides the material ") + type);
    return *entry;
}

BsdfLab::BsdfLab(Bench& bench, const plugin::MaterialEntry& material)
    : lab_(value(check::BsdfLab::create(bench.device(), bench.compiler(),
                                        {material.table, material.plugin->folder, material.source}),
                 material.table->type)) {}

std::vector<BsdfAnswer> BsdfLab::run(std::span<const scene::ParamSet> configs, std::span<const BsdfJob> jobs,
                                     std::uint32_t repeats) {
    return value(lab_.run(configs, jobs, repeats), table().type);
}

} // namespace restage::test
