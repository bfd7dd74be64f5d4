// SPDX-License-Identifier: Apache-2.0
#include "base/process.hpp"

#if defined(_WIN32)

namespace restage {
Result<ProcessOutcome> run_process(const Process& process) {
    return fail((process.argv.empty() ? "" : process.argv[0]) +
                ": running a separate program with limits is not supported on Windows yet");
}
} // namespace restage

#else

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

extern char** environ;

namespace restage {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t most_kept = 256 * 1024; // of each stream, and of one line

struct Pipe { // closed with its owner
    std::array<int, 2> fd{-1, -1};
    Pipe() = default;
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() { close_end(0), close_end(1); }
    bool open() {
#if defined(__linux__)
        if (::pipe2(fd.data(), O_CLOEXEC) != 0) return false; // atomically: another thread may fork at any moment
#else
        if (::pipe(fd.data()) != 0) return false;
        for (const int end : fd)
            ::fcntl(end, F_SETFD, FD_CLOEXEC);
#endif
        for (int& end : fd) { // not a child's 0, 1 or 2, which may have been closed when we started
            if (end > 2) continue;
            const int higher = ::fcntl(end, F_DUPFD_CLOEXEC, 3);
            if (higher < 0) return false;
            ::close(std::exchange(end, higher));
        }
        return true;
    }
    void close_end(std::size_t i) {
        if (fd[i] >= 0) ::close(std::exchange(fd[i], -1));
    }
};

// Splits a stream into lines, or keeps its tail.
struct Stream {
    const std::function<void(std::string_view)>& on_line;
    std::string& kept;
    std::string partial{};

    void take(std::string_view bytes) {
        if (!on_line) {
            kept.append(bytes);
            if (kept.size() > 2 * most_kept) kept.erase(0, kept.size() - most_kept);
            return;
        }
        for (std::size_t end; (end = bytes.find('\n')) != bytes.npos; bytes.remove_prefix(end + 1)) {
            partial.append(bytes.substr(0, end));
            on_line(partial);
            partial.clear();
        }
        partial.append(bytes.substr(0, most_kept - std::min(most_kept, partial.size())));
    }
    void finish() {
        if (!partial.empty()) on_line(partial);
        if (kept.size() > most_kept) kept.erase(0, kept.size() - most_kept);
    }
};

std::string seconds_text(std::chrono::milliseconds t) {
    const auto ms = t.count();
    return ms % 1000 ? std::to_string(ms) + " ms" : std::to_string(ms / 1000) + " s";
}

std::string signal_text(int number) {
    static const std::map<int, const char*> names = {
        {SIGSEGV, "SIGSEGV"}, {SIGABRT, "SIGABRT"}, {SIGBUS, "SIGBUS"},   {SIGFPE, "SIGFPE"},   {SIGILL, "SIGILL"},
        {SIGKILL, "SIGKILL"}, {SIGTERM, "SIGTERM"}, {SIGPIPE, "SIGPIPE"}, {SIGTRAP, "SIGTRAP"}, {SIGINT, "SIGINT"}};
    const auto it = names.find(number);
    return (it == names.end() ? "signal " + std::to_string(number) : it->second) + " (" + ::strsignal(number) + ")";
}

// Between fork and exec only async-signal-safe calls (POSIX): other threads may have held any lock.
[[noreturn]] void become(char* const* argv, char* const* env, std::uint64_t memory_limit, pid_t parent, int out,
                         int err, int report) {
    ::setpgid(0, 0);
#if defined(__linux__)
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127); // the parent died before prctl
#else
    (void)parent;
#endif
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::signal(SIGPIPE, SIG_DFL);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    int bad = 0;
    if (memory_limit > 0) {
        const rlimit limit{static_cast<rlim_t>(memory_limit), static_cast<rlim_t>(memory_limit)};
        if (::setrlimit(RLIMIT_AS, &limit) != 0) bad = errno;
    }
    const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (!bad && (nothing < 0 || ::dup2(nothing, 0) < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0)) bad = errno;
    if (!bad) ::execve(argv[0], argv, env), bad = errno;
    [[maybe_unused]] const ssize_t told = ::write(report, &bad, sizeof bad);
    ::_exit(127);
}

