// SPDX-License-Identifier: Apache-2.0
// The host's side of restage.table/1: the file is open only while being read, and no reader can leave the
// words incomplete.
#include "plugin/table_reader.hpp"

#include "base/file.hpp"
#include "plugin/abi.hpp"
#include "plugin/adapters.hpp"
#include "plugin/tables.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <new>
#include <system_error>

namespace restage::plugin {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t most_words = std::uint64_t{1} << 28; // 1 GiB

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

struct Reading {
    std::unique_ptr<std::FILE, CloseFile> file;
    std::uint64_t length = 0, at = 0;
    Table table;
    std::string error;
    std::uint32_t line = 0;

    void refuse(std::uint32_t where, std::string sentence) {
        if (error.empty()) line = where, error = std::move(sentence);
    }
};

Reading& of(void* ctx) { return *static_cast<Reading*>(ctx); }

int bytes(void* ctx, std::uint64_t offset, std::uint64_t count, void* out) {
    Reading& r = of(ctx);
    if (offset > r.length || count > r.length - offset) {
        r.refuse(0, "its " + std::to_string(r.length) + " bytes end before the expected data");
        return 0;
    }
    if (offset != r.at && std::fseek(r.file.get(), static_cast<long>(offset), SEEK_SET) != 0) {
        r.refuse(0, "it cannot be read: " + std::generic_category().message(errno));
        return 0;
    }
    const bool all = std::fread(out, 1, count, r.file.get()) == count;
    r.at = offset + count;
    if (!all) r.refuse(0, "it is unreadable, or changed meanwhile");
    return all;
}

std::uint32_t* append(void* ctx, std::uint64_t count) {
    Reading& r = of(ctx);
    auto& words = r.table.words;
    try {
        if (count <= most_words - words.size()) {
            words.resize(words.size() + count);
            return words.data() + words.size() - count;
        }
    } catch (const std::bad_alloc&) {
        r.refuse(0, "there is not enough memory for it");
        return nullptr;
    }
    r.refuse(0, "it would be a table of more than " + std::to_string(most_words >> 18) + " MiB");
    return nullptr;
}

void note(void* ctx, const char* line) {
    if (line && of(ctx).table.notes.size() < 32) of(ctx).table.notes.emplace_back(line);
}

void error(void* ctx, std::uint32_t line, const char* sentence) {
    of(ctx).refuse(line, sentence && *sentence ? sentence : "it was refused");
}

// Changes when the file does; 0 = missing.
std::uint64_t stamp_of(const std::string& path) {
    std::error_code code;
    const auto size = fs::file_size(path, code);
    if (code) return 0;
    const auto time = fs::last_write_time(path, code).time_since_epoch().count();
    return hash64(std::to_string(time) + ' ' + std::to_string(size), 1) | 1;
}

} // namespace

Result<std::shared_ptr<TableReader>> TableReader::open(const RestageTable1& table, std::string plugin_id, Log& log) {
    if (table.size < RESTAGE_SIZE_UP_TO(RestageTable1, read))
        return fail("its table " RESTAGE_TABLE1 " has " + std::to_string(table.size) + " bytes, " +
                    std::to_string(RESTAGE_SIZE_UP_TO(RestageTable1, read)) + " are needed: rebuild it with this SDK");
    if (!table.type || !is_type_name(table.type)) return fail("a table reader that names no material");
    const std::string who = std::string("the table reader of \"") + table.type + "\"";
    if (!table.extensions || !*table.extensions) return fail(who + " names no extensions");
    if (!table.read) return fail(who + " lacks read");
    return std::make_shared<TableReader>(table, std::move(plugin_id), log);
}

TableReader::TableReader(const RestageTable1& table, std::string plugin_id, Log& log)
    : type_(table.type),
      plugin_id_(std::move(plugin_id)),
      extensions_(split_words(table.extensions)),
      log_(log),
      table_(&table) {}

void TableReader::set_blame(Blame blame) {
    const std::lock_guard lock(mutex_);
    blame_ = std::move(blame);
}

void TableReader::close() {
    const std::lock_guard lock(mutex_);
    table_ = nullptr;
}

std::string TableReader::problem(const std::string& param, const std::string& path) const {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return "";
    const auto found = seen_.find({param, path});
    return found == seen_.end() ? "" : found->second.error;
}

Result<std::shared_ptr<const Table>> TableReader::read(const std::string& param, const std::string& path) {
    static const auto empty = std::make_shared<const Table>();
    if (path.empty()) return empty;
    const std::lock_guard lock(mutex_);
    Seen& seen = seen_[{param, path}];
    const std::uint64_t stamp = stamp_of(path);
    if (seen.stamp == stamp && stamp != 0) {
        if (auto table = seen.table.lock()) return table;
        if (!seen.error.empty()) return fail(seen.error);
    }
    auto result = read_file(param, path);
    seen.stamp = stamp;
    seen.error = result ? "" : result.error().message;
    if (result) {
        seen.table = *result;
        recent_[next_recent_++ % recent_.size()] = *result;
        for (const std::string& line : (*result)->notes)
            log_.info(plugin_id_ + ": " + path + ": " + line);
    }
    return result;
}

Result<std::shared_ptr<const Table>> TableReader::read_file(const std::string& param, const std::string& path) {
    if (!table_) return fail(path + ": the plugin that reads it (" + plugin_id_ + ") has been replaced");
    Reading r;
    if (!fs::path(path).is_absolute()) return fail(path + ": the path of a table must be absolute");
    RESTAGE_TRY(RegularFile regular, RegularFile::open(path));
    r.length = regular.size();
    r.file.reset(regular.release());
    const RestageTableFile1 file{.size = sizeof(RestageTableFile1),
                                 .reserved = 0,
                                 .ctx = &r,
                                 .path = path.c_str(),
                                 .length = r.length,
                                 .bytes = bytes,
                                 .append = append,
                                 .note = note,
                                 .error = error};
    const CrashNote crash(blame_);
    const bool done = table_->read(param.c_str(), &file) != 0;
    const std::string where = path + (r.line ? ":" + std::to_string(r.line) : "");
    if (!r.error.empty()) return fail(where + ": " + r.error);
    if (!done) return fail(where + ": " + plugin_id_ + " refused it without giving a reason");
    return std::make_shared<const Table>(std::move(r.table));
}

} // namespace restage::plugin
