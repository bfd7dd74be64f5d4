// SPDX-License-Identifier: Apache-2.0
// TableReader: files of a material's table parameters, read through its plugin. Results are cached by
// parameter, path, time and size of the file, so that all callers share the words. [any] thread; one file at a time.
#pragma once

#include "base/crash_note.hpp"
#include "base/log.hpp"
#include "base/result.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

struct RestageTable1;

namespace restage::plugin {

struct Table { // immutable once shared
    std::vector<std::uint32_t> words;
    std::vector<std::string> notes; // remarks of its reader
};

class TableReader {
  public:
    // The table must be valid until close(). Errors: an incomplete table.
    static Result<std::shared_ptr<TableReader>> open(const RestageTable1& table, std::string plugin_id, Log& log);
    TableReader(const RestageTable1& table, std::string plugin_id, Log& log);

    const std::string& material_type() const { return type_; }
    const std::vector<std::string>& extensions() const { return extensions_; }

    // The file's words. An empty path is an empty table. Errors: '<path>: it is cut short: ...'.
    Result<std::shared_ptr<const Table>> read(const std::string& param, const std::string& path);
    // The last error of `read`, without accessing the file or waiting; "" = none
    // known.
    std::string problem(const std::string& param, const std::string& path) const;

    void set_blame(Blame blame); // for crash notes while it reads
    void close(); // before the plugin is unloaded: afterwards only cached files can be read

  private:
    struct Seen {
        std::uint64_t stamp = 0; // of the file
        std::weak_ptr<const Table> table;
        std::string error;
    };
    Result<std::shared_ptr<const Table>> read_file(const std::string& param, const std::string& path);

    std::string type_, plugin_id_;
    std::vector<std::string> extensions_;
    Log& log_;
    mutable std::mutex mutex_;
    const RestageTable1* table_; // null when closed
    Blame blame_;
    std::map<std::pair<std::string, std::string>, Seen> seen_; // by parameter and path
    // The last few, so that checking and rendering a scene do not both read.
    std::array<std::shared_ptr<const Table>, 4> recent_;
    std::size_t next_recent_ = 0;
};

} // namespace restage::plugin
