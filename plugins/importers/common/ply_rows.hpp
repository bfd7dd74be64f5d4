// SPDX-License-Identifier: Apache-2.0
// The numbers of a PLY file after its header, in sequence.
#pragma once

#include "common/ply_header.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace restage::importing {

class PlyRows {
  public:
    PlyRows(std::string_view bytes, const PlyHeader& header);

    // At the line or byte read last.
    [[noreturn]] void fail(const std::string& what) const;
    static std::string shortest(double); // of a number, in messages

    // Rows that cannot exist are refused before memory is allocated.
    void check_count(const PlyElement&) const;
    double number(PlyType);
    std::size_t list_count(const PlyProperty&);
    void skip(const PlyProperty&);

    // Rows of a binary element without lists have a constant size: plain() returns them all, and skips past them.
    bool is_plain(const PlyElement& element) const { return !ascii_ && !element.has_lists; }
    const char* plain(const PlyElement&); // null if lists occur or there are no rows
    bool skip_plain(const PlyElement& element) { return plain(element) != nullptr; }
    bool swaps() const { return swap_; } // the file's byte order is not this machine's
    double load(PlyType, const char* from) const;
    // A face of three 32-bit indices after a count of 8 bits, if one follows in this machine's byte order.
    bool take_plain_triangle(std::uint32_t (&corners)[3]);

    std::size_t position() const { return position_; } // [byte]

  private:
    double ascii_number();
    std::size_t left() const { return bytes_.size() - position_; }

    std::string_view bytes_;
    bool ascii_, swap_;
    std::size_t position_, last_; // of the next number, and of the last
};

} // namespace restage::importing
