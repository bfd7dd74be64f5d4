# SPDX-License-Identifier: Apache-2.0
"""Lamps of scenes/parts that shine: a table lamp with a linen shade, a paper lantern for the ceiling."""

import numpy as np

from .mesh import fillet, lathe, merge, smooth_curve, tube
from .palette import brass

GLOW = np.array([1.0, 0.72, 0.42])  # linear RGB of a bulb of about 2900 K


def sphere(radius):
    return f'Shape "sphere"\n        "float radius" [ {radius} ]'


def bulb(scene, z, radius, radiance):
    scene.material("Bulb glass", "diffuse", reflectance=(0.8, 0.8, 0.8))
    scene.shape("Bulb", "Bulb glass", sphere(radius), radiance * GLOW, (0, 0, z))


def table_lamp(scene):
    scene.section("Table lamp")
    brass(scene)
    scene.material("Glazed clay", "coateddiffuse", reflectance=(0.62, 0.57, 0.49), roughness=0.16)
    scene.material(
        "Linen shade", "diffusetransmission", reflectance=(0.46, 0.43, 0.37), transmittance=(0.42, 0.385, 0.31)
    )
    belly = smooth_curve(
        [
            (0.062, 0.006),
            (0.092, 0.045),
            (0.104, 0.095),
            (0.090, 0.150),
            (0.055, 0.195),
            (0.026, 0.225),
            (0.021, 0.245),
        ],
        6,
    )
    foot = fillet([(0, 0), (0.058, 0), (0.062, 0.006)], [0, 0.003, 0], 3)
    body = lathe(np.concatenate([foot[:-1], belly, [(0, 0.245)]]), 44)
    neck = lathe(
        fillet([(0, 0.243), (0.015, 0.243), (0.015, 0.262), (0.007, 0.268), (0.007, 0.318), (0, 0.318)], 0.002, 3), 28
    )
    shade = lathe([(0.172, 0.285), (0.128, 0.500)], 72)
    rims = [tube(ring(radius, z), 0.0026, 8, up=(0, 0, 1)) for radius, z in ((0.172, 0.285), (0.128, 0.500))]
    spider = [  # holds the shade
        tube([(0, 0, 0.306), (0.074 * c, 0.074 * s, 0.297), (0.1705 * c, 0.1705 * s, 0.288)], 0.0018, 6)
        for c, s in ((np.cos(t), np.sin(t)) for t in np.radians([20, 140, 260]))
    ]
    scene.shape("Lamp base", "Glazed clay", scene.mesh("table-lamp-base", body))
    scene.shape("Lamp neck", "Brushed brass", scene.mesh("table-lamp-neck", merge(neck, *rims, *spider)))
    scene.shape("Lamp shade", "Linen shade", scene.mesh("table-lamp-shade", shade))
    bulb(scene, 0.352, 0.034, 60.0)


def ring(radius, z, count=64):
    t = np.linspace(0, 2 * np.pi, count + 1)
    return np.stack([radius * np.cos(t), radius * np.sin(t), np.full_like(t, z)], 1)


def ceiling_lamp(scene):
    """Hangs from z = 0."""
    scene.section("Ceiling lamp")
    brass(scene)
    scene.material(
        "Lantern paper", "diffusetransmission", reflectance=(0.52, 0.50, 0.45), transmittance=(0.40, 0.375, 0.31)
    )
    scene.material("Black cable", "diffuse", reflectance=(0.025, 0.023, 0.022))
    centre, radius, high = -0.62, 0.25, 0.19
    t = np.linspace(-1.30, 1.30, 79)  # from the lower hole to the upper one
    ribs = 1 - 0.012 * np.abs(np.sin(13 * t))
    paper = lathe(np.stack([radius * np.cos(t) * ribs, centre + high * np.sin(t)], 1), 48)
    hole, top = radius * np.cos(1.30), centre + high * np.sin(1.30)
    rose = lathe(fillet([(0, -0.030), (0.050, -0.030), (0.055, -0.001), (0, -0.001)], [0, 0.010, 0.002, 0], 4), 40)
    socket = lathe(
        fillet(
            [
                (0, centre + 0.045),
                (0.019, centre + 0.045),
                (0.019, centre + 0.105),
                (0.006, centre + 0.115),
                (0, centre + 0.115),
            ],
            0.003,
            3,
        ),
        28,
    )
    wire = tube(ring(hole, top), 0.0022, 8, up=(0, 0, 1))
    cross = [
        tube([(0.004 * c, 0.004 * s, top), (0.5 * hole * c, 0.5 * hole * s, top), (hole * c, hole * s, top)], 0.0018, 6)
        for c, s in ((np.cos(a), np.sin(a)) for a in np.radians([15, 135, 255]))
    ]
    cable = tube([(0, 0, -0.028), (0, 0, 0.5 * (centre + 0.1)), (0, 0, centre + 0.112)], 0.0032, 10)
    scene.shape("Lantern", "Lantern paper", scene.mesh("ceiling-lamp-lantern", paper))
    scene.shape(
        "Lantern fittings", "Brushed brass", scene.mesh("ceiling-lamp-fittings", merge(rose, socket, wire, *cross))
    )
    scene.shape("Cable", "Black cable", scene.mesh("ceiling-lamp-cable", cable))
    bulb(scene, centre, 0.045, 60.0)
