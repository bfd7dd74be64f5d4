// SPDX-License-Identifier: Apache-2.0
#include "render/texture_program.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace restage::render {
namespace {

using scene::Id;
using scene::Scene;
using scene::Texture;
using shared::TextureOp;

constexpr std::size_t stack_size = 3; // of shaders/lib/texture.glsl

class Compiler {
  public:
    explicit Compiler(const Scene& scene) : scene_(scene) {}

    // Appends the operations that push texture `id`; false when it needs more stack than there is.
    bool texture(Id<Texture> id, std::size_t height, int depth) {
        const Texture* t = scene_.textures.find(id);
        if (!t || depth > 16 || height >= stack_size) return false;
        if (t->type == "imagemap") return image(*t);
        if (t->type == "scale")
            return operand(*t, "tex", 1, height, depth) && operand(*t, "scale", 1, height + 1, depth) &&
                   combine(OP_MULTIPLY, *t);
        if (t->type == "mix")
            return operand(*t, "tex1", 0, height, depth) && operand(*t, "tex2", 1, height + 1, depth) &&
                   operand(*t, "amount", 0.5f, height + 2, depth) && combine(OP_MIX, *t);
        if (t->type == "checkerboard")
            return operand(*t, "tex1", 1, height, depth) && operand(*t, "tex2", 0, height + 1, depth) &&
                   combine(OP_CHECKER, *t);
        if (t->type == "constant") return operand(*t, "value", 1, height, depth);
        constant(t->params.color("average", {0.5f, 0.5f, 0.5f}));
        return true;
    }
    void constant(std::array<float, 3> c) {
        TextureOp op{};
        op.kind = OP_CONSTANT;
        op.value = {c[0], c[1], c[2], 1};
        ops.push_back(op);
    }

    std::vector<TextureOp> ops;

  private:
    static void set_mapping(const Texture& t, TextureOp& op) {
        op.uv = {t.params.number("uscale", 1), t.params.number("vscale", 1), t.params.number("udelta", 0),
                 t.params.number("vdelta", 0)};
        op.shear = {t.params.number("ushear", 0), t.params.number("vshear", 0)};
        op.set = t.params.number("uvset", 0) == 1 ? 1u : 0u;
    }
    bool image(const Texture& t) {
        const scene::Image* image = scene_.images.find(t.image);
        if (!image || !image->data) {
            const auto grey = t.params.color("average", {0.5f, 0.5f, 0.5f}); // reported by the importer
            constant({grey[0], grey[1], grey[2]});
            return true;
        }
        TextureOp op{};
        op.kind = OP_IMAGE;
        op.image = t.image.value;
        const auto wrap = t.params.choice("wrap", "repeat");
        op.wrap = wrap == "black" ? WRAP_BLACK : wrap == "clamp" ? WRAP_CLAMP : WRAP_REPEAT;
        op.invert = t.params.number("invert", 0) != 0 ? 1u : 0u;
        set_mapping(t, op);
        op.value = glm::vec4(t.params.number("scale", 1));
        ops.push_back(op);
        return true;
    }
    bool operand(const Texture& t, std::string_view id, float fallback, std::size_t height, int depth) {
        const scene::Value* v = t.params.find(id);
        if (v && v->texture) return texture(v->texture, height, depth + 1);
        if (height >= stack_size) return false;
        if (!v)
            constant({fallback, fallback, fallback});
        else if (v->type == model::ParamType::color)
            constant({v->v[0], v->v[1], v->v[2]});
        else
            constant({v->scalar(), v->scalar(), v->scalar()});
        return true;
    }
    bool combine(std::uint32_t kind, const Texture& t) {
        // image * constant folds into the image's factor: the common case costs one operation
        if (kind == OP_MULTIPLY && ops.size() >= 2 && ops.back().kind == OP_CONSTANT &&
            ops[ops.size() - 2].kind <= OP_IMAGE && !ops[ops.size() - 2].invert) { // which is applied after the factor
            ops[ops.size() - 2].value *= ops.back().value;
            ops.pop_back();
            return true;
        }
        TextureOp op{};
        op.kind = kind;
        set_mapping(t, op);
        ops.push_back(op);
        return true;
    }
    const Scene& scene_;
};

glm::vec3 texel(const scene::PixelData& image, glm::ivec2 p, std::uint32_t wrap) {
    const glm::ivec2 size(image.width, image.height);
    if (wrap == WRAP_REPEAT) {
        p.x = ((p.x % size.x) + size.x) % size.x;
        p.y = ((p.y % size.y) + size.y) % size.y;
    } else if (wrap == WRAP_BLACK && (p.x < 0 || p.y < 0 || p.x >= size.x || p.y >= size.y)) {
        return glm::vec3(0);
    }
    p = glm::clamp(p, glm::ivec2(0), size - 1);
    const float* v = &image.values[(std::size_t(p.y) * image.width + std::size_t(p.x)) * image.channels];
    return image.channels >= 3 ? glm::vec3(v[0], v[1], v[2]) : glm::vec3(v[0]);
}

glm::vec3 bilinear(const scene::PixelData& image, glm::vec2 st, std::uint32_t wrap) {
    const glm::vec2 x = glm::vec2(st.x, 1 - st.y) * glm::vec2(image.width, image.height) - 0.5f;
    const glm::vec2 base = glm::floor(x), d = x - base;
    const glm::ivec2 p(base);
    glm::vec3 sum(0);
    for (int k = 0; k < 4; ++k) {
        const glm::ivec2 o(k & 1, k >> 1);
        sum += (o.x ? d.x : 1 - d.x) * (o.y ? d.y : 1 - d.y) * texel(image, p + o, wrap);
    }
    return sum;
}

} // namespace

