// SPDX-License-Identifier: Apache-2.0
// A point that receives light.
#ifndef RESTAGE_LIB_RECEIVER
#define RESTAGE_LIB_RECEIVER

// Eight bits a component are enough for its normal, but who asks for the probability of a choice must use the same bits:
// they travel with the ray.
struct Receiver {
    vec3 p;
    vec3 n; // about unit, of either side; 0: there is none
};
// Path guiding, too, learns from it: there it is on the side that the path came from.
uint receiver_bits(vec3 n) { return packSnorm4x8(vec4(n, 0.0)); }
Receiver receiver_at(vec3 p, uint bits) { return Receiver(p, unpackSnorm4x8(bits).xyz); }

// Directions get weights of the cosine to its normal, or this. It may receive from both sides, and its material may use
// other normals. pbrt 4ed, 6.5.4
const float RECEIVED_LEAST = 0.01;

#endif
