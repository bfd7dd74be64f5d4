// SPDX-License-Identifier: Apache-2.0
// CrashNote: who is to blame if this thread crashes now. While one lives, a fatal signal of its thread (SIGSEGV,
// SIGBUS, SIGILL, SIGFPE, SIGABRT) writes a note into a file before the program ends as it would have ended; nothing is
// written otherwise. POSIX; elsewhere it does nothing. Not for crashes of other threads, nor of an overflowed stack.
#pragma once

#include <string>

namespace restage {

// The file to write, whose folder must exist, and what it will hold before a line with the signal's name.
struct Blame {
    std::string file, text; // empty: nobody is to blame
};

class CrashNote {
  public:
    explicit CrashNote(Blame blame);
    ~CrashNote();
    CrashNote(const CrashNote&) = delete;

    const Blame& blame() const { return blame_; }

  private:
    Blame blame_;
    const CrashNote* outer_ = nullptr; // of this thread, while this one lives
};

} // namespace restage
