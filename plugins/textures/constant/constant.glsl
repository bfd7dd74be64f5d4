// SPDX-License-Identifier: Apache-2.0
Spectrum constant_texture(constant_Params m, TextureSite at) { return m.value; }
