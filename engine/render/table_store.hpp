// SPDX-License-Identifier: Apache-2.0
// TableStore: the tables that materials look up (restage/table.h), in device memory: each file once, however many
// materials name it. No work that reads it may be running while it changes.
#pragma once

#include "gpu/device.hpp"
#include "plugin/table_reader.hpp"
#include "render/material_types.hpp"

#include <map>

namespace restage::render {

class TableStore {
  public:
    explicit TableStore(gpu::Device& device) : device_(&device) {}

    // For the model::ParamType::table lines of a material, in order. Reads and uploads new or changed ones.
    Result<std::vector<DeviceTable>> find(const MaterialPlugin&, const scene::ParamSet&);
    // Tables not requested with find between these two calls are dropped.
    void begin();
    void sweep();

    std::size_t bytes() const; // of device memory
    std::size_t uploaded_bytes() const { return uploaded_bytes_; } // in total

  private:
    struct Held {
        gpu::Buffer buffer;
        bool used = false;
    };
    gpu::Device* device_;
    std::map<std::shared_ptr<const plugin::Table>, Held> held_;
    std::size_t uploaded_bytes_ = 0;
};

} // namespace restage::render
