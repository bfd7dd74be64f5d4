// SPDX-License-Identifier: Apache-2.0
// The pool behind Jobs: workers sleep on a condition variable until a loop is posted, then draw chunks from one atomic.
#include "base/jobs.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#if defined(__SSE2__) || defined(_M_X64)
#include <immintrin.h>
#define RESTAGE_HAVE_MXCSR 1
#endif

namespace restage {

namespace {

thread_local bool inside_loop = false;

// Sets flush-to-zero (bit 15) and denormals-are-zero (bit 6) of MXCSR and restores the previous state.
class FlushDenormals {
  public:
#if defined(RESTAGE_HAVE_MXCSR)
    FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }
    ~FlushDenormals() { _mm_setcsr(before_); }
#else
    FlushDenormals() = default;
#endif
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

  private:
#if defined(RESTAGE_HAVE_MXCSR)
    unsigned before_;
#endif
};

class InsideLoop {
  public:
    InsideLoop() { inside_loop = true; }
    ~InsideLoop() { inside_loop = false; }
    InsideLoop(const InsideLoop&) = delete;
    InsideLoop& operator=(const InsideLoop&) = delete;

  private:
    FlushDenormals flush_;
};

// One call of parallel_for; lives on the caller's stack.
struct Loop {
    const Jobs::Body* body;
    std::size_t count, grain;
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::exception_ptr error; // written once, by the thread that sets `failed`

    void run(unsigned thread) {
        InsideLoop scope;
        while (!failed.load(std::memory_order_relaxed)) {
            const std::size_t begin = next.fetch_add(grain, std::memory_order_relaxed);
            if (begin >= count) return;
            try {
                (*body)(begin, std::min(begin + grain, count), thread);
            } catch (...) {
                if (!failed.exchange(true)) error = std::current_exception();
            }
        }
    }
};

} // namespace

struct Jobs::Pool {
    std::mutex call; // held by the thread whose loop owns the pool
    std::mutex mutex;
    std::condition_variable wake, idle;
    Loop* loop = nullptr; // guarded by mutex, as is everything below
    std::uint64_t generation = 0;
    unsigned running = 0;
    bool stop = false;
    std::vector<std::thread> workers;

    void work(unsigned thread) {
        std::uint64_t seen = 0;
        std::unique_lock lock(mutex);
        for (;;) {
            wake.wait(lock, [&] { return stop || (loop && generation != seen); });
            if (stop) return;
            seen = generation;
            Loop* mine = loop;
            ++running;
            lock.unlock();
            mine->run(thread);
            lock.lock();
            if (--running == 0) idle.notify_one();
        }
    }
};

unsigned Jobs::hardware() { return std::max(1u, std::thread::hardware_concurrency()); }

Jobs::Jobs(unsigned threads) : pool_(std::make_unique<Pool>()) {
    const unsigned wanted = threads ? threads : hardware();
    for (unsigned i = 1; i < wanted; ++i)
        pool_->workers.emplace_back([pool = pool_.get(), i] { pool->work(i); });
}

Jobs::~Jobs() {
    {
        std::lock_guard lock(pool_->mutex);
        pool_->stop = true;
    }
    pool_->wake.notify_all();
    for (auto& worker : pool_->workers)
        worker.join();
}

unsigned Jobs::threads() const { return static_cast<unsigned>(pool_->workers.size()) + 1; }

void Jobs::parallel_for(std::size_t count, std::size_t grain, const Body& f) {
    if (count == 0) return;
    grain = std::max<std::size_t>(grain, 1);
    const std::size_t chunks = (count - 1) / grain + 1;
    if (inside_loop) {
        for (std::size_t begin = 0; begin < count; begin += grain)
            f(begin, std::min(begin + grain, count), 0);
        return;
    }
    Loop loop{.body = &f, .count = count, .grain = grain, .error = {}};
    std::unique_lock call(pool_->call, std::defer_lock);
    if (chunks == 1 || pool_->workers.empty() || !call.try_lock()) {
        loop.run(0);
    } else {
        {
            std::lock_guard lock(pool_->mutex);
            pool_->loop = &loop;
            ++pool_->generation;
        }
        if (chunks - 1 < pool_->workers.size())
            for (std::size_t i = 1; i < chunks; ++i)
                pool_->wake.notify_one();
        else
            pool_->wake.notify_all();
        loop.run(0);
        std::unique_lock lock(pool_->mutex);
        pool_->loop = nullptr; // threads still asleep do not join any more
        pool_->idle.wait(lock, [&] { return pool_->running == 0; });
    }
    if (loop.error) std::rethrow_exception(loop.error);
}

} // namespace restage
