// SPDX-License-Identifier: Apache-2.0
// Frame: an orthonormal basis; BSDFs live in its local coordinates (n = +z).
#ifndef RESTAGE_V1_FRAME
#define RESTAGE_V1_FRAME

struct Frame {
    vec3 t, b, n;
};

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3: no singularity, no branch.
Frame frame_from_normal(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return Frame(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

vec3 to_local(Frame f, vec3 v) { return vec3(dot(v, f.t), dot(v, f.b), dot(v, f.n)); }
vec3 to_world(Frame f, vec3 v) { return f.t * v.x + f.b * v.y + f.n * v.z; }

#endif
