// SPDX-License-Identifier: Apache-2.0
// One device for the GPU tests, with validation and synchronization validation, its messages counted.
#pragma once

#include "base/file.hpp"
#include "gpu/compiler.hpp"
#include "gpu/device.hpp"
#include "gpu/pipeline.hpp"
#include "temporary_folder.hpp"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

#include <filesystem>
#include <iostream>
#include <string>

#include <unistd.h>

namespace restage::gpu::test {

// Fails the test with the error's message.
template <class T>
T value(Result<T> result) {
    if (!result) FAIL(result.error().message);
    return std::move(*result);
}
inline void ok(const Result<void>& result) {
    if (!result) FAIL(result.error().message);
}

// With these files in it.
class TemporaryFolder : public restage::test::TemporaryFolder {
  public:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path() / name).parent_path());
        ok(write_file_atomic(path() / name, text));
        return path() / name;
    }
};

// A device with validation. `silent()` at the end of a test: the layers reported nothing.
class TestDevice {
  public:
    explicit TestDevice(bool ray_tracing = false) {
        device_ = value(Device::create({.validation = true, .require_ray_tracing = ray_tracing}, log_));
    }
    Device& operator*() { return *device_; }
    Device* operator->() { return device_.get(); }
    void silent() {
        const auto messages = device_->validation_messages();
        for (const std::string& message : messages)
            UNSCOPED_INFO(message);
        CHECK(messages.empty());
    }

  private:
    Log log_;
    std::unique_ptr<Device> device_;
};

inline Spirv compile(const std::string& text, ShaderStage stage = ShaderStage::compute) {
    return value(ShaderCompiler({}).compile({.name = "test shader", .text = text, .stage = stage}));
}

inline const std::string glsl_head = R"(#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
)";

} // namespace restage::gpu::test
