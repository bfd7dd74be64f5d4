// SPDX-License-Identifier: Apache-2.0
// The material of a hit, through mixes: a stochastic choice, exact in expectation, identical to
// GpuScene::resolve_material.
#ifndef RESTAGE_LIB_MIX
#define RESTAGE_LIB_MIX
#include "lib/texture.glsl"
#include "shared/hash.h"

layout(constant_id = 9) const bool HAS_MIX = true; // some material is a mix

// MaterialData index, or MATERIAL_NOTHING.
uint resolve_material(SceneData scene, InstanceData inst, uint prim, vec2 bary) {
    MaterialArray materials = MaterialArray(scene.materials);
    uint m = inst.material;
    if (!HAS_MIX || (materials.at[m].flags & MATERIAL_MIX) == 0u) return m;
    vec4 uv = hit_uv(inst, prim, bary);
    UintArray words = UintArray(scene.params);
    for (uint depth = 0u; depth < 8u; ++depth) {
        MaterialData data = materials.at[m];
        if ((data.flags & MATERIAL_MIX) == 0u) return m;
        float amount = uintBitsToFloat(words.at[data.params]);
        uint texture_id = words.at[data.params + 1u];
        if (texture_id != 0u) amount = texture_number(scene, texture_id, texture_at(scene, inst, prim, bary, uv));
        m = mix_choice(bary, prim, depth) < amount ? data.mix_second : data.mix_first;
        if (m == MATERIAL_NOTHING) return m;
    }
    return (materials.at[m].flags & MATERIAL_MIX) == 0u ? m : 0u; // deeper than 8: the placeholder
}

#endif
