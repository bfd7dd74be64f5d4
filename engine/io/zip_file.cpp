// SPDX-License-Identifier: Apache-2.0
#include "io/zip_file.hpp"

#include "base/file.hpp"

#include <zlib.h>
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace restage::io {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t local_mark = 0x04034b50, central_mark = 0x02014b50, end_mark = 0x06054b50;
constexpr std::size_t local_size = 30, central_size = 46, end_size = 22, most_comment = 65535;
constexpr std::uint16_t version = 20, utf8_names = 1u << 11, encrypted = 1, stored = 0, deflated = 8;
constexpr std::uint16_t first_day = (1u << 5) | 1u; // 1 January 1980
constexpr std::uint64_t most_archive = 0xffffffffu;
constexpr std::size_t most_files = 0xffffu;
constexpr std::uint32_t kind_of_file = 0170000, a_link = 0120000; // of Unix modes

class Bytes { // little-endian
  public:
    Bytes& u16(std::uint32_t x) { return put(x, 2); }
    Bytes& u32(std::uint32_t x) { return put(x, 4); }
    Bytes& text(std::string_view s) {
        out += s;
        return *this;
    }
    std::string out;

  private:
    Bytes& put(std::uint32_t x, int bytes) {
        for (int i = 0; i < bytes; ++i)
            out += static_cast<char>(x >> (8 * i) & 0xff);
        return *this;
    }
};

std::uint32_t number(std::string_view bytes, std::size_t at, int size) {
    std::uint32_t x = 0;
    for (int i = 0; i < size; ++i)
        x |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)])) << (8 * i);
    return x;
}
std::uint16_t u16(std::string_view bytes, std::size_t at) { return static_cast<std::uint16_t>(number(bytes, at, 2)); }
std::uint32_t u32(std::string_view bytes, std::size_t at) { return number(bytes, at, 4); }

struct Item {
    std::string name; // with '/', relative
    std::uint16_t method = stored, flags = 0;
    std::uint32_t crc = 0, packed = 0, size = 0, offset = 0, attributes = 0;
};

std::uint32_t crc_of(std::string_view bytes) {
    uLong crc = crc32(0, nullptr, 0);
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t n = std::min<std::size_t>(bytes.size() - at, 1u << 30);
        crc = crc32(crc, reinterpret_cast<const Bytef*>(bytes.data() + at), static_cast<uInt>(n));
        at += n;
    }
    return static_cast<std::uint32_t>(crc);
}

// Raw deflate; "" if that is not smaller. `bytes`: below 4 GiB.
std::string compress(std::string_view bytes) {
    z_stream z{};
    if (bytes.empty() || deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        return {};
    std::string out(bytes.size(), '\0');
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data())); // zlib does not write to it
    z.avail_in = static_cast<uInt>(bytes.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = static_cast<uInt>(out.size());
    const bool fits = deflate(&z, Z_FINISH) == Z_STREAM_END;
    out.resize(fits ? z.total_out : 0);
    deflateEnd(&z);
    return out;
}

std::optional<std::string> inflate_all(std::string_view bytes, std::size_t size) {
    z_stream z{};
    if (inflateInit2(&z, -MAX_WBITS) != Z_OK) return std::nullopt;
    std::string out(size + 1, '\0'); // a byte more, to notice if there are more
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    z.avail_in = static_cast<uInt>(bytes.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = static_cast<uInt>(std::min<std::size_t>(out.size(), most_archive));
    const bool whole = inflate(&z, Z_FINISH) == Z_STREAM_END && z.total_out == size;
    inflateEnd(&z);
    out.resize(size);
    return whole ? std::optional(std::move(out)) : std::nullopt;
}

std::string local_header(const Item& item) {
    Bytes head;
    head.u32(local_mark).u16(version).u16(item.flags).u16(item.method).u16(0).u16(first_day);
    head.u32(item.crc).u32(item.packed).u32(item.size);
    head.u16(static_cast<std::uint32_t>(item.name.size())).u16(0).text(item.name);
    return std::move(head.out);
}

std::string central_header(const Item& item) {
    Bytes head;
    head.u32(central_mark).u16(version).u16(version).u16(item.flags).u16(item.method).u16(0).u16(first_day);
    head.u32(item.crc).u32(item.packed).u32(item.size);
    head.u16(static_cast<std::uint32_t>(item.name.size())).u16(0).u16(0).u16(0).u16(0);
    head.u32(item.attributes).u32(item.offset).text(item.name);
    return std::move(head.out);
}

Result<std::vector<fs::path>> files_below(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code code;
    for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end; at.increment(code))
        if (at->is_regular_file(code)) files.push_back(at->path());
    if (code) return fail(folder.string() + ": cannot be listed: " + code.message());
    std::ranges::sort(files);
    return files;
}

