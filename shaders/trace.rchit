// SPDX-License-Identifier: Apache-2.0
// Ray-tracing pipeline: only reports the hit; callables do the shading.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "lib/extensions.glsl"
#include "trace_common.glsl"

layout(location = 0) rayPayloadInEXT HitPayload hit;
hitAttributeEXT vec2 bary;

void main() { hit = HitPayload(gl_HitTEXT, gl_InstanceCustomIndexEXT, gl_PrimitiveID, bary); }
