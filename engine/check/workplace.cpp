// SPDX-License-Identifier: Apache-2.0
#include "check/workplace.hpp"

#include "base/file.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <fstream>
#include <locale>
#include <random>
#include <sstream>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace restage::check {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
    std::error_code ignored;
    path = fs::temp_directory_path(ignored) / fmt::format("restage-check-{}", std::random_device{}());
    fs::create_directories(path, ignored);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

std::string noise(Engine& e, std::size_t kind, std::string_view head) {
    std::string bytes(head);
    const std::size_t length = kind == 0 ? 0 : kind < 4 ? kind : e() % 4096;
    for (std::size_t i = 0; i < length; ++i)
        switch (kind % 3) {
            case 0:
                bytes += static_cast<char>(e() % 256);
                break;
            case 1:
                bytes += i % 40 == 39 ? '\n' : static_cast<char>(' ' + e() % 95);
                break;
            default: // numbers and separators that break parsers
                constexpr std::string_view words[] = {"0",          "1",           "-1",    "1e38",
                                                      "4294967295", "-2147483648", "nan",   "inf",
                                                      "0.5",        "\n",          "1e-45", "99999999999999999999"};
                bytes += std::string(words[e() % std::size(words)]) + " ";
                break;
        }
    return bytes;
}

std::string broken_version(Engine& e, const std::string& good, std::size_t kind) {
    if (good.empty()) return good;
    const std::size_t at = e() % good.size(), length = 1 + e() % std::max<std::size_t>(good.size() / 4, 1);
    std::string bad = good;
    switch (kind % 4) {
        case 0:
            bad.resize(at);
            break;
        case 1:
            for (std::size_t i = 0; i < 1 + good.size() / 64; ++i)
                bad[e() % bad.size()] = static_cast<char>(e() % 256);
            break;
        case 2:
            bad.erase(at, length);
            break;
        default:
            bad.insert(at, good, at, length);
            break;
    }
    return bad;
}

namespace {

std::size_t entries(const char* folder) {
    std::size_t count = 0;
    std::error_code code;
    for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code))
        ++count;
    return count;
}

} // namespace

std::size_t open_files() { return entries("/proc/self/fd"); }

Resources resources() {
    Resources r;
    std::istringstream statm(read_file("/proc/self/statm").value_or(""));
    statm.imbue(std::locale::classic());
    std::size_t total = 0, pages = 0;
    if (statm >> total >> pages) r.resident = pages * 4096;
    const std::string maps = read_file("/proc/self/maps").value_or("");
    r.mappings = static_cast<std::size_t>(std::count(maps.begin(), maps.end(), '\n'));
    r.files = open_files();
    r.threads = entries("/proc/self/task");
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
    const auto info = mallinfo2();
    r.heap = info.uordblks + info.hblkhd;
#endif
    return r;
}

Result<StepResult> check_nothing_left(const std::string& what, const std::function<Result<>()>& once) {
    constexpr std::size_t warm_up = 20, times = 100;
    // Tolerates the allocator's spare pages, and 40 bytes per run for caches that are still filling.
    constexpr std::size_t most_resident = 1 << 20, most_heap = 40 * times;
    Resources before;
    for (std::size_t i = 0; i < warm_up + times; ++i) {
        if (i == warm_up) before = resources();
        if (const auto done = once(); !done) return StepResult::failed(done.error().message);
    }
    const Resources after = resources();
    const auto grown = [&](std::size_t Resources::* of) { return after.*of > before.*of ? after.*of - before.*of : 0; };
    const std::size_t heap = grown(&Resources::heap), resident = grown(&Resources::resident);
    const std::vector<Figure> figures = {{"runs", double(times)},
                                         {"memory left", double(heap) / times, "bytes per run"}};
    const struct {
        std::size_t count;
        const char* things;
    } left[] = {{grown(&Resources::files), "files are left open"},
                {grown(&Resources::threads), "threads are left running"},
                {grown(&Resources::mappings), "mappings are leaked"}};
    for (const auto& [count, things] : left)
        if (count > times / 4)
            return StepResult::failed(fmt::format("{} {} by {} times {}", count, things, times, what), figures);
    if (heap > most_heap || (before.heap == 0 && resident > most_resident))
        return StepResult::failed(
            fmt::format("{} times {} leave {} bytes allocated", times, what, before.heap ? heap : resident), figures);
    return StepResult::passed(figures);
}

Result<> write_scratch(const fs::path& path, std::string_view bytes) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) return fail(path.string() + ": cannot be written");
    return {};
}

Contents contents_of(const fs::path& folder) {
    Contents all;
    std::error_code code;
    for (fs::recursive_directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
        std::error_code ignored;
        if (!it->is_regular_file(ignored)) continue;
        auto text = read_file(it->path());
        all.emplace_back(it->path().lexically_relative(folder).generic_string(), text ? std::move(*text) : "");
    }
    std::sort(all.begin(), all.end());
    return all;
}

std::string first_difference(const Contents& before, const Contents& after) {
    if (before == after) return "";
    std::size_t i = 0;
    while (i < std::min(before.size(), after.size()) && before[i] == after[i])
        ++i;
    if (i == before.size() || i == after.size() || before[i].first != after[i].first)
        return i < before.size() ? before[i].first : after[i].first;
    const auto& [name, text] = after[i];
    const auto end = std::mismatch(text.begin(), text.end(), before[i].second.begin(), before[i].second.end()).first;
    const auto at = static_cast<std::size_t>(end - text.begin());
    const std::size_t begin = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
    std::string line = text.substr(begin, std::min<std::size_t>(text.find('\n', at) - begin, 100));
    for (char& c : line)
        if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > 126) c = '?';
    return fmt::format("{}:{}: {}", name, 1 + std::count(text.begin(), end, '\n'), line);
}

} // namespace restage::check
