// @LABEL@: reads text files whose first line is "@NAME@ 1", and whose others are a keyword and its values:
//   mesh NAME R G B   a mesh begins, in this colour
//   v X Y Z           a vertex of it
//   t A B C           a triangle of its vertices, which count from 1
// <restage/scene_io.h> states the requirements of an importer; `restage check` tests them.
#include <restage/scene_io.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr std::string_view first_line = "@NAME@ 1";

// The words of a line, in order. Numbers do not depend on the locale.
struct Words {
    std::string_view rest;

    std::string_view next() {
        const auto begin = std::min(rest.find_first_not_of(" \t\r"), rest.size());
        const auto end = std::min(rest.find_first_of(" \t\r", begin), rest.size());
        const std::string_view word = rest.substr(begin, end - begin);
        rest.remove_prefix(end);
        return word;
    }
    template <class T>
    bool number(T& value) {
        const std::string_view word = next();
        const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
        return code == std::errc() && end == word.data() + word.size() && std::isfinite(double(value));
    }
};

class Reading {
  public:
    Reading(const char* path, const RestageSceneWriter1& out) : path_(path), out_(out) {}

    bool run() {
        const std::filesystem::path path(std::u8string(path_, path_ + std::strlen(path_)));
        std::ifstream file(path, std::ios::binary | std::ios::ate);
        if (!file) return broken("cannot be opened");
        const auto size = double(file.tellg());
        file.seekg(0);
        std::string text;
        double done = 0;
        while (std::getline(file, text)) {
            done += double(text.size()) + 1;
            // 0 means: stop. The host then discards everything written so far.
            if (line_ % 1000 == 0 && !out_.progress(out_.ctx, float(done / size), "reading")) return false;
            ++line_;
            if (line_ == 1 ? !head(text) : !line({text})) return false;
        }
        if (line_ == 0) return broken("is empty");
        return finish_mesh() && out_.progress(out_.ctx, 1, "reading");
    }

  private:
    // "Mine, but malformed": what is wrong, where, and what was expected.
    bool broken(const std::string& message) {
        out_.error(out_.ctx, path_, line_, line_ ? 1 : 0, message.c_str());
        return false;
    }

    bool head(std::string_view text) {
        return text.starts_with(first_line) || broken("the first line is not \"" + std::string(first_line) + "\"");
    }

    bool line(Words words) {
        const std::string_view keyword = words.next();
        if (keyword.empty() || keyword.front() == '#') return true;
        if (keyword == "mesh") {
            if (!finish_mesh()) return false;
            name_ = words.next();
            return (words.number(color_[0]) && words.number(color_[1]) && words.number(color_[2])) ||
                   broken("expected: mesh NAME R G B");
        }
        if (keyword == "v") {
            float p[3];
            if (!words.number(p[0]) || !words.number(p[1]) || !words.number(p[2])) return broken("expected: v X Y Z");
            positions_.insert(positions_.end(), p, p + 3);
            return true;
        }
        if (keyword == "t") {
            for (int i = 0; i < 3; ++i) {
                uint32_t vertex = 0; // never trust an index from a file
                if (!words.number(vertex) || vertex < 1 || vertex > positions_.size() / 3)
                    return broken("expected: t A B C, each the number of a vertex above");
                indices_.push_back(vertex - 1);
            }
            return true;
        }
        // Further keywords go here.

        // Unknown keywords are reported, and reading continues.
        out_.report(out_.ctx, RESTAGE_DROPPED, path_, line_, ("\"" + std::string(keyword) + "\"").c_str(),
                    "is not known");
        return true;
    }

    // The collected triangles become a mesh, a material and an object with both. A handle of 0 means that the host has
    // refused the thing, and has reported why.
    bool finish_mesh() {
        if (indices_.empty()) {
            if (!positions_.empty()) // unused data is reported, not dropped silently
                out_.report(out_.ctx, RESTAGE_DROPPED, path_, line_, ("mesh \"" + name_ + "\"").c_str(),
                            "has no triangles");
            positions_.clear();
            return true;
        }
        RestageMesh mesh{};
        mesh.name = name_.c_str();
        mesh.vertex_count = uint32_t(positions_.size() / 3), mesh.positions = positions_.data();
        mesh.triangle_count = uint32_t(indices_.size() / 3), mesh.indices = indices_.data();

        RestageValue color{};
        color.type = RESTAGE_COLOR, color.id = "reflectance";
        std::memcpy(color.v, color_, sizeof color_);
        RestageMaterialDesc material{};
        material.name = name_.c_str();
        material.type = "diffuse"; // any material plugin's; its table defines the values
        material.values = &color, material.value_count = 1;

        RestageInstance instance{};
        instance.name = name_.c_str();
        instance.mesh = out_.mesh(out_.ctx, &mesh);
        instance.material = out_.material(out_.ctx, &material);
        instance.alpha = 1;
        for (int i = 0; i < 16; i += 5)
            instance.object_to_world[i] = 1;
        if (!instance.mesh || !instance.material || !out_.instance(out_.ctx, &instance))
            return broken("the host refuses the mesh above");
        out_.report(out_.ctx, RESTAGE_KEPT, path_, line_, ("mesh \"" + name_ + "\"").c_str(), "");
        positions_.clear(), indices_.clear();
        return true;
    }

    const char* path_;
    const RestageSceneWriter1& out_;
    uint32_t line_ = 0;
    std::string name_ = "mesh";
    float color_[3] = {0.5f, 0.5f, 0.5f};
    std::vector<float> positions_;
    std::vector<uint32_t> indices_;
};

int probe(const char*, const void* head, size_t size) {
    return std::string_view(static_cast<const char*>(head), size).starts_with(first_line) ? 100 : 0;
}

int load(const char* path, const RestageSceneWriter1* out) {
    try {
        return Reading(path, *out).run();
    } catch (const std::exception& e) { // none may leave the plugin
        out->error(out->ctx, path, 0, 0, e.what());
        return 0;
    }
}

constexpr RestageImporter1 importer{
    .format = "@NAME@",
    .label = "@LABEL@",
    .extensions = "@NAME@", // several: "one|two"
    .probe = probe,
    .load = load,
};

} // namespace

RESTAGE_PLUGIN("@ID@", "0.1.0", {RESTAGE_IMPORTER1, &importer})
