# SPDX-License-Identifier: Apache-2.0
"""Needles, degenerate triangles, coplanar and touching surfaces, thin shells, transforms without a shape to be proud of,
grazing light and view, shading normals against the geometry.

Parallel light on a matte surface has no noise, so that most of these hold each pixel to the closed form.
"""
import math

import numpy as np
import pytest
from stage import (diffuse, distant, fresnel, glass, lamp, mesh, numbers, room, sky, square, stack_transmittance,
                   within, write_ply)

LIGHT = distant(math.pi, (0.3, 0.2, 1))
FACING = 1 / math.sqrt(1.13)  # the cosine at a surface that faces +z; radiance per albedo
TILT = "Rotate 37 1 -2 0.5"


def tilted_eye(distance=1.0):
    """Where the camera above the origin is after TILT, and its up."""
    axis = np.array([1, -2, 0.5]) / math.sqrt(5.25)
    a = math.radians(37)

    def turn(p):
        p = np.asarray(p, float)
        return tuple(p * math.cos(a) + np.cross(axis, p) * math.sin(a) + axis * axis.dot(p) * (1 - math.cos(a)))
    return {"eye": turn((0, 0, distance)), "up": turn((0, 1, 0)), "transform": TILT}


def test_a_plane_of_needles_is_a_plane(stage):
    """2000 triangles of 2 x 0.001 units about a corner, then the same cut into slivers of 1e-6, tilted against the axes."""
    n = 2000
    rim = [(1, -1 + 4 * k / n, 0) for k in range(n // 2)] + [(1 - 4 * k / n, 1, 0) for k in range(n // 2 + 1)]
    points = [(-1, -1, 0), *rim]
    fan = [(0, k, k + 1) for k in range(1, len(rim))]
    found = stage.render(LIGHT + diffuse(0.5) + mesh(points, fan), size=(64, 64), samples=4, fov=30.0, **tilted_eye())
    found.is_everywhere(0.5 * FACING)
    strips = 500
    x = np.concatenate([[-1 + 2 * k / strips, -1 + 2 * k / strips + 1e-6] for k in range(strips)] + [[1.0]])
    points = np.array([(a, b, 0) for a in x for b in (-1, 1)])
    quads = [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k, 2 * k + 3, 2 * k + 1) for k in range(len(x) - 1)]
    found = stage.render(LIGHT + diffuse(0.5) + mesh(points, quads), size=(64, 64), samples=4, fov=30.0, **tilted_eye())
    found.is_everywhere(0.5 * FACING)


def test_degenerate_triangles_change_nothing(stage):
    good = [0, 1, 2, 0, 2, 3]
    points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 0.2), (0, 0, 0.2), (-2, -2, 0.2), (2, 2, 0.2)]
    bad = [0, 0, 0, 0, 1, 1, 4, 5, 4, 4, 6, 7, 6, 4, 7, 2, 5, 4]  # points, edges, and collinear corners before the plane
    plain = stage.render(LIGHT + diffuse(0.5) + mesh(points, good), size=(32, 32), fov=60.0, samples=4, **tilted_eye())
    both = stage.render(LIGHT + diffuse(0.5) + mesh(points, bad + good), size=(32, 32), fov=60.0, samples=4, **tilted_eye())
    plain.is_everywhere(0.5 * FACING)
    both.is_everywhere(0.5 * FACING)


def test_coplanar_surfaces_are_one(stage):
    """Three squares in one plane, by triangulations and transforms of different rounding: none shades the others."""
    body = (LIGHT + diffuse(0.5) + square(1) + within("Rotate 30 0 0 1", square(1.7)) +
            within("Scale 1000 1000 1000\nRotate 71 0 0 1", square(3e-3)))
    stage.render(body, size=(64, 64), samples=4, fov=30.0, **tilted_eye()).is_everywhere(0.5 * FACING)


def test_touching_boxes_let_no_light_between_them(stage):
    """A room of six boxes that only touch, under a sky of 1000."""
    text = ""
    for axis in range(3):
        for side in (-1, 1):
            reach = np.array([1.0, 1.0, 1.0])
            at = np.zeros(3)
            at[axis], reach[axis] = 1.25 * side, 0.25
            for other in range(axis):  # those before it end where it begins
                reach[other] = 1.5
            text += within(f"Translate {at[0]} {at[1]} {at[2]}\nScale {reach[0]} {reach[1]} {reach[2]}", room())
    found = stage.render(sky(1e3) + diffuse(0.9) + text, size=(32, 32), samples=16, depth=8, fov=80.0, transform=TILT,
                         eye=(0.1, -0.3, 0.2), at=(0.4, 1, 0), up=(0, 0, 1))
    found.is_everywhere(0)