TexturePrograms compile_textures(const Scene& scene) {
    TexturePrograms out;
    out.programs.resize(scene.textures.size() + 1);
    scene.textures.each([&](Id<Texture> id, const Texture& texture) {
        Compiler compiler(scene);
        if (!compiler.texture(id, 0, 0)) {
            compiler.ops.clear();
            compiler.constant(texture.params.color("average", {0.5f, 0.5f, 0.5f}));
        }
        out.programs[id.value] = {std::uint32_t(out.ops.size()), std::uint32_t(compiler.ops.size())};
        out.ops.insert(out.ops.end(), compiler.ops.begin(), compiler.ops.end());
    });
    return out;
}

glm::vec3 evaluate_texture(const TexturePrograms& textures, const std::vector<CpuImage>& images, std::uint32_t texture,
                           glm::vec4 uv) {
    glm::vec3 a(0), b(0), c(0);
    const auto program = textures.programs[texture];
    for (std::uint32_t i = 0; i < program.count; ++i) {
        const TextureOp& op = textures.ops[program.first + i];
        const glm::vec2 at = op.set ? glm::vec2(uv.z, uv.w) : glm::vec2(uv);
        const glm::vec2 st = at * glm::vec2(op.uv) + glm::vec2(at.y, at.x) * op.shear + glm::vec2(op.uv.z, op.uv.w);
        if (op.kind <= OP_IMAGE) {
            c = b;
            b = a;
            a = glm::vec3(op.value);
            if (op.kind == OP_IMAGE) {
                glm::vec3 t = bilinear(*images[op.image].pixels, st, op.wrap);
                a *= t;
                if (op.invert) a = glm::max(glm::vec3(0), 1.f - a); // after the scale, as pbrt-v4
            }
        } else if (op.kind == OP_MULTIPLY) {
            a *= b;
            b = c;
        } else if (op.kind == OP_MIX) {
            a = glm::mix(c, b, a.x);
        } else {
            const float parity = std::floor(st.x) + std::floor(st.y);
            a = parity - 2 * std::floor(parity / 2) < 0.5f ? b : a;
            b = c;
        }
    }
    return a;
}

} // namespace restage::render
