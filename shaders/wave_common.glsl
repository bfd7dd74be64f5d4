// SPDX-License-Identifier: Apache-2.0
// What the wavefront kernels share: path state in arrays behind the frame's addresses.
#ifndef RESTAGE_WAVE_COMMON
#define RESTAGE_WAVE_COMMON
#include "lib/scene.glsl"
#include "shared/path_data.h"

layout(local_size_x = 64) in;

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer RayArray { RayHit at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ShadowArray { ShadowRay at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer PathArray { PathState at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer GuideArray { GuideSample at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FilmArray { FilmPixel at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer GuidePixelArray { GuidePixel at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CounterArray { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FrameRef { FrameData frame; };

layout(push_constant, scalar) uniform Push { WavePush push; };

const float INFINITE = 1e30;

#endif