@pytest.mark.parametrize("gap", [1e-3, 1e-6])
def test_thin_shells_are_opaque(stage, gap):
    """Two spheres, and a room in a room, that far apart; outside a sky of 1000."""
    for shell in ('Shape "sphere" "float radius" 1\n' + f'Shape "sphere" "float radius" {1 + gap!r}\n', room() + room(1 + gap)):
        found = stage.render(sky(1e3) + diffuse(0.9) + shell, size=(32, 32), samples=16, depth=8, fov=80.0, transform=TILT,
                             eye=(0.1, -0.3, 0.2), at=(0.4, 1, 0), up=(0, 0, 1))
        found.is_everywhere(0)


@pytest.mark.parametrize("thickness", [1e-5, 1e-3, 1])
def test_a_thin_pane_transmits_like_a_thick_one(stage, thickness):
    """Below some 1e-6 of the distance to the camera a ray leaves one side behind the other: docs/stability.md."""
    body = lamp(1, square(5, -3)) + glass(1.5) + square(5) + square(5, -thickness, up=False)
    found = stage.render(body, samples=256, depth=100, **tilted_eye())
    found.is_mean(stack_transmittance([fresnel(1, 1.5)] * 2), sharp=0.004)


def corner(matrix=None):
    """An L-shaped, uneven solid: its triangles, by their own coordinates times `matrix`."""
    p = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.2, 0.1, 0.7), (0.9, 0.3, 0.5), (0.6, 0.8, 0.6), (0.1, 0.9, 1.0)])
    p = p - 0.4
    faces = [(0, 2, 1), (0, 3, 2), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7),
             (4, 5, 6), (4, 6, 7)]
    return mesh(p if matrix is None else p @ np.asarray(matrix, float).T, faces)


def pbrt_matrix(m):
    """Of a 3x3 matrix; pbrt writes columns."""
    full = np.eye(4)
    full[:3, :3] = m
    return f"Transform {numbers(full.T)}"


TRANSFORMS = {"mirrored": [[-1, 0, 0], [0, 1, 0], [0, 0, 1]],
              "inverted": [[-1, 0, 0], [0, -1, 0], [0, 0, -1]],
              "sheared": [[1, 2, 0], [0, 1, 0], [0.5, -1, 1]],
              "sheared by 100": [[1, 100, 0], [0, 1, 0], [0, 0, 1]],
              "flattened to 1e-5": [[1, 0, 0], [0, 1, 0], [0, 0, 1e-5]],
              "stretched by 1e4": [[1e4, 0, 0], [0, 1, 0], [0, 0, 1]]}


@pytest.mark.parametrize("name", TRANSFORMS)
def test_a_transform_is_its_transformed_vertices(stage, name):
    m = np.array(TRANSFORMS[name], float)
    body = LIGHT + sky(0.3) + diffuse(0.5)
    look = {"eye": (2, -3, 2.5), "up": (0, 0, 1), "fov": 35.0, "size": (48, 48), "samples": 16, "depth": 3}
    theirs = stage.render(body + corner(m), **look)
    ours = stage.render(body + within(pbrt_matrix(m), corner()), **look)
    noise = np.hypot(theirs.picture.std_error[..., 1], ours.picture.std_error[..., 1]) + 2e-3
    off = np.abs(ours.pixels - theirs.pixels) / noise
    assert (off < 4).mean() > 0.99, f"{(off >= 4).sum()} pixels differ, by up to {off.max()} of their noise"
    ours.is_mean(theirs.value, 2e-3)


@pytest.mark.parametrize("scale", ["1 0 1", "0 0 0", "1 1e-12 1", "1e-30 1e-30 1e-30"])
def test_a_singular_transform_spoils_nothing(stage, scale):
    """The object is left out, with a message; the rest of the scene is as without it."""
    flat = within(f"Scale {scale}", corner() + lamp(5, square(0.2, 0.7)))
    found = stage.render(LIGHT + diffuse(0.5) + square(1) + within("Translate 0 0 0.4", flat), size=(32, 32), samples=2, fov=20.0,
                         **tilted_eye())
    share = np.mean(np.abs(found.pixels - 0.5 * FACING) < 1e-5)
    assert share > 0.8, f"only {share} of the plane is as without it"
    found.is_clean()


