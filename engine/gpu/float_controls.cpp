// SPDX-License-Identifier: Apache-2.0
// The logical layout of a module is fixed (SPIR-V 1.6, 2.4): capabilities come first, execution modes directly after
// the entry points. So two insertions suffice, and the disk cache is the same for every device.
#include "gpu/float_controls.hpp"

namespace restage::gpu {

namespace {

constexpr std::size_t header_words = 5;
constexpr std::uint32_t op_entry_point = 15, op_execution_mode = 16, op_capability = 17;
constexpr std::uint32_t signed_zero_inf_nan_preserve = 4466, mode_of_it = 4461, bits = 32;

constexpr std::uint32_t instruction(std::uint32_t words, std::uint32_t op) { return words << 16 | op; }

} // namespace

std::vector<std::uint32_t> keep_nan(std::span<const std::uint32_t> words) {
    const std::vector<std::uint32_t> same(words.begin(), words.end());
    std::vector<std::uint32_t> entries;
    std::size_t modes_at = 0;
    for (std::size_t at = header_words; at < words.size();) {
        const std::uint32_t size = words[at] >> 16, op = words[at] & 0xffff;
        if (size == 0 || size > words.size() - at) return same;
        if (op == op_entry_point && size > 2) {
            entries.push_back(words[at + 2]);
            modes_at = at + size;
        }
        if (op == op_capability && size > 1 && words[at + 1] == signed_zero_inf_nan_preserve) return same;
        at += size;
    }
    if (entries.empty()) return same;
    std::vector<std::uint32_t> out;
    out.reserve(words.size() + 2 + 4 * entries.size());
    out.assign(words.begin(), words.begin() + header_words);
    out.insert(out.end(), {instruction(2, op_capability), signed_zero_inf_nan_preserve});
    out.insert(out.end(), words.begin() + header_words, words.begin() + static_cast<std::ptrdiff_t>(modes_at));
    for (const std::uint32_t entry : entries)
        out.insert(out.end(), {instruction(4, op_execution_mode), entry, mode_of_it, bits});
    out.insert(out.end(), words.begin() + static_cast<std::ptrdiff_t>(modes_at), words.end());
    return out;
}

} // namespace restage::gpu
