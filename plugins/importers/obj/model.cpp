// SPDX-License-Identifier: Apache-2.0
// Reading OBJ. Not through tinyobjloader: it stores coordinates as floats, allows at most 255 corners per face, ends
// names at blanks, joins no lines, and reports neither lines nor columns. The meaning of statements is from Bourke's
// page on OBJ and Alias|Wavefront's manual, appendix B.
#include "model.hpp"

#include "common/error.hpp"
#include "common/large_coordinates.hpp"
#include "common/polygon.hpp"
#include "lines.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <unordered_map>

namespace restage::obj {

using namespace importing;

namespace {

constexpr const char* kinds[3] = {"vertex", "texture coordinate", "normal"};

class Reader {
  public:
    Reader(std::string_view text, const std::function<bool(double)>& goes_on)
        : text_(text), goes_on_(goes_on), statements_(text) {}

    Model read() {
        std::size_t told = 0;
        while (statements_.next(now_)) {
            statement();
            if (statements_.position() - told < (1 << 20)) continue;
            told = statements_.position();
            if (!goes_on_(static_cast<double>(told) / static_cast<double>(text_.size()))) throw Cancelled{};
        }
        if (!any_color_) model_.colors.clear();
        model_.vertices = recentred(positions_, model_.origin);
        cut();
        resolve(model_.points);
        resolve(model_.lines);
        return std::move(model_);
    }

  private:
    [[noreturn]] static void fail(const std::string& what, std::uint32_t line, std::uint32_t column) {
        throw ImportError{what, line, column, {}};
    }

    void statement() {
        const std::string_view word = now_.word;
        if (word == "v")
            vertex();
        else if (word == "vt")
            numbers(model_.coordinates, 2, false);
        else if (word == "vn")
            numbers(model_.normals, 3, true);
        else if (word == "f" || word == "fo")
            face();
        else if (word == "o" || word == "g")
            shape_ = {std::string(now_.rest), now_.line, true};
        else if (word == "s")
            smoothing();
        else if (word == "usemtl")
            material();
        else if (word == "mtllib")
            model_.libraries.emplace_back(now_.rest, now_.line);
        else if (word == "l" || word == "p")
            strokes(word == "l");
        else {
            auto& entry = model_.skipped.try_emplace(std::string(word), now_.line, 0).first->second;
            ++entry.second;
        }
    }

    void vertex() { // x y z, x y z w, or x y z r g b
        double values[6] = {};
        std::size_t count = 0;
        Words words(now_.rest, now_.column);
        for (; count < 6; ++count) {
            const auto word = words.next();
            if (!word) break;
            const auto value = number(*word);
            if (count < 3 && (!value || std::abs(*value) > double(std::numeric_limits<float>::max())))
                fail("the coordinate \"" + std::string(*word) + "\" is not a finite number", now_.line, words.column());
            values[count] = value.value_or(0);
        }
        if (count < 3) fail("a vertex has three coordinates; this one has fewer", now_.line, now_.column);
        positions_.insert(positions_.end(), values, values + 3);
        const bool colored = count == 6;
        any_color_ |= colored;
        const double top = std::max({values[3], values[4], values[5]}) > 1 ? 255 : 1; // some write bytes
        for (std::size_t c = 3; c < 6; ++c)
            model_.colors.push_back(colored ? static_cast<float>(std::clamp(values[c] / top, 0.0, 1.0)) : 1);
    }

    void numbers(std::vector<float>& to, std::size_t width, bool all) { // missing ones are 0
        Words words(now_.rest, now_.column);
        for (std::size_t i = 0; i < width; ++i) {
            const auto word = words.next();
            const auto value = word ? number(*word) : std::nullopt;
            if (!value && (word || all || i == 0))
                ++model_.skipped.try_emplace(broken_name(), now_.line, 0).first->second.second;
            const double most = double(std::numeric_limits<float>::max());
            to.push_back(static_cast<float>(std::clamp(value.value_or(0), -most, most)));
        }
    }
    std::string broken_name() const { return std::string(now_.word) + " without its numbers"; }

    void smoothing() { // a number, or "off"
        smoothing_ = 0;
        std::from_chars(now_.rest.data(), now_.rest.data() + now_.rest.size(), smoothing_);
    }

    void material() {
        const auto [it, fresh] =
            material_ids_.try_emplace(std::string(now_.rest), static_cast<int>(model_.materials.size()));
        if (fresh) model_.materials.emplace_back(it->first, now_.line);
        material_ = it->second;
    }

    long count(int kind) const {
        return static_cast<long>(kind == 0   ? positions_.size() / 3
                                 : kind == 1 ? model_.coordinates.size() / 2
                                             : model_.normals.size() / 3);
    }

    void absent(const std::string& what) {
        if (model_.absent_count++ == 0) model_.absent = {what, now_.line};
    }

