// SPDX-License-Identifier: Apache-2.0
// Runs a few lines of GLSL over an array on the test device, so that tests can compare the shader library with C++.
#pragma once

#include "base/log.hpp"
#include "gpu/compiler.hpp"
#include "gpu/device.hpp"
#include "gpu/pipeline.hpp"
#include "paths.hpp"

#include <fmt/format.h>
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace restage::tests {

class KernelLab {
  public:
    KernelLab() {
        device_ = take(gpu::Device::create({}, log_));
        compiler_ = std::make_unique<gpu::ShaderCompiler>(
            gpu::ShaderCompilerOptions{.include_dirs = {restage::test::source_dir() / "shaders"},
                                       .cache_dir = restage::test::build_dir() / "test_cache/spirv"});
    }
    gpu::Device& device() { return *device_; }

    // `head`: includes. `in`, `out`: GLSL types with the scalar layout of In and Out. `body`: makes `result` of `x`,
    // the input number `i`; `root` is an address of the caller's choice; `source`: required by plugins' code in `head`.
    template <class Out, class In>
    std::vector<Out> run(const std::string& head, const std::string& in, const std::string& out,
                         const std::string& body, std::span<const In> inputs, std::uint64_t root = 0,
                         gpu::ShaderSource source = {}) {
        struct Push {
            std::uint64_t in, out, root;
            std::uint32_t count, pad;
        };
        const std::string text = fmt::format(R"(#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
{}
layout(local_size_x = 64) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LabInputs {{ {} at[]; }};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer LabOutputs {{ {} at[]; }};
layout(push_constant, scalar) uniform Push {{ uint64_t inputs, outputs, root; uint count, pad; }} push;
void main() {{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    uint64_t root = push.root;
    {} x = LabInputs(push.inputs).at[i];
    {} result;
    {}
    LabOutputs(push.outputs).at[i] = result;
}}
)",
                                             head, in, out, in, out, body);
        source.name = "kernel lab";
        source.text = text;
        const auto spirv = take(compiler_->compile(source));
        const auto pipeline = take(gpu::ComputePipeline::create(*device_, spirv, sizeof(Push), {}, "kernel lab"));
        const gpu::Buffer from = take(device_->create_buffer_of<In>(inputs, "lab inputs"));
        gpu::Buffer to =
            take(device_->create_buffer(inputs.size() * sizeof(Out), gpu::BufferKind::readback, "lab outputs"));
        const Push push{from.address(), to.address(), root, std::uint32_t(inputs.size()), 0};
        gpu::CommandList list = take(device_->begin());
        list.dispatch(pipeline, gpu::push_bytes(push), std::uint32_t((inputs.size() + 63) / 64));
        if (auto ok = device_->submit_and_wait(list); !ok) FAIL(ok.error().message);
        const auto results = to.span<Out>();
        return {results.begin(), results.begin() + std::ptrdiff_t(inputs.size())};
    }

  private:
    template <class T>
    static T take(Result<T> result) {
        if (!result) FAIL(result.error().message);
        return std::move(*result);
    }
    Log log_;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<gpu::ShaderCompiler> compiler_;
};

inline KernelLab& lab() {
    static KernelLab instance;
    return instance;
}

} // namespace restage::tests
