// SPDX-License-Identifier: Apache-2.0
// The stages of an import: bytes, tinyobjloader, checks, shapes, a camera and a light.
#include "load.hpp"

#include "common/file.hpp"
#include "common/stage.hpp"
#include "importer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <istream>
#include <optional>
#include <sstream>
#include <streambuf>

namespace restage::obj {

namespace fs = std::filesystem;

namespace {

// The text as a stream that tells the host how far it has been read, and ends early when the user stops.
class ProgressBuffer : public std::streambuf {
  public:
    ProgressBuffer(std::string_view text, const RestageSceneWriter1& out) : text_(text), out_(out) {}
    bool stopped() const { return stopped_; }

  protected:
    int_type underflow() override {
        if (at_ >= text_.size() || stopped_) return traits_type::eof();
        constexpr std::size_t block = 1 << 20;
        const auto share = static_cast<float>(0.7 * static_cast<double>(at_) / static_cast<double>(text_.size()));
        stopped_ = out_.progress(out_.ctx, share, "reading the model") == 0;
        if (stopped_) return traits_type::eof();
        const std::size_t size = std::min(block, text_.size() - at_);
        char* begin = const_cast<char*>(text_.data() + at_); // streambuf's get area is char*; nobody writes there
        setg(begin, begin, begin + size);
        at_ += size;
        return traits_type::to_int_type(*begin);
    }

  private:
    std::string_view text_;
    const RestageSceneWriter1& out_;
    std::size_t at_ = 0;
    bool stopped_ = false;
};

} // namespace

// tinyobjloader asks for each name of a `mtllib` line, split at blanks; all libraries are read at the first question.
struct LibraryReader : tinyobj::MaterialReader {
    Importer& importer;
    bool done = false;
    explicit LibraryReader(Importer& i) : importer(i) {}
    bool operator()(const std::string&, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* by_name, std::string* warnings, std::string*) override {
        if (!done) importer.load_libraries(materials, by_name, warnings);
        done = true;
        return true;
    }
};

Importer::Importer(const RestageSceneWriter1& writer, const fs::path& path, std::string_view text)
    : out_(writer), path_(path), text_(text), report_(writer, path.string()), lines_(scan_obj(text)) {}

void Importer::load_libraries(std::vector<tinyobj::material_t>* materials, std::map<std::string, int>* by_name,
                              std::string* warnings) {
    std::vector<std::pair<std::uint32_t, std::string>> names; // in the order of the file
    std::error_code code;
    for (const auto& [rest, line] : lines_.libraries) {
        if (fs::exists(find_file(path_.parent_path(), rest), code)) { // a name with blanks
            names.emplace_back(line, rest);
            continue;
        }
        std::istringstream words(rest);
        for (std::string word; words >> word;)
            names.emplace_back(line, word);
    }
    std::stable_sort(names.begin(), names.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [line, name] : names) {
        const fs::path file = find_file(path_.parent_path(), name);
        std::string reason;
        const auto text = read_file(file, reason);
        if (!text) {
            report_.dropped("mtllib " + quote(name),
                            "it cannot be read: " + reason + ": " + file.string() + "; its materials are grey", line);
            continue;
        }
        std::istringstream stream(*text);
        std::string errors;
        tinyobj::LoadMtl(by_name, materials, &stream, warnings, &errors);
        if (!errors.empty()) report_.approximated("material library", errors, 0, file.string());
        libraries_.push_back({file, scan_mtl(*text)});
    }
}

void Importer::parse() {
    // tinyobjloader takes what is no number for 0, and says nothing.
    if (const auto bad = find_bad_number(text_, Find::vertex)) throw ImportError{bad->what, bad->line, bad->column, {}};
    ProgressBuffer buffer(text_, out_);
    std::istream stream(&buffer);
    LibraryReader libraries(*this);
    std::string warnings, errors;
    const bool read =
        tinyobj::LoadObj(&attributes_, &shapes_, &materials_, &warnings, &errors, &stream, &libraries, true, false);
    if (buffer.stopped()) throw Cancelled{};
    if (!read) {
        while (!errors.empty() && std::strchr("\n\r ", errors.back()))
            errors.pop_back();
        throw ImportError{errors.empty() ? "the file cannot be understood" : errors};
    }
    tell_warnings(warnings);
    check_indices();
}

// Its warnings, but for those that are said better here.
void Importer::tell_warnings(const std::string& warnings) {
    std::istringstream lines(warnings);
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line.find("not found in .mtl") != line.npos || line.find("out of bounds") != line.npos ||
            line.find("material file") != line.npos)
            continue;
        std::uint32_t number = 0;
        if (const auto at = line.find("ine "); at != line.npos)
            number = static_cast<std::uint32_t>(std::strtoul(line.c_str() + at + 4, nullptr, 10));
        report_.approximated("the reader says", line, number);
    }
}

