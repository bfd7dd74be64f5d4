// SPDX-License-Identifier: Apache-2.0
#include "render/table_store.hpp"

#include <span>

namespace restage::render {

Result<std::vector<DeviceTable>> TableStore::find(const MaterialPlugin& plugin, const scene::ParamSet& params) {
    std::vector<DeviceTable> found;
    for (const model::Param& line : plugin.table->params) {
        if (line.type != model::ParamType::table) continue;
        const auto reader = plugin.source ? plugin.source->table_reader() : nullptr;
        if (!reader) return fail(std::string("nothing reads the table \"") + line.id + "\"");
        RESTAGE_TRY(const auto table, reader->read(line.id, table_path(line, params)));
        Held& held = held_[table];
        held.used = true;
        if (!held.buffer && !table->words.empty()) {
            const std::span<const std::uint32_t> words(table->words);
            RESTAGE_TRY(held.buffer, device_->create_buffer(words.size_bytes(), gpu::BufferKind::device, "table"));
            RESTAGE_CHECK(device_->upload(held.buffer, 0, std::as_bytes(words)));
            uploaded_bytes_ += words.size_bytes();
        }
        found.push_back({held.buffer ? held.buffer.address() : 0, static_cast<std::uint32_t>(table->words.size())});
    }
    return found;
}

void TableStore::begin() {
    for (auto& [table, held] : held_)
        held.used = false;
}

void TableStore::sweep() {
    std::erase_if(held_, [](const auto& entry) { return !entry.second.used; });
}

std::size_t TableStore::bytes() const {
    std::size_t sum = 0;
    for (const auto& [table, held] : held_)
        sum += held.buffer ? held.buffer.size() : 0;
    return sum;
}

} // namespace restage::render
