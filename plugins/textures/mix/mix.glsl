// SPDX-License-Identifier: Apache-2.0
Spectrum blend_texture(blend_Params m, TextureSite at) { return mix(m.tex1, m.tex2, m.amount); }
