// SPDX-License-Identifier: Apache-2.0
#include "render/texture_program.hpp"

#include "render/material_types.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace restage::render {
namespace {

using scene::Id;
using scene::Scene;
using scene::Texture;

constexpr std::size_t stack_size = 4; // of shaders/lib/texture.glsl
constexpr int deepest_graph = 16;

std::uint32_t bits(float v) { return std::bit_cast<std::uint32_t>(v); }

class Compiler {
  public:
    Compiler(const Scene& scene, TextureTypes& types, const TextureLookup& lookup, TexturePrograms& out)
        : scene_(scene), types_(types), lookup_(lookup), out_(out) {}

    void compile(Id<Texture> id) {
        const auto average = scene_.textures[id].params.color("average", {0.5f, 0.5f, 0.5f});
        const auto words = out_.words.size(), ops = out_.ops.size();
        count_ = 0;
        native_ = true;
        if (!texture(id, 0, 0, false)) {
            out_.words.resize(words);
            out_.ops.resize(ops);
            count_ = 0;
            native_ = true;
            literal(average);
        }
        out_.programs[id.value] = {std::uint32_t(words), count_};
        out_.native[id.value] = {std::uint32_t(ops), count_, native_, {average[0], average[1], average[2]}};
    }

  private:
    // Appends the operations that push texture `id`; false if they need too much stack. `data`: it feeds a number.
    bool texture(Id<Texture> id, std::size_t height, int depth, bool data) {
        const Texture* t = scene_.textures.find(id);
        if (!t || depth > deepest_graph || height >= stack_size) return false;
        const std::optional<std::size_t> type = type_of(t->type);
        const model::Texture* table = type ? types_[*type].plugin.table : nullptr;
        const scene::Image* image = scene_.images.find(t->image);
        if (!table || (table->image && (!image || !image->data))) { // reported by the importer
            literal(t->params.color("average", {0.5f, 0.5f, 0.5f}));
            return true;
        }
        std::uint32_t operands = 0, bit = TEXTURE_OP_FIRST_OPERAND;
        std::size_t pushed = 0;
        for (const model::Param& line : table->params) {
            if (!line.texturable) continue;
            if (const Id<Texture> operand = t->params.texture(line.id)) {
                const bool number = data || line.type == model::ParamType::number;
                if (!texture(operand, height + pushed++, depth + 1, number)) return false;
                operands |= bit;
            }
            bit <<= 1;
        }
        operation(*t, *type, operands, data);
        return true;
    }
    std::optional<std::size_t> type_of(const std::string& name) {
        for (std::size_t i = 0; i < types_.size(); ++i)
            if (types_[i].type == name) return i;
        if (types_.size() >= most_texture_types || name.empty()) return std::nullopt;
        types_.push_back({name, lookup_ ? lookup_(name).value_or(TexturePlugin{}) : TexturePlugin{}});
        return types_.size() - 1;
    }
    void literal(std::array<float, 3> c) {
        out_.words.insert(out_.words.end(), {TEXTURE_LITERAL, bits(c[0]), bits(c[1]), bits(c[2])});
        NativeOp op;
        op.literal = {c[0], c[1], c[2]};
        out_.ops.push_back(op);
        ++count_;
    }
    void operation(const Texture& t, std::size_t type, std::uint32_t operands, bool data) {
        const TexturePlugin& plugin = types_[type].plugin;
        const model::Texture& table = *plugin.table;
        NativeOp op{.source = plugin.source.get(),
                    .operands = operands / TEXTURE_OP_FIRST_OPERAND,
                    .values = std::uint32_t(out_.values.size()),
                    .whole = std::uint32_t(out_.whole.size())};
        std::uint32_t head = std::uint32_t(type + 1) | operands;
        if (data) head |= TEXTURE_OP_DATA;
        const auto number = [&](const char* id, float otherwise) { return t.params.number(id, otherwise); };
        if (table.mapped) {
            op.second_uv = number("uvset", 0) == 1;
            op.map = {number("uscale", 1), number("vscale", 1), number("udelta", 0), number("vdelta", 0)};
            op.shear = {number("ushear", 0), number("vshear", 0)};
        }
        if (op.second_uv) head |= TEXTURE_OP_SECOND_UV;
        auto& words = out_.words;
        words.push_back(head);
        words.push_back(texture_words(table));
        if (table.mapped)
            for (const float v : {op.map.x, op.map.y, op.map.z, op.map.w, op.shear.x, op.shear.y})
                words.push_back(bits(v));
        if (table.image) words.push_back(op.image = t.image.value);
        for (const model::Param& line : table.params) {
            const std::size_t first = words.size();
            pack_value(line, t.params, words);
            const std::size_t n = words.size() - first;
            const bool real = line.type == model::ParamType::number || line.type == model::ParamType::color;
            for (std::size_t k = 0; k < 4; ++k)
                out_.values.push_back(real && k < n ? std::bit_cast<float>(words[first + k]) : 0.f);
            out_.whole.push_back(!real && n > 0 ? std::int32_t(words[first]) : 0);
        }
        native_ &= plugin.native();
        out_.ops.push_back(op);
        ++count_;
    }

