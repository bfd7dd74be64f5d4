# SPDX-License-Identifier: Apache-2.0
"""Lights that are hard to find, or of sizes that invite division by zero. A white lambertian receiver (albedo 1/2) at the origin."""
import math

import numpy as np
import pytest
from stage import diffuse, fresnel, lamp, mesh, point, rectangle, rectangle_form, square, within

RECEIVER = diffuse(0.5) + square(0.05)
LOOK = {"size": (16, 16), "eye": (0, 0, 0.5)}


def test_a_hundred_thousand_lights_with_one_dominant(stage):
    side, height = 316, 2.0
    x = np.linspace(-50, 50, side)
    places = [(a, b, height) for a in x for b in x] + [(0.5, 0.25, 3.0)]
    strength = np.array([1e-3] * side ** 2 + [50.0])
    p = np.array(places)
    d2 = (p ** 2).sum(1)
    expected = 0.5 / math.pi * (strength * p[:, 2] / d2 ** 1.5).sum()
    share = strength[-1] * 3 / d2[-1] ** 1.5 / (strength * p[:, 2] / d2 ** 1.5).sum()
    assert 0.9 < share < 0.999
    found = stage.render(RECEIVER + "".join(point(float(s), q) for s, q in zip(strength, places)), samples=16, **LOOK)
    found.is_mean(expected, 1e-4, sharp=0.03)


def test_a_light_inside_glass(stage):
    """A black ball that emits, in a ball of glass so thin that every ray which enters it ends there. What leaves the glass has 1 / n^2
    of the radiance inside."""
    eta, inner, distance = 1.5, 0.8, 3.0
    ball = 'Shape "sphere" "float radius" {}\n'
    body = RECEIVER + within(f"Translate 0 0 {distance}", lamp(2, ball.format(inner)) + 'Material "dielectric" "float eta" 1.5\n' +
                             ball.format(1))
    sines = (np.arange(4000) + 0.5) / 4000 / distance  # of the angle from the axis; the ball's radius is 1
    seen = sum(s * (1 - fresnel(math.sqrt(1 - (s * distance) ** 2), eta)) for s in sines)
    expected = 0.5 * 2 / eta ** 2 * 2 * seen / 4000 / distance  # albedo, radiance; the integral of 2 (1 - F) sin d(sin)
    found = stage.render(body, samples=256, depth=6, **LOOK)
    found.is_mean(expected, 1e-3)


def wall_with_hole(half, z, size=10):
    a, h = size, half
    return diffuse(0) + "".join(rectangle(*r, z, up=False) for r in
                                ((-a, a, h, a), (-a, a, -a, -h), (-a, -h, -h, h), (h, a, -h, h)))


def test_a_light_through_a_keyhole(stage):
    """A hole of 2 cm in a wall, and behind it a lamp of which each point of the receiver sees a twenty-fifth."""
    body = RECEIVER.replace("0.05", "0.001") + wall_with_hole(0.01, 2) + lamp(100, square(0.05, 2.02, up=False))
    found = stage.render(body, samples=1024, fov=0.001, size=(16, 16), eye=(0, 0, 0.5))
    found.is_mean(50 * rectangle_form(-0.01, 0.01, -0.01, 0.01, 2), 1e-3, sharp=0.02)


@pytest.mark.parametrize("kind", ["rectangle", "triangle", "sphere before it", "sphere around it"])
def test_a_light_larger_than_the_scene(stage, kind):
    """A million times: the receiver sees little else."""
    size = 1e6
    shape = {"rectangle": square(size, 1, up=False),
             "triangle": mesh([(-3 * size, -size, 1), (0, 3 * size, 1), (3 * size, -size, 1)], [0, 1, 2]),
             "sphere before it": within(f"Translate 0 0 {size + 1}", f'Shape "sphere" "float radius" {size}\n'),
             "sphere around it": f'ReverseOrientation\nShape "sphere" "float radius" {size}\n'}[kind]
    found = stage.render(RECEIVER + lamp(1, shape), samples=256, **LOOK)
    found.is_mean(0.5, 1e-4, sharp=0.03)


def test_lights_of_no_area(stage):
    """Points, edges, collinear triangles, a sphere of radius 1e-20 and a disk of 0 emit nothing; what has an area does."""
    area = rectangle_form(-0.5, 0.5, -0.5, 0.5, 1.5)
    none = mesh([(0, 0, 2), (1, 0, 2), (2, 0, 2)], [0, 0, 0, 0, 1, 1, 0, 1, 2, 2, 0, 1])
    mixed = mesh([(-0.5, -0.5, 1.5), (0.5, -0.5, 1.5), (0.5, 0.5, 1.5), (-0.5, 0.5, 1.5), (0, 0, 1.5)],
                 [0, 0, 0, 2, 1, 0, 0, 0, 4, 0, 4, 2, 3, 2, 0, 1, 1, 2])
    round_ones = 'Shape "sphere" "float radius" 1e-20\n' + 'Shape "disk" "float radius" 0\n'
    alone = stage.render(RECEIVER + lamp(3, none) + within("Translate 0 0 2", lamp(3, round_ones)), samples=16, **LOOK)
    alone.is_everywhere(0)
    found = stage.render(RECEIVER + lamp(3, none) + lamp(3, mixed) + within("Translate 0 0 2", lamp(3, round_ones)), samples=256, **LOOK)
    found.is_mean(1.5 * area, 1e-3)


@pytest.mark.parametrize("side", [1e-3, 1e-6, 1e-9])
def test_a_tiny_light_is_a_point(stage, side):
    """Inverse square, from a lamp of so little area and so much radiance that their product is 1."""
    lamps = lamp(side ** -2, square(side / 2, 0, up=False))
    found = stage.render(RECEIVER + within("Translate 0 0 2", lamps), samples=4, **LOOK)
    found.is_mean(0.5 / math.pi / 4, 1e-3)


def test_a_light_seen_by_mirror_only(stage):
    """It faces away from the receiver, into a mirror of no loss: the receiver sees its image, four units further."""
    mirror = 'Material "conductor" "rgb reflectance" [ 1 1 1 ] "float roughness" 0\n' + square(20, 3, up=False)
    found = stage.render(RECEIVER + mirror + lamp(4, rectangle(1, 3, -1, 1, 1)), samples=512, depth=4, **LOOK)
    found.is_mean(2 * rectangle_form(1, 3, -1, 1, 5), 2e-3)


def test_a_sun_of_a_million_in_one_texel(stage):
    """In a black square map of 64 x 64: its texel, interpolated with its neighbours, keeps its energy."""
    from stage import write_pfm
    n = 64
    pixels = np.zeros((n, n, 3))
    pixels[n // 2, n // 2 + 3] = 1e6
    write_pfm(stage.folder / "sun.pfm", pixels)
    found = stage.render('LightSource "infinite" "string filename" "sun.pfm"\n' + diffuse(0.5) + square(0.05) , samples=64, **LOOK)
    # All texels have the solid angle 4 pi / n^2; the direction of this one is near +z (equal-area octahedron, Clarberg 2008).
    u, v = (n // 2 + 3.5) / n * 2 - 1, (n // 2 + 0.5) / n * 2 - 1
    r = abs(u) + abs(v)
    expected = 0.5 / math.pi * 1e6 * 4 * math.pi / n ** 2 * (1 - r * r)
    found.is_mean(expected, 0.01, sharp=0.01)
