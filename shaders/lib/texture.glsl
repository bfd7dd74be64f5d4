// SPDX-License-Identifier: Apache-2.0
// Textures: a postfix program over uv, images filtered bilinearly as pbrt does without mip levels (pbrt 4ed, 10.4).
// Texels live in buffers, linear: the same result on every device, and no descriptor anywhere.
// render/texture_program.cpp is the same in C++, for cut-outs and mixes that the CPU resolves.
#ifndef RESTAGE_LIB_TEXTURE
#define RESTAGE_LIB_TEXTURE
#include "lib/scene.glsl"

vec4 texel(ImageData image, ivec2 p, uint wrap) {
    ivec2 size = ivec2(image.width, image.height);
    if (wrap == WRAP_REPEAT) {
        p -= ivec2(floor(vec2(p) / vec2(size))) * size;
    } else if (wrap == WRAP_BLACK && (any(lessThan(p, ivec2(0))) || any(greaterThanEqual(p, size)))) {
        return vec4(0);
    }
    p = clamp(p, ivec2(0), size - 1);
    uint i = uint(p.y) * image.width + uint(p.x);
    if (image.format == TEXEL_HALF4) {
        uvec2 h = Uvec2Array(image.texels).at[i];
        return vec4(unpackHalf2x16(h.x), unpackHalf2x16(h.y));
    }
    return Vec4Array(image.texels).at[i];
}

// st: s to the right, t *upwards* (pbrt): row 0 of the image is at t = 1.
vec4 image_bilinear(ImageData image, vec2 st, uint wrap) {
    vec2 x = vec2(st.x, 1.0 - st.y) * vec2(image.width, image.height) - 0.5;
    vec2 base = floor(x);
    vec2 d = x - base;
    ivec2 p = ivec2(base);
    vec4 sum = vec4(0);
    for (int k = 0; k < 4; ++k) {
        ivec2 o = ivec2(k & 1, k >> 1);
        vec2 w = mix(1.0 - d, d, vec2(o));
        sum += w.x * w.y * texel(image, p + o, wrap);
    }
    return sum;
}

// uv: of the first and of the second set.
vec3 texture_eval(SceneData scene, uint texture_id, vec4 uv) {
    TextureProgram program = TextureArray(scene.textures).at[texture_id];
    vec3 a = vec3(0), b = vec3(0), c = vec3(0); // the stack, top first
    for (uint i = 0; i < program.count; ++i) {
        TextureOp op = TextureOpArray(scene.texture_ops).at[program.first + i];
        vec2 at = op.set != 0u ? uv.zw : uv.xy;
        vec2 st = at * op.uv.xy + at.yx * op.shear + op.uv.zw;
        if (op.kind <= OP_IMAGE) {
            c = b;
            b = a;
            if (op.kind == OP_CONSTANT) {
                a = op.value.xyz;
            } else {
                ImageData image = ImageArray(scene.images).at[op.image];
                a = image_bilinear(image, st, op.wrap).xyz;
                a *= op.value.xyz;
                if (op.invert != 0u) a = max(vec3(0), 1.0 - a); // after the scale, as pbrt-v4
            }
        } else if (op.kind == OP_MULTIPLY) {
            a *= b;
            b = c;
        } else if (op.kind == OP_MIX) {
            a = mix(c, b, a.x);
        } else { // OP_CHECKER
            st = floor(st);
            a = mod(st.x + st.y, 2.0) < 0.5 ? b : a;
            b = c;
        }
    }
    return a;
}
vec3 texture_eval(SceneData scene, uint texture_id, vec2 uv) { return texture_eval(scene, texture_id, uv.xyxy); }

// The share of rays that a point of a surface stops.
float hit_alpha(SceneData scene, InstanceData inst, uint prim, vec2 bary) {
    float alpha = inst.alpha;
    if (inst.alpha_texture != 0u) alpha = texture_eval(scene, inst.alpha_texture, hit_uv(inst, prim, bary)).x;
    if ((inst.flags & INSTANCE_ALPHA_MASK) != 0u) return alpha > 0.0 ? 1.0 : 0.0; // as pbrt-v3, in Triangle::Intersect
    return clamp(alpha, 0.0, 1.0);
}

#endif
