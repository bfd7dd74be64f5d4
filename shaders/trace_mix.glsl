// SPDX-License-Identifier: Apache-2.0
// Ray-tracing pipeline: shared by the stages that resolve mixes.
#ifndef RESTAGE_TRACE_MIX
#define RESTAGE_TRACE_MIX
#include "lib/mix.glsl"
#include "trace_common.glsl"
#endif
