/* SPDX-License-Identifier: Apache-2.0 */
/* Reads a .binary file of the MERL BRDF database (Matusik et al. 2003) into the words that measured.glsl looks up:
 *
 *   0          counts of theta_h, theta_d, phi_d, and of rows
 *   4          rows, one per interval of the angle of wo, equal in [0, 90 degrees]:
 *                albedo (red, green, blue), fraction of samples drawn from the half vector,
 *                for each bin of theta_h the probability of this or an earlier one,
 *                at each edge of a bin the density of half vectors [1/sr], linear in 1 - cos(theta_h) between
 *   then       BRDF [1/sr]: red, green, blue of each entry, -1 where it was not measured; phi_d fastest, theta_h
 * slowest */
#ifndef RESTAGE_MERL_H
#define RESTAGE_MERL_H

#include <restage/table.h>

int merl_read(const char* param_id, const RestageTableFile1* file);

#endif