    // "7/2/-1": index by index; a trailing slash is ignored. Negative ones count back from here.
    Corner corner(std::string_view word, std::uint32_t column) {
        Corner result;
        std::size_t from = 0;
        for (int kind = 0; kind < 3 && from <= word.size(); ++kind) {
            const std::size_t end = std::min(word.find('/', from), word.size());
            const std::string_view digits = word.substr(from, end - from);
            int* to = kind == 0 ? &result.vertex : kind == 1 ? &result.coordinate : &result.normal;
            long index = 0;
            const char* begin = digits.data() + (digits.starts_with('+') ? 1 : 0);
            const auto parsed = std::from_chars(begin, digits.data() + digits.size(), index);
            const bool whole = parsed.ec == std::errc() && parsed.ptr == digits.data() + digits.size();
            const auto says = [&](const std::string& text) {
                if (kind == 0) fail(text, now_.line, column + static_cast<std::uint32_t>(from));
                absent(text);
            };
            if (digits.empty() && kind > 0) {
                // without it
            } else if (!whole) {
                says("the face names \"" + std::string(digits) + "\", which is not an index");
            } else if (index == 0 || index < -count(kind) || index > std::numeric_limits<int>::max()) {
                says(names(kind, index));
            } else {
                *to = static_cast<int>(index > 0 ? index - 1 : count(kind) + index);
            }
            from = end + 1;
        }
        return result;
    }
    std::string names(int kind, long index) const {
        return "the face names " + std::string(kinds[kind]) + " " + std::to_string(index) + " of " +
               std::to_string(count(kind)) + (index == 0 ? "; they count from 1" : "");
    }

    void face() {
        Words words(now_.rest, now_.column);
        Face face{corners_.size(), 0, now_.line, material_, smoothing_, 0};
        while (const auto word = words.next())
            corners_.push_back(corner(*word, words.column()));
        face.end = corners_.size();
        if (face.end - face.begin < 3) {
            corners_.resize(face.begin);
            ++model_.skipped.try_emplace("f with fewer than three corners", now_.line, 0).first->second.second;
            return;
        }
        if (shape_.fresh) shapes_.push_back(shape_), shape_.fresh = false;
        face.shape = shapes_.size() - 1;
        faces_.push_back(face);
    }

    void strokes(bool lines) {
        Words words(now_.rest, now_.column);
        std::optional<std::uint32_t> before;
        while (const auto word = words.next()) {
            const auto index = static_cast<std::uint32_t>(corner(*word, words.column()).vertex);
            if (!lines) model_.points.push_back(index);
            if (lines && before) model_.lines.insert(model_.lines.end(), {*before, index});
            before = index;
        }
        auto& entry = model_.skipped.try_emplace(std::string(now_.word), now_.line, 0).first->second;
        ++entry.second;
    }

    void resolve(std::vector<std::uint32_t>& vertices) const { // like faces, these may name later vertices
        for (const std::uint32_t i : vertices)
            if (i >= count(0))
                throw ImportError{"a line or point names vertex " + std::to_string(i + 1) + " of " +
                                  std::to_string(count(0))};
    }

    struct Face {
        std::size_t begin, end;
        std::uint32_t line;
        int material;
        std::uint32_t smoothing;
        std::size_t shape;
    };
    struct Begun {
        std::string name{};
        std::uint32_t line = 0;
        bool fresh = true;
    };

    // The place in the text where this line's face names that vertex.
    [[noreturn]] void fail_at(const Face& face, std::size_t which) const {
        Statements again(text_);
        Statement s;
        while (again.next(s) && s.line != face.line) {
        }
        Words words(s.rest, s.column);
        for (std::size_t i = 0; i <= which; ++i)
            words.next();
        fail(names(0, corners_[face.begin + which].vertex + 1L), face.line, words.column());
    }

    void cut() {
        for (const Begun& shape : shapes_)
            model_.shapes.push_back({shape.name, shape.line, {}, {}, {}});
        std::vector<Vec3> points;
        std::vector<std::uint32_t> triangles;
        for (const Face& face : faces_) {
            points.clear(), triangles.clear();
            for (std::size_t i = face.begin; i < face.end; ++i) {
                Corner& c = corners_[i];
                if (c.vertex >= count(0)) fail_at(face, i - face.begin);
                now_.line = face.line;
                if (c.coordinate >= count(1)) absent(names(1, c.coordinate + 1L)), c.coordinate = -1;
                if (c.normal >= count(2)) absent(names(2, c.normal + 1L)), c.normal = -1;
                const double* p = &positions_[3 * static_cast<std::size_t>(c.vertex)];
                points.push_back({p[0], p[1], p[2]});
            }
            if (cut_polygon(points, triangles) > 1e-3) model_.has_bent_polygons = true;
            Shape& shape = model_.shapes[face.shape];
            for (const std::uint32_t i : triangles)
                shape.corners.push_back(corners_[face.begin + i]);
            shape.materials.insert(shape.materials.end(), triangles.size() / 3, face.material);
            shape.smoothing.insert(shape.smoothing.end(), triangles.size() / 3, face.smoothing);
        }
    }

    std::string_view text_;
    const std::function<bool(double)>& goes_on_;
    Statements statements_;
    Statement now_;
    Model model_;
    std::vector<double> positions_;
    std::vector<Corner> corners_;
    std::vector<Face> faces_;
    std::vector<Begun> shapes_; // with faces
    Begun shape_;
    std::unordered_map<std::string, int> material_ids_;
    int material_ = -1;
    std::uint32_t smoothing_ = 0;
    bool any_color_ = false;
};

} // namespace

Model read_model(std::string_view text, const std::function<bool(double)>& goes_on) {
    return Reader(text, goes_on).read();
}

} // namespace restage::obj
