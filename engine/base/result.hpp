// SPDX-License-Identifier: Apache-2.0
// Result<T>: everything that can go wrong for reasons outside our code (files, plugins, shaders, a lost device).
// Our own bugs are `assert`. An error collects context on its way up: "scene.pbrt:41:3: shape: bunny.ply: truncated".
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace restage {

enum class ErrorKind {
    failed,
    cancelled // stopped on request: nothing to report to the requester
};

struct Error {
    std::string message; // what, where (file:line:column), what to do about it; no final newline
    ErrorKind kind = ErrorKind::failed;
    bool cancelled() const { return kind == ErrorKind::cancelled; }
};

template <class T = void>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(std::string message) { return tl::unexpected<Error>(Error{std::move(message)}); }
// Work stopped on request: "scene.pbrt: stopped on request".
inline tl::unexpected<Error> cancelled(std::string message) {
    return tl::unexpected<Error>(Error{std::move(message), ErrorKind::cancelled});
}

// Prepends context to an error from below; keeps its kind.
inline tl::unexpected<Error> fail(const std::string& context, const Error& cause) {
    return tl::unexpected<Error>(Error{context + ": " + cause.message, cause.kind});
}

} // namespace restage

#define RESTAGE_CONCAT_(a, b) a##b
#define RESTAGE_CONCAT(a, b) RESTAGE_CONCAT_(a, b)
// RESTAGE_TRY(auto x, f()): x is the value, or the error is returned.
#define RESTAGE_TRY(decl, expr)                                                                        \
    auto RESTAGE_CONCAT(result_, __LINE__) = (expr);                                                   \
    if (!RESTAGE_CONCAT(result_, __LINE__))                                                            \
        return tl::unexpected<::restage::Error>(std::move(RESTAGE_CONCAT(result_, __LINE__).error())); \
    decl = std::move(*RESTAGE_CONCAT(result_, __LINE__))
#define RESTAGE_CHECK(expr)                                                                                       \
    do {                                                                                                          \
        if (auto result_ = (expr); !result_) return tl::unexpected<::restage::Error>(std::move(result_.error())); \
    } while (false)
