// SPDX-License-Identifier: Apache-2.0
#include "fonts.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

constexpr auto scripts = std::to_array<Script>({
    {"Chinese", U'\u6905', 0x3400, 0x9fff},
    {"Japanese", U'\u30b9', 0x3040, 0x30ff},
    {"Korean", U'\uc758', 0xac00, 0xd7af},
    {"Hebrew", U'\u05d0', 0x0590, 0x05ff},
    {"Arabic", U'\u0627', 0x0600, 0x06ff},
    {"Devanagari", U'\u0915', 0x0900, 0x097f},
    {"Thai", U'\u0e01', 0x0e00, 0x0e7f},
    {"Georgian", U'\u10d0', 0x10a0, 0x10ff},
    {"Armenian", U'\u0531', 0x0530, 0x058f},
});
constexpr std::size_t most_files = 20000; // of all folders
constexpr int most_faces = 16;

// Big-endian numbers of an OpenType file (ISO/IEC 14496-22), read in place: CJK fonts are 20 MB.
class FontFile {
  public:
    explicit FontFile(const fs::path& file) : in_(file, std::ios::binary) {}

    std::uint32_t u16(std::uint64_t at) { return number(at, 2); }
    std::uint32_t u32(std::uint64_t at) { return number(at, 4); }
    bool good() const { return good_; }

    int faces() { return u32(0) == tag("ttcf") ? int(std::min<std::uint32_t>(u32(8), most_faces)) : 1; }

    bool has(int face, char32_t c) {
        const std::uint64_t start = u32(0) == tag("ttcf") ? u32(12 + 4 * std::uint64_t(face)) : 0;
        const std::uint32_t tables = std::min(u16(start + 4), 256u);
        for (std::uint32_t i = 0; i < tables && good_; ++i) {
            const std::uint64_t record = start + 12 + 16 * std::uint64_t(i);
            if (u32(record) == tag("cmap")) return in_cmap(u32(record + 8), c);
        }
        return false;
    }

  private:
    static std::uint32_t tag(const char* t) {
        std::uint32_t n = 0;
        for (int i = 0; i < 4; ++i)
            n = n << 8 | std::uint8_t(t[i]);
        return n;
    }
    std::uint32_t number(std::uint64_t at, int bytes) {
        std::array<char, 4> data{};
        in_.clear();
        if (!in_.seekg(std::streamoff(at)) || !in_.read(data.data(), bytes)) {
            good_ = false;
            return 0;
        }
        std::uint32_t n = 0;
        for (int i = 0; i < bytes; ++i)
            n = n << 8 | std::uint8_t(data[std::size_t(i)]);
        return n;
    }
    bool in_cmap(std::uint64_t cmap, char32_t c) {
        const std::uint32_t count = std::min(u16(cmap + 2), 64u);
        for (std::uint32_t i = 0; i < count && good_; ++i) {
            const std::uint64_t table = cmap + u32(cmap + 4 + 8 * std::uint64_t(i) + 4);
            const std::uint32_t format = u16(table);
            if ((format == 4 && in_segments(table, c)) || (format == 12 && in_groups(table, c))) return true;
        }
        return false;
    }
    bool in_segments(std::uint64_t table, char32_t c) { // format 4
        if (c > 0xffff) return false;
        const std::uint64_t twice = u16(table + 6);
        std::uint64_t low = 0, high = twice / 2; // the first segment that ends at or after c
        while (low < high) {
            const std::uint64_t middle = (low + high) / 2;
            if (u16(table + 14 + 2 * middle) < c)
                low = middle + 1;
            else
                high = middle;
        }
        if (low >= twice / 2 || !good_) return false;
        const std::uint64_t starts = table + 16 + twice, deltas = starts + twice, offsets = deltas + twice;
        const std::uint32_t first = u16(starts + 2 * low), delta = u16(deltas + 2 * low),
                            offset = u16(offsets + 2 * low);
        if (c < first) return false;
        if (offset == 0) return ((c + delta) & 0xffff) != 0;
        return u16(offsets + 2 * low + offset + 2 * (std::uint64_t(c) - first)) != 0;
    }
    bool in_groups(std::uint64_t table, char32_t c) { // format 12
        std::uint64_t low = 0, high = u32(table + 12);
        while (low < high && good_) {
            const std::uint64_t middle = (low + high) / 2, group = table + 16 + 12 * middle;
            if (u32(group + 4) < c)
                low = middle + 1;
            else if (u32(group) > c)
                high = middle;
            else
                return u32(group + 8) + (c - u32(group)) != 0;
        }
        return false;
    }

