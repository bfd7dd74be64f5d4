// SPDX-License-Identifier: Apache-2.0
// Jobs: a small persistent thread pool with one primitive, parallel_for. Designed for many short loops (a tile's rays):
// a call costs one wake-up, threads draw chunks dynamically, and late sleepers are not waited for.
// Denormals are flushed to zero (FTZ, DAZ) inside every loop, as Embree recommends.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace restage {

class Jobs {
  public:
    // f(begin, end, thread): indices [begin, end), thread in [0, threads()), 0 is the caller.
    using Body = std::function<void(std::size_t begin, std::size_t end, unsigned thread)>;

    explicit Jobs(unsigned threads = hardware()); // the calling thread counts as one; 0 means hardware()
    ~Jobs();
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

    static unsigned hardware(); // logical processors this process may use, at least 1
    unsigned threads() const;

    // [any] Covers [0, count) in chunks of at most `grain` (0 counts as 1) and returns when all are done. Runs on the
    // caller alone if there is one chunk, if called from inside a loop, and while another thread's loop owns the
    // pool. If a body throws, remaining chunks are skipped and the first exception is thrown here.
    void parallel_for(std::size_t count, std::size_t grain, const Body& f);

  private:
    struct Pool;
    std::unique_ptr<Pool> pool_;
};

} // namespace restage