std::string not_whole(const fs::path& archive) { return archive.string() + ": is not a whole zip file; copy it again"; }

Result<std::vector<Item>> directory(const fs::path& archive, std::string_view bytes) {
    const std::string damaged = not_whole(archive);
    if (bytes.size() < end_size) return fail(damaged);
    std::size_t end = bytes.size() - end_size;
    const std::size_t first = end > most_comment ? end - most_comment : 0;
    while (u32(bytes, end) != end_mark) {
        if (end == first) return fail(damaged);
        --end;
    }
    const std::size_t count = u16(bytes, end + 10);
    std::size_t at = u32(bytes, end + 16);
    std::vector<Item> items;
    for (std::size_t i = 0; i < count; ++i) {
        if (at > end || end - at < central_size || u32(bytes, at) != central_mark) return fail(damaged);
        Item item{.name = {},
                  .method = u16(bytes, at + 10),
                  .flags = u16(bytes, at + 8),
                  .crc = u32(bytes, at + 16),
                  .packed = u32(bytes, at + 20),
                  .size = u32(bytes, at + 24),
                  .offset = u32(bytes, at + 42),
                  .attributes = u32(bytes, at + 38)};
        const std::size_t name = u16(bytes, at + 28);
        const std::size_t next = at + central_size + name + u16(bytes, at + 30) + u16(bytes, at + 32);
        if (next > end) return fail(damaged);
        item.name = bytes.substr(at + central_size, name);
        at = next;
        items.push_back(std::move(item));
    }
    return items;
}

// "" or why a file of that name is not unpacked.
std::string objection(const Item& item) {
    const std::string& name = item.name;
    const bool drive = name.size() > 1 && name[1] == ':';
    if (name.empty() || name[0] == '/' || drive || name.find_first_of(std::string_view("\\\0", 2)) != name.npos)
        return "is not a relative path";
    for (const fs::path& part : fs::path(name))
        if (part == "..") return "leads out of the folder";
    if ((item.attributes >> 16 & kind_of_file) == a_link) return "is a link";
    if (item.flags & encrypted) return "is encrypted";
    if (item.method != stored && item.method != deflated) return "is compressed in an unknown way";
    return {};
}

Result<std::string> content(const Item& item, std::string_view bytes) {
    const auto damaged = [&] { return fail("\"" + item.name + "\" is damaged"); };
    const std::size_t at = item.offset;
    if (at > bytes.size() || bytes.size() - at < local_size || u32(bytes, at) != local_mark) return damaged();
    const std::size_t start = at + local_size + u16(bytes, at + 26) + u16(bytes, at + 28);
    if (start > bytes.size() || bytes.size() - start < item.packed) return damaged();
    const std::string_view packed = bytes.substr(start, item.packed);
    std::optional<std::string> whole;
    if (item.method == deflated)
        whole = inflate_all(packed, item.size);
    else if (item.packed == item.size)
        whole.emplace(packed);
    if (!whole || crc_of(*whole) != item.crc) return damaged();
    return std::move(*whole);
}

