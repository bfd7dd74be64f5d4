// SPDX-License-Identifier: Apache-2.0
#include "farewell.hpp"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <utility>

#if !defined(_WIN32)
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>
#endif

namespace restage::editor {

namespace {

// State for the signal handler and Xlib's error handler.
std::atomic<int> heard = 0;
std::atomic<int> pipe_end = -1;
static_assert(std::atomic<int>::is_always_lock_free);

#if !defined(_WIN32)

constexpr int signals[] = {SIGTERM, SIGHUP, SIGINT};

void on_signal(int signal) {
    const int before = errno;
    if (int none = 0; !heard.compare_exchange_strong(none, signal)) {
        std::signal(signal, SIG_DFL);
        ::raise(signal);
    }
    const char byte = 1;
    if (const int end = pipe_end; end >= 0) [[maybe_unused]]
        const auto written = ::write(end, &byte, 1);
    errno = before;
}

#endif

} // namespace

struct Farewell::Impl {
    std::function<void()> wake, last_words;
    std::timed_mutex busy;
    std::thread::id main_thread = std::this_thread::get_id();
    std::atomic<bool> display_lost = false;
#if !defined(_WIN32)
    int pipe[2] = {-1, -1};
    std::thread reader;
    struct sigaction before[std::size(signals)]{};
#endif

    // Xlib ends the process when this returns. The failed thread holds its lock: another thread in a display call
    // is stuck, so the wait for a main thread in one must time out.
    static std::atomic<Impl*> current;
    [[noreturn]] static void display_gone() {
        Impl* self = current;
        if (self && !self->display_lost.exchange(true)) {
            const bool own = std::this_thread::get_id() == self->main_thread;
            const bool locked = !own && self->busy.try_lock_for(std::chrono::seconds(3));
            self->last_words();
            if (locked) self->busy.unlock();
        } else if (self) {
            std::this_thread::sleep_for(std::chrono::seconds(10)); // another thread is already ending the process
        }
        std::_Exit(1);
    }
    static int on_x11_error(void* /*display*/) { display_gone(); }

    void follow_display(bool on) {
#if !defined(_WIN32)
        // GLFW opened it if it is in use; nothing else of this program knows X11.
        void* library = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
        if (!library) return;
        using Handler = int (*)(void*);
        if (auto* set = reinterpret_cast<Handler (*)(Handler)>(dlsym(library, "XSetIOErrorHandler")))
            set(on ? on_x11_error : nullptr);
        dlclose(library);
#else
        (void)on;
#endif
    }
};

std::atomic<Farewell::Impl*> Farewell::Impl::current = nullptr;

Farewell::Farewell(std::function<void()> wake, std::function<void()> last_words) : impl_(std::make_unique<Impl>()) {
    impl_->wake = std::move(wake);
    impl_->last_words = std::move(last_words);
    Impl::current = impl_.get();
    heard = 0;
#if !defined(_WIN32)
    if (::pipe2(impl_->pipe, O_CLOEXEC) == 0) {
        ::fcntl(impl_->pipe[1], F_SETFL, O_NONBLOCK);
        pipe_end = impl_->pipe[1];
        impl_->reader = std::thread([this] {
            char byte = 0;
            ssize_t n = 0;
            while ((n = ::read(impl_->pipe[0], &byte, 1)) > 0 || (n < 0 && errno == EINTR)) {
                if (n > 0 && byte == 0) return;
                if (n > 0) impl_->wake();
            }
        });
    }
    struct sigaction action{};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < std::size(signals); ++i) {
        ::sigaction(signals[i], &action, &impl_->before[i]);
        if (impl_->before[i].sa_handler == SIG_IGN) ::sigaction(signals[i], &impl_->before[i], nullptr); // nohup
    }
#endif
    impl_->follow_display(true);
}

Farewell::~Farewell() {
    impl_->follow_display(false);
#if !defined(_WIN32)
    for (std::size_t i = 0; i < std::size(signals); ++i)
        ::sigaction(signals[i], &impl_->before[i], nullptr);
    pipe_end = -1;
    if (impl_->reader.joinable()) {
        const char end = 0;
        while (::write(impl_->pipe[1], &end, 1) < 0 && errno == EINTR) {
        }
        impl_->reader.join();
    }
    for (const int end : impl_->pipe)
        if (end >= 0) ::close(end);
#endif
    Impl::current = nullptr;
}

int Farewell::signal() const { return heard; }
std::timed_mutex& Farewell::busy() { return impl_->busy; }

std::string signal_name(int signal) {
    switch (signal) {
        case SIGTERM:
            return "SIGTERM";
        case SIGINT:
            return "SIGINT";
#if !defined(_WIN32)
        case SIGHUP:
            return "SIGHUP";
#endif
        default:
            return "signal " + std::to_string(signal);
    }
}

} // namespace restage::editor
