// SPDX-License-Identifier: Apache-2.0
// Wavefront: decides hits that the CPU tracer cannot, because a texture has no native code: whether the surface stops the
// ray, and which material of a mix it has. The random choices are the CPU's.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/mix.glsl"
#include "shared/wave_data.h"

layout(local_size_x = 64) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer AskedArray { HitAsked at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer DecidedArray { HitDecided at[]; };
layout(push_constant, scalar) uniform Push { DecidePush push; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    SceneData scene = SceneRef(push.scene).scene;
    HitAsked hit = AskedArray(push.asked).at[i];
    InstanceData inst = InstanceArray(scene.instances).at[hit.instance];
    DecidedArray(push.decided).at[i] =
        HitDecided(hit_alpha(scene, inst, hit.prim, hit.bary), resolve_material(scene, inst, hit.prim, hit.bary));
}
