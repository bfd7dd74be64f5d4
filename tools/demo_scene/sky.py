# SPDX-License-Identifier: Apache-2.0
"""A late-morning sky with hedges and hills below it, as an equal-area octahedral image (pbrt-v4's infinite light).

The mapping: Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", JGT 13(3), 2008; z is up.
"""

import numpy as np

from .images import mix, noise, smoothstep


def square_to_sphere(resolution):
    """Unit directions of the pixel centres of a square equal-area map, (resolution, resolution, 3)."""
    c = (np.arange(resolution) + 0.5) / resolution * 2 - 1
    v, u = np.meshgrid(c, c, indexing="ij")
    au, av = np.abs(u), np.abs(v)
    signed = 1 - (au + av)  # > 0 in the upper hemisphere's diamond
    r = 1 - np.abs(signed)
    phi = np.where(r > 0, (av - au) / np.maximum(r, 1e-12) + 1, 1) * np.pi / 4
    z = np.copysign(1 - r * r, signed)
    s = r * np.sqrt(np.maximum(2 - r * r, 0))
    return np.stack([s * np.copysign(np.cos(phi), u), s * np.copysign(np.sin(phi), v), z], -1)


def sky_radiance(d, sun_from):
    """Linear RGB radiance for directions d (..., 3): zenith gradient, glow about the sun, thin cloud, ground."""
    z = d[..., 2]
    height = np.clip(z, 0, 1)
    blue = mix([0.92, 1.08, 1.30], [0.27, 0.50, 1.05], (height**0.45).reshape(z.shape))
    cosine = np.clip(d @ (np.asarray(sun_from) / np.linalg.norm(sun_from)), -1, 1)
    glow = 0.9 * np.exp((cosine - 1) * 9) + 0.35 * np.exp((cosine - 1) * 1.6)
    sky = blue + glow[..., None] * np.array([1.0, 0.86, 0.66])
    # Thin cloud from 2D noise projected on a plane above, faded at the horizon where it would alias.
    table = noise((256, 256), 11, 1.7)
    scale = 40 / np.maximum(z, 0.06)
    cloud = table[(d[..., 1] * scale).astype(int) % 256, (d[..., 0] * scale).astype(int) % 256]
    cover = smoothstep(0.2, 1.8, cloud) * smoothstep(0.08, 0.4, z) * 0.55
    sky = mix(sky, np.array([1.55, 1.55, 1.52]), cover)
    # The horizon: far hills, then a garden; both give bounce light, and are small and over-exposed in the picture.
    azimuth = np.arctan2(d[..., 1], d[..., 0])
    hills = 0.060 + 0.022 * np.sin(3 * azimuth + 0.7) + 0.012 * np.sin(7 * azimuth + 2.1) + 0.006 * np.sin(19 * azimuth)
    trees = (
        0.030 + 0.060 * np.sin(5 * azimuth + 1.3) + 0.045 * np.sin(13 * azimuth) + 0.020 * np.sin(31 * azimuth + 0.4)
    )
    lawn = mix([0.33, 0.39, 0.21], [0.46, 0.46, 0.40], smoothstep(-0.2, -0.9, z))
    crown = mix([0.10, 0.17, 0.08], [0.24, 0.33, 0.17], smoothstep(-0.10, 0.10, z + 0.05 * np.sin(23 * azimuth)))
    out = mix(sky, np.array([0.66, 0.78, 0.80]), smoothstep(0.02, -0.02, z - hills))
    out = mix(out, crown, smoothstep(0.035, -0.035, z - trees))
    return mix(out, lawn, smoothstep(-0.02, -0.16, z))


def sky_image(resolution, sun_from, samples=2):
    """Box-filtered: `samples` squared points per pixel."""
    fine = sky_radiance(square_to_sphere(resolution * samples), sun_from)
    return fine.reshape(resolution, samples, resolution, samples, 3).mean((1, 3))
