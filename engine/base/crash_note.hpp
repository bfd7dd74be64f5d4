// SPDX-License-Identifier: Apache-2.0
// CrashNote: what to blame if this thread crashes now. While one exists, a fatal signal on its thread (SIGSEGV,
// SIGBUS, SIGILL, SIGFPE, SIGABRT) writes a note to a file before the program terminates as usual; nothing is
// written otherwise. POSIX; elsewhere it does nothing. Covers neither other threads nor stack overflow.
#pragma once

#include <string>

namespace restage {

// The file to write, whose folder must exist, and its text, followed by a line with the signal's name.
struct Blame {
    std::string file, text; // empty: nothing to blame
};

class CrashNote {
  public:
    explicit CrashNote(Blame blame);
    ~CrashNote();
    CrashNote(const CrashNote&) = delete;

    const Blame& blame() const { return blame_; }

  private:
    Blame blame_;
    const CrashNote* outer_ = nullptr; // the thread's enclosing note
};

} // namespace restage
