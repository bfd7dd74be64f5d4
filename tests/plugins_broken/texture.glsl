// SPDX-License-Identifier: Apache-2.0
// Stripes, correct by themselves; a macro broken_* makes them wrong in one way.
Spectrum broken_texture(broken_Params m, TextureSite at) {
    float x = (m.along ? at.uv.y : at.uv.x) * float(m.turns);
#if defined(broken_idle)
    float part = 0.5;
#else
    float part = m.part;
#endif
#if defined(broken_nan_beyond_half)
    if (part > 0.5) return m.one * sqrt(0.5 - part);
#elif defined(broken_inf_at_zero)
    if (at.uv.y == 0.0) return m.one / at.uv.y + 1.0 / at.uv.y;
#endif
    return fract(x) < part ? m.one : m.other;
}
