// SPDX-License-Identifier: Apache-2.0
#include "standard_streams.hpp"

#include "base/file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>
#include <string_view>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

namespace restage::app {

namespace fs = std::filesystem;

namespace {

fs::path new_name(const fs::path& folder, const std::string& extension) {
    std::random_device random;
    return folder / (".restage-" + std::to_string(random()) + std::to_string(random()) + "." + extension);
}

void in_binary([[maybe_unused]] std::FILE* stream) {
#ifdef _WIN32
    _setmode(_fileno(stream), _O_BINARY);
#endif
}

} // namespace

TemporaryFile::~TemporaryFile() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove(path_, ignored);
}

Result<TemporaryFile> scene_from_stdin(const std::string& extension) {
    in_binary(stdin);
    std::string bytes;
    char piece[1 << 16];
    while (const std::size_t n = std::fread(piece, 1, sizeof piece, stdin)) {
        bytes.append(piece, n);
        if (bytes.size() > most_file_bytes) return fail("stdin: exceeds the limit of 16 GiB");
    }
    if (std::ferror(stdin)) return fail(std::string("stdin: cannot be read: ") + std::strerror(errno));
    if (bytes.empty()) return fail("stdin: is empty; pipe a scene into it");
    const fs::path path = new_name(".", extension);
    if (auto written = write_file_atomic(path, bytes); !written)
        return fail(
            "stdin: the scene is stored briefly in the current folder, as its own paths are relative to "
            "it: " +
            written.error().message);
    return TemporaryFile(path);
}

Result<> check_file_path(const std::string& path) {
    if (path.empty() || path == "-") return {};
    const fs::path folder = fs::path(path).parent_path();
    std::error_code code;
    if (!folder.empty() && !fs::is_directory(folder, code))
        return fail(path + ": there is no folder " + folder.string() + "; create it first, or choose another folder");
    if (const auto there = fs::status(path, code); fs::exists(there) && !fs::is_regular_file(there))
        return fail(path + ": exists already and is not a file that can be replaced");
    return {};
}

Result<Output> Output::create(const std::string& text) {
    if (text != "-" && !text.ends_with(":-")) return Output(text);
    const std::string format = text == "-" ? "exr" : text.substr(0, text.size() - 2);
    static constexpr std::string_view known[] = {"exr", "png", "jpg", "jpeg", "pfm", "hdr"};
    if (std::find(std::begin(known), std::end(known), format) == std::end(known))
        return fail("-o " + text + ": for stdout use exr:-, png:-, jpg:-, pfm:- or hdr:-; - alone is exr:-");
    std::error_code error;
    const fs::path folder = fs::temp_directory_path(error);
    if (error) return fail("-o " + text + ": no temporary folder: " + error.message());
    return Output(TemporaryFile(new_name(folder, format)));
}

Result<> Output::finish() const {
    if (!to_stdout()) return {};
    RESTAGE_TRY(const std::string bytes, read_file(file_.path()));
    in_binary(stdout);
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
        return fail(std::string("stdout: cannot be written to: ") + std::strerror(errno));
    return {};
}

} // namespace restage::app