Result<> write_items(const std::vector<Item>& items, std::string_view bytes, const fs::path& folder,
                     const Progress& progress) {
    std::size_t done = 0;
    for (const Item& item : items) {
        if (progress && !progress(static_cast<float>(done++) / static_cast<float>(items.size()), item.name))
            return cancelled("unpacking: stopped on request");
        const fs::path place = folder / fs::path(item.name);
        std::error_code code;
        if (item.name.back() == '/') {
            fs::create_directories(place, code);
            continue;
        }
        fs::create_directories(place.parent_path(), code);
        RESTAGE_TRY(const std::string whole, content(item, bytes));
        RESTAGE_CHECK(write_file_atomic(place, whole));
    }
    return {};
}

} // namespace

Result<> write_zip(const fs::path& archive, const fs::path& folder, const Progress& progress) {
    RESTAGE_TRY(const std::vector<fs::path> files, files_below(folder));
    const std::string too_big = archive.string() + ": a zip file holds 65,535 files and 4 GiB; write a folder instead";
    if (files.size() > most_files) return fail(too_big);
    RESTAGE_TRY(AtomicFile out, AtomicFile::create(archive));
    std::uint64_t written = 0;
    const auto put = [&](std::string_view bytes) -> Result<> {
        written += bytes.size();
        if (written > most_archive) return fail(too_big);
        return out.write(bytes);
    };
    std::string central;
    for (std::size_t i = 0; i < files.size(); ++i) {
        Item item{.name = files[i].lexically_relative(folder).generic_string(), .flags = utf8_names};
        if (progress && !progress(static_cast<float>(i) / static_cast<float>(files.size()), item.name))
            return cancelled(archive.string() + ": stopped on request");
        RESTAGE_TRY(const std::string bytes, read_file(files[i]));
        if (bytes.size() > most_archive) return fail(too_big);
        const std::string small = compress(bytes);
        item.method = small.empty() ? stored : deflated;
        const std::string_view content = small.empty() ? std::string_view(bytes) : std::string_view(small);
        item.crc = crc_of(bytes);
        item.size = static_cast<std::uint32_t>(bytes.size());
        item.packed = static_cast<std::uint32_t>(content.size());
        item.offset = static_cast<std::uint32_t>(written);
        RESTAGE_CHECK(put(local_header(item)));
        RESTAGE_CHECK(put(content));
        central += central_header(item);
    }
    const auto count = static_cast<std::uint32_t>(files.size()), start = static_cast<std::uint32_t>(written);
    RESTAGE_CHECK(put(central));
    Bytes end;
    end.u32(end_mark).u16(0).u16(0).u16(count).u16(count).u32(static_cast<std::uint32_t>(central.size())).u32(start);
    RESTAGE_CHECK(put(end.u16(0).out));
    return out.commit();
}

Result<> unpack_zip(const fs::path& archive, const fs::path& folder, const Progress& progress, std::uint64_t most) {
    std::error_code code;
    if (fs::exists(folder, code)) return fail(folder.string() + ": exists already");
    RESTAGE_TRY(const std::string bytes, read_file(archive));
    RESTAGE_TRY(const std::vector<Item> items, directory(archive, bytes));
    std::uint64_t total = 0;
    for (const Item& item : items) {
        if (const std::string why = objection(item); !why.empty())
            return fail(archive.string() + ": is not unpacked: \"" + item.name + "\" " + why);
        total += item.size;
    }
    if (total > most) return fail(archive.string() + ": is not unpacked: it holds " + std::to_string(total) + " bytes");
    const fs::path partial = folder.string() + ".part";
    fs::remove_all(partial, code);
    fs::create_directories(partial, code);
    if (code) return fail(partial.string() + ": cannot be created: " + code.message());
    auto done = write_items(items, bytes, partial, progress);
    if (done) {
        fs::rename(partial, folder, code);
        if (code) done = fail(folder.string() + ": cannot be created: " + code.message());
    }
    if (done) return {};
    fs::remove_all(partial, code);
    return fail(archive.string(), done.error());
}

} // namespace restage::io
