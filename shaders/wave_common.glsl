// SPDX-License-Identifier: Apache-2.0
// What the wavefront kernels share: path state in arrays behind the frame's addresses.
#ifndef RESTAGE_WAVE_COMMON
#define RESTAGE_WAVE_COMMON
#include "path/film.glsl"

layout(local_size_x = 64) in;

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer RayArray { RayHit at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ShadowArray { ShadowRay at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer PathArray { PathState at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer GuideArray { GuideSample at[]; };

layout(push_constant, scalar) uniform Push { WavePush push; };

#endif