std::vector<std::string> environment_of(const Process& process) {
    std::vector<std::string> all;
    for (char** e = environ; *e; ++e) {
        const std::string_view line = *e;
        const std::string_view name = line.substr(0, line.find('='));
        if (std::none_of(process.environment.begin(), process.environment.end(),
                         [&](const auto& set) { return set.first == name; }))
            all.emplace_back(line);
    }
    for (const auto& [name, value] : process.environment)
        all.push_back(name + "=" + value);
    return all;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
    std::vector<char*> result;
    for (std::string& s : strings)
        result.push_back(s.data());
    result.push_back(nullptr);
    return result;
}

bool has_ended(pid_t child) { // without reaping it, so that its group can still be killed
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child;
}

// Reads what is available. False at the end of the stream.
bool drain(int fd, Stream& stream, bool& heard) {
    std::array<char, 16384> bytes;
    while (true) {
        const ssize_t n = ::read(fd, bytes.data(), bytes.size());
        if (n > 0) stream.take({bytes.data(), static_cast<std::size_t>(n)}), heard = true;
        if (n == 0 || (n < 0 && errno != EINTR && errno != EAGAIN)) return false;
        if (n < static_cast<ssize_t>(bytes.size())) return true;
    }
}

} // namespace

Result<ProcessOutcome> run_process(const Process& process) {
    if (process.argv.empty()) return fail("no program given to run");
    std::vector<std::string> arguments = process.argv, environment = environment_of(process);
    const auto argv = pointers(arguments), env = pointers(environment);
    const auto system_error = [&](const char* doing, int code) {
        return fail(process.argv[0] + ": " + doing + ": " + std::strerror(code));
    };
    Pipe out, err, report;
    if (!out.open() || !err.open() || !report.open()) return system_error("cannot create a pipe", errno);
    const auto start = Clock::now();
    const pid_t parent = ::getpid(), child = ::fork();
    if (child < 0) return system_error("cannot be started", errno);
    if (child == 0) become(argv.data(), env.data(), process.memory_limit, parent, out.fd[1], err.fd[1], report.fd[1]);
    ::setpgid(child, child); // whichever of the two comes first
    for (Pipe* pipe : {&out, &err, &report})
        pipe->close_end(1);
    int bad = 0;
    if (::read(report.fd[0], &bad, sizeof bad) == sizeof bad) {
        ::waitpid(child, nullptr, 0);
        return system_error("cannot be started", bad);
    }

    ProcessOutcome outcome;
    Stream streams[] = {{process.on_out, outcome.out}, {process.on_err, outcome.err}};
    pollfd polled[] = {{out.fd[0], POLLIN, 0}, {err.fd[0], POLLIN, 0}};
    for (const pollfd& p : polled)
        ::fcntl(p.fd, F_SETFL, O_NONBLOCK);
    const auto read_all = [&] {
        bool heard = false;
        for (std::size_t i = 0; i < 2; ++i)
            if (polled[i].fd >= 0 && !drain(polled[i].fd, streams[i], heard)) polled[i].fd = -1;
        return heard;
    };
    auto last_heard = start;
    bool ended = false;
    while (!(ended = has_ended(child))) {
        const auto now = Clock::now();
        const auto over = [&](std::chrono::milliseconds limit, Clock::time_point since) {
            return limit.count() > 0 && now - since >= limit;
        };
        if (over(process.time_limit, start))
            outcome.end = ProcessEnd::time_limit;
        else if (over(process.silence_limit, last_heard))
            outcome.end = ProcessEnd::silence_limit;
        else if (process.cancel && *process.cancel)
            outcome.end = ProcessEnd::cancelled;
        if (outcome.end != ProcessEnd::exited) break;
        ::poll(polled, 2, polled[0].fd < 0 && polled[1].fd < 0 ? 5 : 50);
        if (read_all()) last_heard = Clock::now();
    }
    ::kill(-child, SIGKILL); // also processes that it started and did not end
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    read_all();
    for (Stream& stream : streams)
        stream.finish();
    outcome.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    switch (outcome.end) {
        case ProcessEnd::time_limit:
            outcome.what = "no end within " + seconds_text(process.time_limit);
            break;
        case ProcessEnd::silence_limit:
            outcome.what = "no sign of life for " + seconds_text(process.silence_limit);
            break;
        case ProcessEnd::cancelled:
            outcome.what = "cancelled";
            break;
        default:
            outcome.end = WIFSIGNALED(status) ? ProcessEnd::signalled : ProcessEnd::exited;
            outcome.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
            outcome.what =
                WIFSIGNALED(status) ? signal_text(outcome.code) : "exit code " + std::to_string(outcome.code);
    }
    return outcome;
}

} // namespace restage

#endif
