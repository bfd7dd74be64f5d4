// SPDX-License-Identifier: Apache-2.0
// One loaded shared library, closed with its owner. The only user of dlopen and LoadLibrary.
#pragma once

#include "base/result.hpp"

#include <filesystem>

namespace restage::plugin {

class Library {
  public:
    // Symbols are resolved immediately and stay invisible to other libraries, so a mismatched plugin fails here.
    static Result<Library> open(const std::filesystem::path&);
    // Likewise from a private copy, so that the file may be replaced, or opened again, while this one is in use.
    static Result<Library> open_copy(const std::filesystem::path&);
    static const char* extension(); // ".so", ".dll"

    Library(Library&&) noexcept;
    Library& operator=(Library&&) noexcept;
    ~Library();

    void* symbol(const char* name) const; // null if not exported

  private:
    explicit Library(void* handle) : handle_(handle) {}
    void* handle_;
};

} // namespace restage::plugin
