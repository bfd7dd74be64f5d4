// @LABEL@: stripes, to begin with. What the function must fulfil is said in <restage/texture.h>; `restage check` tests it.
Spectrum @NAME@_texture(@NAME@_Params m, TextureSite at) { return fract(at.uv.x) < m.share ? m.one : m.other; }