    const Scene& scene_;
    TextureTypes& types_;
    const TextureLookup& lookup_;
    TexturePrograms& out_;
    std::uint32_t count_ = 0; // operations of the current program
    bool native_ = true;
};

glm::vec4 texel(const scene::PixelData& image, glm::ivec2 p, int wrap) {
    const glm::ivec2 size(image.width, image.height);
    if (wrap == int(WRAP_REPEAT)) {
        p.x = ((p.x % size.x) + size.x) % size.x;
        p.y = ((p.y % size.y) + size.y) % size.y;
    } else if (wrap == int(WRAP_BLACK) && (p.x < 0 || p.y < 0 || p.x >= size.x || p.y >= size.y)) {
        return glm::vec4(0);
    }
    p = glm::clamp(p, glm::ivec2(0), size - 1);
    const float* v = &image.values[(std::size_t(p.y) * image.width + std::size_t(p.x)) * image.channels];
    switch (image.channels) {
        case 1:
            return {v[0], v[0], v[0], 1};
        case 3:
            return {v[0], v[1], v[2], 1};
        default:
            return {v[0], v[1], v[2], v[3]};
    }
}

glm::vec4 bilinear(const scene::PixelData& image, glm::vec2 st, int wrap) {
    const glm::vec2 x = glm::vec2(st.x, 1 - st.y) * glm::vec2(image.width, image.height) - 0.5f;
    const glm::vec2 base = glm::floor(x), d = x - base;
    const glm::ivec2 p(base);
    glm::vec4 sum(0);
    for (int k = 0; k < 4; ++k) {
        const glm::ivec2 o(k & 1, k >> 1);
        sum += (o.x ? d.x : 1 - d.x) * (o.y ? d.y : 1 - d.y) * texel(image, p + o, wrap);
    }
    return sum;
}

void look_up(const void* image, float s, float t, int wrap, float* rgba) {
    const glm::vec4 v = bilinear(*static_cast<const scene::PixelData*>(image), {s, t}, wrap);
    std::copy_n(&v.x, 4, rgba);
}

} // namespace

TexturePrograms compile_textures(const Scene& scene, TextureTypes& types, const TextureLookup& lookup) {
    TexturePrograms out;
    out.programs.resize(scene.textures.size() + 1);
    out.native.resize(scene.textures.size() + 1);
    Compiler compiler(scene, types, lookup, out);
    scene.textures.each([&](Id<Texture> id, const Texture&) { compiler.compile(id); });
    return out;
}

glm::vec3 evaluate_texture(const TexturePrograms& textures, const std::vector<CpuImage>& images, std::uint32_t texture,
                           glm::vec4 uv) {
    const TexturePrograms::Native& program = textures.native[texture];
    if (!program.there) return program.average;
    std::array<glm::vec3, stack_size> stack{};
    std::size_t height = 0;
    for (std::uint32_t i = 0; i < program.count; ++i) {
        const NativeOp& op = textures.ops[program.first + i];
        if (!op.source) {
            stack[height++] = op.literal;
            continue;
        }
        const auto& lines = op.source->texture().params;
        const glm::vec2 at = op.second_uv ? glm::vec2(uv.z, uv.w) : glm::vec2(uv);
        const glm::vec2 st = at * glm::vec2(op.map) + glm::vec2(at.y, at.x) * op.shear + glm::vec2(op.map.z, op.map.w);
        plugin::TextureCall call{.uv = {st.x, st.y}};
        if (!lines.empty()) {
            call.values = &textures.values[op.values];
            call.whole = &textures.whole[op.whole];
        }
        if (op.image) {
            call.image = images[op.image].pixels;
            call.look_up = look_up;
        }
        std::array<float, 64> some;
        std::vector<float> many;
        if (op.operands) { // the last is on top
            float* values = some.data();
            if (lines.size() * 4 > some.size()) {
                many.resize(lines.size() * 4);
                values = many.data();
            }
            std::copy_n(call.values, lines.size() * 4, values);
            height -= std::size_t(std::popcount(op.operands));
            std::size_t next = height;
            std::uint32_t left = op.operands;
            for (std::size_t k = 0; k < lines.size() && left; ++k) {
                if (!lines[k].texturable) continue;
                if (left & 1u) std::copy_n(&stack[next++].x, 3, values + 4 * k);
                left >>= 1;
            }
            call.values = values;
        }
        op.source->evaluate(call, &stack[height++].x);
    }
    return stack[0];
}

} // namespace restage::render
