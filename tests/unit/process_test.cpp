// SPDX-License-Identifier: Apache-2.0
// base/process: output, exit codes, signals, limits, and that a child leaves no processes behind.
#include "base/process.hpp"
#include "temporary_folder.hpp"

#include <catch2/catch_test_macros.hpp>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include <csignal>

using namespace restage;
using namespace std::chrono_literals;

namespace {

Process shell(const std::string& script) { return {.argv = {"/bin/sh", "-c", script}}; }
ProcessOutcome run(const Process& process) {
    const auto outcome = run_process(process);
    if (!outcome) FAIL(outcome.error().message);
    return *outcome;
}

} // namespace

TEST_CASE("process: both streams and the exit code are returned", "[process]") {
    const auto outcome = run(shell("echo one; echo two >&2; exit 3"));
    CHECK(outcome.end == ProcessEnd::exited);
    CHECK(outcome.code == 3);
    CHECK(outcome.what == "exit code 3");
    CHECK(outcome.out == "one\n");
    CHECK(outcome.err == "two\n");
    CHECK_FALSE(outcome.ok());
    CHECK(run(shell("true")).ok());
}

TEST_CASE("process: arguments are passed unchanged, variables are set, input is empty", "[process]") {
    Process process{.argv = {"/bin/sh", "-c", "printf '%s|' \"$@\" \"$COLOUR\"; cat", "sh", "a b", "$HOME", "*"}};
    process.environment = {{"COLOUR", "teal"}};
    CHECK(run(process).out == "a b|$HOME|*|teal|");
}

TEST_CASE("process: a child has its three streams and no other descriptor, however many are started at once",
          "[process]") {
    if (!std::filesystem::exists("/proc/self/fd")) SKIP("needs /proc");
    // Pipes of the other threads are open at any moment. Descriptors inherited by this test are in every child.
    const std::string alone = run(shell("exec ls /proc/self/fd")).out;
    std::vector<std::thread> threads;
    std::atomic<int> wrong{0};
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 8; ++i)
                if (run_process(shell("exec ls /proc/self/fd"))->out != alone) ++wrong;
        });
    for (auto& thread : threads)
        thread.join();
    CHECK(wrong == 0);
}

TEST_CASE("process: lines arrive whole, the last without its newline", "[process]") {
    std::vector<std::string> lines;
    Process process = shell("printf 'a'; sleep 0.1; printf 'b\\n\\nc'");
    process.on_out = [&](std::string_view line) { lines.emplace_back(line); };
    CHECK(run(process).out.empty());
    CHECK(lines == std::vector<std::string>{"ab", "", "c"});
}

TEST_CASE("process: long output is read completely, and its end is kept", "[process]") {
    const auto outcome =
        run(shell("i=0; while [ $i -lt 30000 ]; do echo 0123456789012345678901234567890123456789; "
                  "i=$((i+1)); done; echo end"));
    CHECK(outcome.ok());
    CHECK(outcome.out.size() <= 256 * 1024);
    CHECK(outcome.out.ends_with("end\n"));
}

TEST_CASE("process: a signal is named", "[process]") {
    const auto outcome = run(shell("kill -SEGV $$"));
    CHECK(outcome.end == ProcessEnd::signalled);
    CHECK(outcome.code == SIGSEGV);
    CHECK(outcome.what.starts_with("SIGSEGV ("));
}

TEST_CASE("process: the limits end it and its children", "[process]") {
    test::TemporaryFolder folder;
    const std::string mark = (folder.path() / "mark").string();
    Process process = shell("(sleep 1; touch " + mark + ") & echo begun; while :; do :; done");
    SECTION("time") {
        process.time_limit = 200ms;
        const auto outcome = run(process);
        CHECK(outcome.end == ProcessEnd::time_limit);
        CHECK(outcome.what == "no end within 200 ms");
        CHECK(outcome.out == "begun\n");
        CHECK(outcome.seconds < 0.9);
    }
    SECTION("silence") {
        process.silence_limit = 300ms;
        const auto outcome = run(process);
        CHECK(outcome.end == ProcessEnd::silence_limit);
        CHECK(outcome.what == "no sign of life for 300 ms");
    }
    SECTION("cancelled") {
        std::atomic<bool> cancel = false;
        process.cancel = &cancel;
        std::thread later([&] { std::this_thread::sleep_for(200ms), cancel = true; });
        const auto outcome = run(process);
        later.join();
        CHECK(outcome.end == ProcessEnd::cancelled);
    }
    std::this_thread::sleep_for(1200ms);
    CHECK_FALSE(std::filesystem::exists(mark));
}

TEST_CASE("process: regular output keeps it running under a limit of silence", "[process]") {
    Process process = shell("for i in 1 2 3 4 5 6; do echo $i; sleep 0.1; done");
    process.silence_limit = 400ms;
    CHECK(run(process).ok());
}

TEST_CASE("process: an orphan that holds the pipe is not waited for", "[process]") {
    Process process = shell("sleep 20 & exit 0");
    const auto outcome = run(process);
    CHECK(outcome.ok());
    CHECK(outcome.seconds < 5);
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
TEST_CASE("process: the address space is limited", "[process]") {
    Process process{.argv = {"/usr/bin/env", "dd", "if=/dev/zero", "of=/dev/null", "bs=400M", "count=1"}};
    CHECK(run(process).ok());
    process.memory_limit = 200u << 20;
    CHECK_FALSE(run(process).ok());
}
#endif

TEST_CASE("process: a program that cannot be started is an error with its name", "[process]") {
    const auto outcome = run_process({.argv = {"/no/such/program"}});
    REQUIRE_FALSE(outcome);
    CHECK(outcome.error().message == "/no/such/program: cannot be started: No such file or directory");
}
