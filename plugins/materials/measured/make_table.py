#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes glossy_paint.binary, the default of the measured material: computed, not measured.

    python3 make_table.py [FILE] [COUNT_H COUNT_D COUNT_PHI]

A red paint under varnish: GGX microfacets of a dielectric over a diffuse base that gets what they do not reflect
(README.md has the formulas), at the centres of the cells of a MERL table."""

import sys
from pathlib import Path

import numpy as np

ALPHA, ETA, GROUND = 0.12, 1.5, np.array([0.42, 0.045, 0.03])
SCALE = np.array([1 / 1500, 1.15 / 1500, 1.66 / 1500])  # the factors of MERL's reader


def fresnel(c):  # dielectric, unpolarised
    t = np.sqrt(1 - (1 - c * c) / ETA**2)
    return (((ETA * c - t) / (ETA * c + t)) ** 2 + ((c - ETA * t) / (c + ETA * t)) ** 2) / 2


def directions(theta_h, theta_d, phi_d):
    """wi and wo about a half vector in the x-z plane, Rusinkiewicz 1998."""
    s = np.sin(theta_d)
    d = np.stack([s * np.cos(phi_d), s * np.sin(phi_d), np.cos(theta_d)], -1)
    o = d * [-1, -1, 1]
    c, s = np.cos(theta_h), np.sin(theta_h)

    def turn(v):
        return np.stack([c * v[..., 0] + s * v[..., 2], v[..., 1], -s * v[..., 0] + c * v[..., 2]], -1)

    return turn(d), turn(o)


def brdf(theta_h, theta_d, phi_d):
    wi, wo = directions(theta_h, theta_d, phi_d)
    zi, zo = wi[..., 2], wo[..., 2]
    above = (zi > 0) & (zo > 0)
    zi, zo = np.where(above, zi, 1), np.where(above, zo, 1)

    def shadow(z):  # Smith's Lambda for GGX
        return (-1 + np.sqrt(1 + ALPHA**2 * (1 / (z * z) - 1))) / 2

    h = np.cos(theta_h)
    d = ALPHA**2 / (np.pi * (h * h * (ALPHA**2 - 1) + 1) ** 2)
    coat = fresnel(np.cos(theta_d)) * d / (1 + shadow(zi) + shadow(zo)) / (4 * zi * zo)
    ground = GROUND / np.pi * ((1 - fresnel(zi)) * (1 - fresnel(zo)))[..., None]
    return np.where(above[..., None], coat[..., None] + ground, -1)  # -1: below the horizon, as in MERL


def main():
    file = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("glossy_paint.binary")
    n = [int(x) for x in sys.argv[2:5]] or [24, 16, 24]
    h, d, p = np.meshgrid(*[(np.arange(k) + 0.5) / k for k in n], indexing="ij")
    f = brdf(np.pi / 2 * h**2, np.pi / 2 * d, np.pi * p)
    planes = np.moveaxis(np.where(f < 0, f, f / SCALE), -1, 0)
    file.write_bytes(np.array(n, "<i4").tobytes() + np.ascontiguousarray(planes, "<f8").tobytes())


if __name__ == "__main__":
    main()
