// SPDX-License-Identifier: Apache-2.0
// Which emitter: from the root of a tree down, a child is chosen by a bound on what it sends to the point. Few emitters
// are all children of the root. Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting", without the splitting.
#ifndef RESTAGE_LIB_LIGHT_TREE
#define RESTAGE_LIB_LIGHT_TREE
#include <restage/v1/numbers.glsl>
#include "lib/receiver.glsl"
#include "lib/sampler.glsl"
#include "lib/scene.glsl"

// The part of what arrives from the side of a surface that its material may still use: hair does, and a bumpy one.
const float RECEIVED_ASIDE = 0.2;

// Irradiance at a point from `node`, roughly: above 0 wherever it is. By the largest cosines that the bounds allow, of a
// normal of the emitter and of the receiver's. The latter may receive from both sides.
float light_importance(LightNode node, Receiver to) {
    if (node.radius < 0.0) return node.intensity;
    vec3 d = to.p - node.center;
    float d2 = dot(d, d), r2 = node.radius * node.radius;
    float importance = node.intensity / max(d2, max(r2, 1e-30));
    if (d2 <= r2) return importance;
    float inverse = inversesqrt(d2);
    // the angle of the sphere as seen from p
    float sin_b2 = min(r2 / d2, 1.0), sin_b = sqrt(sin_b2), cos_b = sqrt(1.0 - sin_b2);
    float received = min(abs(dot(to.n, d)) * inverse, 1.0);
    received = received >= cos_b ? 1.0 : received * cos_b + sqrt(1.0 - received * received) * sin_b;
    importance *= max(received, RECEIVED_ASIDE);
    if (node.cos_reach < 0.0) return importance;
    float c = dot(node.axis, d) * inverse;
    if ((node.flags & LIGHT_TWO_SIDED) != 0u) c = abs(c);
    float s = sqrt(max(0.0, 1.0 - c * c));
    // minus the angle of the normals, then that of the sphere: cosines of differences, 1 below 0
    float cos_a = node.cos_spread, sin_a = sqrt(max(0.0, 1.0 - cos_a * cos_a));
    bool inside = c >= cos_a;
    float c1 = inside ? 1.0 : c * cos_a + s * sin_a;
    float s1 = inside ? 0.0 : max(0.0, s * cos_a - c * sin_a);
    float c2 = c1 >= cos_b ? 1.0 : c1 * cos_b + s1 * sin_b;
    return c2 < node.cos_reach - 1e-3 ? 0.0 : importance * max(c2, 1e-3);
}

// The root's children: their number is a constant, so that lavapipe loads them once for all lanes.
struct LightRoots {
    float importance[8];
    float sum;
};
LightRoots light_roots(LightNodeArray nodes, Receiver to) {
    LightRoots r;
    r.sum = 0.0;
    for (uint k = 0u; k < 8u; ++k) {
        r.importance[k] = 0.0;
        if (k < LIGHT_ROOTS) r.importance[k] = light_importance(nodes.at[k], to);
        r.sum += r.importance[k];
    }
    return r;
}

// 32 bits choose an emitter for a point: its node, and the probability of that; 0 = none sends light there. The first bits
// make the choices near the root, whose stratification matters most; further down are hashes of them.
uint light_choose(SceneData scene, Receiver to, uint bits, out float pmf) {
    LightNodeArray nodes = LightNodeArray(scene.light_nodes);
    pmf = 1.0;
    if (LIGHT_ROOTS == 1u) return 0u;
    LightRoots roots = light_roots(nodes, to);
    float x = to_unit(bits) * roots.sum, below = 0.0, start = 0.0, its = 0.0;
    uint chosen = 0u;
    for (uint k = 0u; k < 8u; ++k) {
        if (roots.importance[k] > 0.0 && x >= below) {
            chosen = k;
            start = below;
            its = roots.importance[k];
        }
        below += roots.importance[k];
    }
    pmf = its > 0.0 ? its / roots.sum : 0.0;
    if (LIGHT_ROOTS <= 8u) return chosen;
    float u = its > 0.0 ? clamp((x - start) / its, 0.0, 0.99999994) : 0.0;
    for (uint level = 1u; nodes.at[chosen].count != 0u && pmf > 0.0; ++level) {
        uint first = nodes.at[chosen].first, count = nodes.at[chosen].count;
        if (level > 1u) u = to_unit(pcg_hash(bits + level));
        float sum = 0.0;
        its = 0.0;
        for (uint k = 0u; k < count; ++k) { // u is kept uniform within what has been chosen so far
            float w = light_importance(nodes.at[first + k], to);
            if (!positive(w)) continue;
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
        pmf *= its > 0.0 ? its / sum : 0.0;
    }
    return chosen;
}

// The probability with which light_choose finds this emitter.
float light_choice_pmf(SceneData scene, Receiver to, uint emitter) {
    LightNodeArray nodes = LightNodeArray(scene.light_nodes);
    if (LIGHT_ROOTS == 1u) return 1.0;
    LightRoots roots = light_roots(nodes, to);
    float pmf = 1.0;
    uint at = emitter;
    if (LIGHT_ROOTS > 8u) {
        for (uint parent = nodes.at[at].parent; parent != NONE; parent = nodes.at[at].parent) {
            uint first = nodes.at[parent].first, count = nodes.at[parent].count;
            float sum = 0.0, its = 0.0;
            for (uint k = 0u; k < count; ++k) {
                float w = light_importance(nodes.at[first + k], to);
                sum += w;
                if (first + k == at) its = w;
            }
            pmf *= its > 0.0 ? its / sum : 0.0;
            at = parent;
        }
    }
    float its = 0.0;
    for (uint k = 0u; k < 8u; ++k)
        if (k == at) its = roots.importance[k];
    return its > 0.0 ? pmf * its / roots.sum : 0.0;
}

#endif