@pytest.mark.parametrize("scale", ["1 1 0", "1 1 1e-12"])
def test_a_lamp_that_is_flattened_is_left_out(stage, scale):
    """By a transform that keeps its area, but has no inverse: rays cannot find it, so it may not light by its samples either."""
    found = stage.render(diffuse(0.5) + square(0.05) + within(f"Translate 0 0 2\nScale {scale}", lamp(3, square(0.5, up=False))), samples=16)
    found.is_everywhere(0)


@pytest.mark.parametrize("elevation", [1e-2, 1e-4, 1e-6])
def test_grazing_light(stage, elevation):
    """So far above the horizon [rad]: on one large triangle pair, and on one of 20000, tilted against the axes. The normal is
    known to an ulp."""
    light = distant(math.pi / elevation, (math.cos(elevation), 0, math.sin(elevation)))
    x = np.linspace(-1, 1, 101)
    grid = np.array([(a, b, 0) for a in x for b in x])
    at = [(i * 101 + k, i * 101 + k + 101, i * 101 + k + 102, i * 101 + k + 1) for i in range(100) for k in range(100)]
    write_ply(stage.folder / "grid.ply", grid, [t for a, b, c, d in at for t in ((a, b, c), (a, c, d))])
    for surface in (square(1), 'Shape "plymesh" "string filename" "grid.ply"\n'):
        found = stage.render(light + diffuse(0.5) + surface, size=(32, 32), samples=4, fov=30.0, **tilted_eye())
        found.is_everywhere(0.5, 1e-4, absolute=0.5 * 4 * 2 ** -24 / elevation)


@pytest.mark.parametrize("elevation", [1e-2, 1e-4, 1e-6])
def test_grazing_view(stage, elevation):
    """Below 1e-3 the normal is turned to that much above the view (adapt_shading_normal)."""
    eye = (-1000 * math.cos(elevation), 0, 1000 * math.sin(elevation))
    found = stage.render(LIGHT + diffuse(0.5) + square(1e3), eye=eye, up=(0, 0, 1), fov=math.degrees(0.1 * elevation), size=(32, 32))
    found.is_everywhere(0.5 * FACING, 1e-5 if elevation > 1e-3 else 1e-3 * math.hypot(0.3, 0.2))


def test_light_behind_either_normal_is_none(stage):
    """The shading normal of a triangle leans by 70 degrees. Light counts by the shading cosine, and not if it comes from behind the
    triangle, nor from behind that normal."""
    lean = math.radians(70)
    n = (math.sin(lean), 0, math.cos(lean))
    plane = mesh([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [0, 1, 2, 0, 2, 3], normals=[n] * 4)
    for degrees, expected in ((0, math.cos(lean)), (60, math.cos(lean - math.radians(60))), (100, 0), (-30, 0), (-60, 0), (150, 0)):
        a = math.radians(degrees)
        found = stage.render(distant(math.pi, (math.sin(a), 0, math.cos(a))) + diffuse(0.5) + plane, size=(8, 8))
        found.is_everywhere(0.5 * max(0, expected), 1e-4, 1e-7)
    # A room of such walls neither glows nor leaks.
    walls = sky(1e3) + diffuse(0.9)
    for axis in range(3):
        for side in (-1, 1):
            p = np.empty((4, 3))
            p[:, axis] = side
            p[:, (axis + 1) % 3], p[:, (axis + 2) % 3] = (-1, 1, 1, -1), (-1, -1, 1, 1)
            m = np.zeros(3)
            m[axis], m[(axis + 1) % 3] = -side * math.cos(lean), math.sin(lean)
            walls += mesh(p if side < 0 else p[::-1], [0, 1, 2, 0, 2, 3], normals=[m] * 4)
    stage.render(walls, size=(32, 32), samples=16, depth=8, fov=80.0, eye=(0.1, -0.3, 0.2), at=(0.4, 1, 0),
                 up=(0, 0, 1)).is_everywhere(0)