// A vertex that is not there is an error; a texture coordinate or normal that is not there is done without.
void Importer::check_indices() {
    const auto vertices = static_cast<long>(attributes_.vertices.size() / 3);
    const auto coordinates = static_cast<long>(attributes_.texcoords.size() / 2);
    const auto normals = static_cast<long>(attributes_.normals.size() / 3);
    for (const float x : attributes_.vertices)
        if (!std::isfinite(x)) throw ImportError{"a vertex is too large"};
    bool absent = false;
    for (auto& shape : shapes_)
        for (auto& i : shape.mesh.indices) {
            if (i.vertex_index < 0 || i.vertex_index >= vertices)
                throw ImportError{"a face names a vertex that is not there"};
            absent = absent || i.texcoord_index >= coordinates || i.normal_index >= normals;
            if (i.texcoord_index >= coordinates) i.texcoord_index = -1;
            if (i.normal_index >= normals) i.normal_index = -1;
        }
    if (!absent) return;
    const auto place = find_bad_number(text_, Find::attribute);
    report_.approximated("faces", (place ? place->what : "an index is out of range") + "; such corners go without",
                         place ? place->line : 0);
}

// What the file says and the scene has no place for.
void Importer::tell_leftovers() {
    std::map<std::string, const char*> notes = {
        {"l", "lines have no surface"},
        {"p", "points have no surface"},
        {"curv", "free-form curves are not read"},
        {"curv2", "free-form curves are not read"},
        {"surf", "free-form surfaces are not read; convert them to polygons"},
        {"t", "subdivision creases are not read; the cage is shown"},
    };
    for (const auto& [word, where] : lines_.skipped) {
        const auto known = notes.find(word);
        report_.dropped("statement " + quote(word),
                        std::string(known != notes.end() ? known->second : "it is not understood") +
                            (where.second > 1 ? " (" + std::to_string(where.second) + " lines)" : ""),
                        where.first);
    }
    for (const auto& [name, line] : lines_.materials) {
        const bool found = std::any_of(materials_.begin(), materials_.end(), [&](const auto& m) {
            return m.name == name || scan_mtl("newmtl " + m.name).contains(name); // blanks at the end
        });
        if (!found) report_.approximated("material " + quote(name), "no library has it; grey stands for it", line);
    }
    std::size_t unused = 0;
    for (std::size_t i = 0; i < materials_.size(); ++i)
        unused += !made_.contains(static_cast<int>(i));
    if (unused)
        report_.dropped("materials",
                        std::to_string(unused) + " of " + std::to_string(materials_.size()) + " are used by no face");
    if (!attributes_.colors.empty())
        report_.dropped("vertex colours", "objects have one colour or a texture; the material's is shown");
    if (!attributes_.skin_weights.empty()) report_.dropped("skin weights", "nothing is animated");
}

void Importer::run() {
    if (text_.starts_with("\xfe\xff") || text_.starts_with("\xff\xfe"))
        throw ImportError{"the file is UTF-16 text; save it as UTF-8", 1, 1, {}};
    if (const auto zero = text_.find('\0'); zero != text_.npos)
        throw ImportError{"byte " + std::to_string(zero) + " is zero: this is no text file", 0, 0, {}};
    parse();
    smooth();
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
        const float share = 0.7f + 0.3f * static_cast<float>(i) / static_cast<float>(shapes_.size());
        if (!out_.progress(out_.ctx, share, "making objects")) throw Cancelled{};
        shape(shapes_[i]);
    }
    if (objects_ == 0) throw ImportError{"the file holds no faces"};
    report_.kept("model", std::to_string(objects_) + " objects, " + std::to_string(triangles_) + " triangles, " +
                              std::to_string(made_.size()) + " materials");
    tell_leftovers();
    add_camera(out_, report_, bounds_, Up::y);
    add_film(out_);
    add_studio(out_, report_, Up::y);
}

// A statement of one letter, and as many numbers behind it.
bool begins_with_numbers(std::string_view line, char letter, int count) {
    if (line.size() < 2 || line[0] != letter || (line[1] != ' ' && line[1] != '\t')) return false;
    line.remove_prefix(1);
    for (; count > 0; --count) {
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        if (line.starts_with('+')) line.remove_prefix(1);
        double number = 0;
        const char* end = std::from_chars(line.data(), line.data() + line.size(), number).ptr;
        if (end == line.data()) return false;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    }
    return true;
}

int probe(const char* path, const void* head, std::size_t head_size) {
    if (has_extension(path, "obj")) return 90;
    if (!head) return 0;
    // Some other name: count lines that can only be of this format.
    const std::string_view text(static_cast<const char*>(head), head_size);
    if (text.find('\0') != text.npos) return 0;
    int vertices = 0, faces = 0;
    for (std::size_t at = 0; at < text.size(); at = std::min(text.find('\n', at), text.size()) + 1) {
        const std::string_view line = text.substr(at, std::min(text.find('\n', at), text.size()) - at);
        vertices += begins_with_numbers(line, 'v', 3);
        faces += begins_with_numbers(line, 'f', 1) || line.starts_with("mtllib ");
    }
    return vertices >= 3 ? (faces ? 60 : 30) : 0;
}

int load(const char* path, const RestageSceneWriter1* out) {
    if (!path || !out) return 0;
    return guarded_load(path, *out, [&] {
        std::error_code code;
        fs::path full = fs::weakly_canonical(path, code);
        if (code) full = path;
        std::string reason;
        const auto text = read_file(full, reason);
        if (!text) throw ImportError{"the file cannot be read: " + reason, 0, 0, {}};
        Importer(*out, full, *text).run();
    });
}

} // namespace restage::obj