    std::ifstream in_;
    bool good_ = true;
};

// Regular faces first, and fonts for many scripts before those for one.
int preference(const fs::path& file) {
    std::string name = file.filename().string();
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    const auto says = [&](std::initializer_list<const char*> words) {
        return std::any_of(words.begin(), words.end(), [&](const char* w) { return name.find(w) != name.npos; });
    };
    int rank = 2;
    if (says({"cjk", "fallback", "sourcehan", "unifont", "arialuni"})) rank = 0;
    if (says({"hei", "gothic", "nanum", "msyh", "pingfang", "dejavusans."})) rank = 1;
    if (says({"bold", "italic", "oblique", "mono", "condensed", "thin", "light", "black", "serif", "mincho"}))
        rank += 4;
    return rank;
}

} // namespace

std::span<const Script> known_scripts() { return scripts; }

const Script* script_of(char32_t c) {
    const auto found =
        std::find_if(scripts.begin(), scripts.end(), [&](const Script& s) { return c >= s.first && c <= s.last; });
    return found == scripts.end() ? nullptr : &*found;
}

std::vector<fs::path> system_font_folders() {
    std::vector<fs::path> folders;
    const auto below = [&](const char* variable, const char* rest) {
        if (const char* value = std::getenv(variable); value && *value) folders.push_back(fs::path(value) / rest);
    };
#if defined(_WIN32)
    below("WINDIR", "Fonts");
    below("LOCALAPPDATA", "Microsoft/Windows/Fonts");
#elif defined(__APPLE__)
    folders = {"/System/Library/Fonts", "/Library/Fonts"};
    below("HOME", "Library/Fonts");
#else
    below("XDG_DATA_HOME", "fonts");
    below("HOME", ".local/share/fonts");
    below("HOME", ".fonts");
    folders.insert(folders.end(), {"/usr/local/share/fonts", "/usr/share/fonts"});
#endif
    return folders;
}

bool font_has(const fs::path& file, int face, char32_t c) {
    FontFile font(file);
    return face >= 0 && face < font.faces() && font.has(face, c) && font.good();
}

FallbackFonts find_fallback_fonts(std::span<const fs::path> folders) {
    std::vector<fs::path> files;
    for (const fs::path& folder : folders) {
        std::error_code code;
        for (fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, code), end;
             !code && it != end && files.size() < most_files; it.increment(code)) {
            const std::string extension = it->path().extension().string();
            std::error_code none; // reading a FIFO called .ttf would block forever
            if ((extension == ".ttf" || extension == ".ttc" || extension == ".otf") && it->is_regular_file(none))
                files.push_back(it->path());
        }
    }
    // Independent of directory order.
    std::ranges::sort(files, {}, [](const fs::path& p) { return std::pair(preference(p), p.string()); });

    FallbackFonts found;
    std::vector<const Script*> wanted;
    for (const Script& script : scripts)
        wanted.push_back(&script);
    for (const fs::path& file : files) {
        if (wanted.empty()) break;
        FontFile font(file);
        const std::size_t before = wanted.size();
        std::erase_if(wanted, [&](const Script* script) { return font.has(0, script->sample) && font.good(); });
        if (wanted.size() < before) found.fonts.push_back({file, 0});
    }
    for (const Script* script : wanted)
        found.missing.emplace_back(script->name);
    return found;
}

} // namespace restage::editor
