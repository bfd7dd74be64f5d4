// SPDX-License-Identifier: Apache-2.0
Spectrum scaling_texture(scaling_Params m, TextureSite at) { return m.tex * m.scale; }
