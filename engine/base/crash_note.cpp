// SPDX-License-Identifier: Apache-2.0
#include "base/crash_note.hpp"

#include <mutex>
#include <string_view>

#if !defined(_WIN32)
#include <fcntl.h>
#include <unistd.h>
#include <array>
#include <csignal>
#endif

namespace restage {

#if defined(_WIN32)

CrashNote::CrashNote(Blame blame) : blame_(std::move(blame)) {}
CrashNote::~CrashNote() = default;

#else

namespace {

struct Fatal {
    int number;
    std::string_view name;
    struct sigaction before;
};

// A signal handler belongs to no object: its state is global, here and only here.
thread_local const CrashNote* current = nullptr;
std::array<Fatal, 5> fatal{{{SIGSEGV, "SIGSEGV", {}},
                            {SIGBUS, "SIGBUS", {}},
                            {SIGILL, "SIGILL", {}},
                            {SIGFPE, "SIGFPE", {}},
                            {SIGABRT, "SIGABRT", {}}}};

void put(int file, const char* text, std::size_t size) {
    while (size > 0) {
        const ssize_t n = ::write(file, text, size);
        if (n <= 0) return;
        text += n;
        size -= static_cast<std::size_t>(n);
    }
}

// Async-signal-safe calls only.
void on_fatal(int number) {
    const Fatal* which = nullptr;
    for (const Fatal& f : fatal)
        if (f.number == number) which = &f;
    if (current && !current->blame().file.empty()) {
        const int file = ::open(current->blame().file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        if (file >= 0) {
            put(file, current->blame().text.data(), current->blame().text.size());
            put(file, "\n", 1);
            if (which) put(file, which->name.data(), which->name.size());
            put(file, "\n", 1);
            ::close(file);
        }
    }
    // The previous action proceeds: a fault recurs when this returns, abort() proceeds by itself.
    if (which) sigaction(number, &which->before, nullptr);
}

void install() {
    for (Fatal& f : fatal) {
        struct sigaction action{};
        action.sa_handler = on_fatal;
        action.sa_flags = SA_ONSTACK | SA_NODEFER;
        sigaction(f.number, &action, &f.before);
    }
}

} // namespace

CrashNote::CrashNote(Blame blame) : blame_(std::move(blame)), outer_(current) {
    static std::once_flag once;
    std::call_once(once, install);
    current = this;
}

CrashNote::~CrashNote() { current = outer_; }

#endif

} // namespace restage
