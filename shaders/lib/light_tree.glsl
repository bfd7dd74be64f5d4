// SPDX-License-Identifier: Apache-2.0
// Which emitter: from the root of a tree down, a child is chosen by a bound on what it sends to the point. Few emitters
// are all children of the root. Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting", without the splitting.
#ifndef RESTAGE_LIB_LIGHT_TREE
#define RESTAGE_LIB_LIGHT_TREE
#include "lib/sampler.glsl"
#include "lib/scene.glsl"

// Irradiance at p from `node`, roughly: above 0 wherever it is. By the largest cosine between a normal of the emitter
// and a direction towards p that the bounds allow.
float light_importance(LightNode node, vec3 p) {
    if (node.radius < 0.0) return node.intensity;
    vec3 d = p - node.center;
    float d2 = dot(d, d), r2 = node.radius * node.radius;
    float importance = node.intensity / max(d2, max(r2, 1e-30));
    if (node.cos_reach < 0.0 || d2 <= r2) return importance;
    float c = dot(node.axis, d) * inversesqrt(d2);
    if ((node.flags & LIGHT_TWO_SIDED) != 0u) c = abs(c);
    float s = sqrt(max(0.0, 1.0 - c * c));
    // minus the angle of the normals, then the angle of the sphere as seen from p: cosines of differences, 1 below 0
    float cos_a = node.cos_spread, sin_a = sqrt(max(0.0, 1.0 - cos_a * cos_a));
    bool inside = c >= cos_a;
    float c1 = inside ? 1.0 : c * cos_a + s * sin_a;
    float s1 = inside ? 0.0 : max(0.0, s * cos_a - c * sin_a);
    float sin_b2 = min(r2 / d2, 1.0), cos_b = sqrt(1.0 - sin_b2);
    float c2 = c1 >= cos_b ? 1.0 : c1 * cos_b + s1 * sqrt(sin_b2);
    return c2 < node.cos_reach - 1e-3 ? 0.0 : importance * max(c2, 1e-3);
}

// 32 bits choose an emitter for p: its node, and the probability of that; 0 = none sends light there. The first bits
// make the choices near the root, whose stratification matters most; further down are hashes of them.
uint light_choose(SceneData scene, vec3 p, uint bits, out float pmf) {
    LightNodeArray nodes = LightNodeArray(scene.light_nodes);
    uint first = 0u, count = scene.light_roots;
    float u = to_unit(bits);
    pmf = 1.0;
    for (uint level = 0u;; ++level) {
        uint chosen = first;
        if (count > 1u) {
            if (level > 1u) u = to_unit(pcg_hash(bits + level));
            float sum = 0.0, its = 0.0;
            for (uint k = 0u; k < count; ++k) { // u is kept uniform within what has been chosen so far
                float w = light_importance(nodes.at[first + k], p);
                if (!(w > 0.0)) continue;
                sum += w;
                float q = w / sum;
                if (u < q) {
                    chosen = first + k;
                    its = w;
                    u = u / q;
                } else {
                    u = (u - q) / (1.0 - q);
                }
                u = min(u, 0.99999994);
            }
            if (!(its > 0.0)) {
                pmf = 0.0;
                return chosen;
            }
            pmf *= its / sum;
        }
        if (nodes.at[chosen].count == 0u) return chosen;
        first = nodes.at[chosen].first;
        count = nodes.at[chosen].count;
    }
}

// The probability with which light_choose finds this emitter.
float light_choice_pmf(SceneData scene, vec3 p, uint emitter) {
    LightNodeArray nodes = LightNodeArray(scene.light_nodes);
    float pmf = 1.0;
    for (uint at = emitter;;) {
        uint parent = nodes.at[at].parent;
        uint first = parent == NONE ? 0u : nodes.at[parent].first;
        uint count = parent == NONE ? scene.light_roots : nodes.at[parent].count;
        if (count > 1u) {
            float sum = 0.0, its = 0.0;
            for (uint k = 0u; k < count; ++k) {
                float w = light_importance(nodes.at[first + k], p);
                sum += w;
                if (first + k == at) its = w;
            }
            if (!(its > 0.0)) return 0.0;
            pmf *= its / sum;
        }
        if (parent == NONE) return pmf;
        at = parent;
    }
}

#endif
