// SPDX-License-Identifier: Apache-2.0
// Ray-tracing pipeline: nothing was hit; for a shadow ray, the light is visible.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "lib/extensions.glsl"
#include "trace_common.glsl"

layout(location = 0) rayPayloadInEXT HitPayload hit;

void main() { hit.t = -1.0; }
