// @LABEL@: stripes, to begin with. <restage/texture.h> states the requirements; `restage check` tests them.
Spectrum @NAME@_texture(@NAME@_Params m, TextureSite at) { return fract(at.uv.x) < m.share ? m.one : m.other; }
