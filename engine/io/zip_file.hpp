// SPDX-License-Identifier: Apache-2.0
// Zip archives of files (APPNOTE.TXT 6.3.3, without zip64 and encryption): up to 65,535 files and 4 GiB, deflated where
// that makes them smaller.
#pragma once

#include "base/result.hpp"
#include "io/report.hpp"

#include <filesystem>

namespace restage::io {

// All regular files below `folder`, in order of their names and without their times: the same files give the same
// bytes. Errors: a file cannot be read, `archive` cannot be written, or they are too many or too big for the format.
// [any]
Result<> write_zip(const std::filesystem::path& archive, const std::filesystem::path& folder, const Progress& = {});

// Into `folder`, which must not exist: it appears when everything is in it. Refused: names that are absolute or lead
// out of the folder, links, encrypted files, damaged ones (their CRC-32), and more than `most` bytes in all. [any]
Result<> unpack_zip(const std::filesystem::path& archive, const std::filesystem::path& folder, const Progress& = {},
                    std::uint64_t most = std::uint64_t{16} << 30);

} // namespace restage::io
