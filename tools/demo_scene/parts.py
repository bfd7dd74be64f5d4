# SPDX-License-Identifier: Apache-2.0
"""The things of scenes/parts, their fronts towards -y [m].

Each stands on z = 0 about the z axis; what hangs on a wall has its back at y = 0, what hangs from the ceiling its top at
z = 0.
"""

import dataclasses
from collections.abc import Callable

import numpy as np

from . import furniture, room, tableware
from .bed import bed
from .lamps import ceiling_lamp, table_lamp
from .mesh import (
    Mesh,
    box_between,
    cushion,
    fillet,
    lathe,
    merge,
    rotate,
    rounded_box,
    rounded_rectangle,
    sweep,
    translate,
    tube,
)
from .palette import bark, brass, mirror, oak, walnut, weave


def knob(x, y, z):
    """A round pull on a front at y."""
    profile = fillet(
        [(0, 0), (0.006, 0), (0.006, 0.012), (0.013, 0.018), (0.013, 0.025), (0, 0.027)],
        [0, 0, 0.003, 0.004, 0.004, 0],
        2,
    )
    return lathe(profile, 16).moved(translate(x, y, z) @ rotate((1, 0, 0), 90))


def bedside_table(scene):
    """A drawer above an open shelf."""
    scene.section("Bedside table")
    oak(scene)
    brass(scene)
    w, d, low, shelf, high = 0.23, 0.195, 0.19, 0.33, 0.52
    side = 0.018
    parts = [
        box_between((-w, -d, high - 0.022), (w, d, high), 0.006, 3, grain=0),
        box_between((-w + 0.002, -d + 0.006, low), (w - 0.002, d - 0.002, low + 0.018), 0.003, grain=0),
        box_between((-w + 0.004, -d + 0.012, shelf), (w - 0.004, d - 0.004, shelf + 0.016), 0.003, grain=0),
        box_between((-w + 0.006, d - 0.014, low + 0.004), (w - 0.006, d - 0.004, high - 0.006), 0.002, grain=2),
        box_between(
            (-w + side + 0.003, -d + 0.003, shelf + 0.020),
            (w - side - 0.003, -d + 0.021, high - 0.026),
            0.004,
            3,
            grain=0,
        ),
    ]
    for sx in (-1, 1):
        inner, outer = sorted((sx * w, sx * (w - side)))
        parts.append(box_between((inner, -d + 0.002, low + 0.004), (outer, d - 0.001, high - 0.004), 0.004, grain=2))
        for sy in (-1, 1):
            parts.append(
                furniture.leg(
                    (sx * (w - 0.022), sy * (d - 0.022), 0),
                    (sx * (w - 0.035), sy * (d - 0.035), low + 0.004),
                    0.010,
                    0.017,
                )
            )
    scene.shape("Bedside table", "Oak", scene.mesh("bedside-table", merge(*parts)))
    scene.shape(
        "Drawer knob",
        "Brushed brass",
        scene.mesh("bedside-table-knob", knob(0, -d + 0.003, 0.5 * (shelf + high) - 0.003)),
    )


def chest_of_drawers(scene):
    """Three rows of two drawers on a recessed stand."""
    scene.section("Chest of drawers")
    walnut(scene)
    brass(scene)
    w, d, low, high, side = 0.58, 0.225, 0.14, 0.80, 0.020
    parts = [
        box_between((-w, -d, high - 0.024), (w, d, high), 0.006, 3, grain=0),
        box_between((-w + 0.002, -d + 0.004, low), (w - 0.002, d - 0.002, low + 0.022), 0.004, grain=0),
        box_between((-w + 0.006, -d + 0.022, low + 0.006), (w - 0.006, d - 0.004, high - 0.008), 0.002, grain=0),
    ]
    knobs = []
    for sx in (-1, 1):
        inner, outer = sorted((sx * w, sx * (w - side)))
        parts.append(box_between((inner, -d + 0.002, low + 0.004), (outer, d - 0.001, high - 0.004), 0.004, grain=2))
        for sy in (-1, 1):
            parts.append(
                furniture.leg(
                    (sx * (w - 0.055), sy * (d - 0.045), 0),
                    (sx * (w - 0.085), sy * (d - 0.065), low + 0.004),
                    0.012,
                    0.020,
                )
            )
    rows = np.linspace(low + 0.025, high - 0.027, 4)
    for k in range(3):
        for xa, xb in ((-w + side + 0.003, -0.002), (0.002, w - side - 0.003)):
            drawer = box_between(
                (xa, -d + 0.004, rows[k] + 0.002), (xb, -d + 0.024, rows[k + 1] - 0.002), 0.004, 3, grain=0
            )
            parts.append(drawer.with_uv(1, (0.31 * k, 0.17 * k)))
            for share in (0.25, 0.75):
                knobs.append(knob(xa + share * (xb - xa), -d + 0.004, 0.5 * (rows[k] + rows[k + 1])))
    scene.shape("Chest of drawers", "Walnut", scene.mesh("chest", merge(*parts)))
    scene.shape("Drawer knobs", "Brushed brass", scene.mesh("chest-knobs", merge(*knobs)))


def armchair(scene):
    scene.section("Armchair")
    walnut(scene)
    cloth = weave(scene, "upholstery height", 0.0012, 9)
    scene.material("Upholstery wool", "diffuse", reflectance=(0.52, 0.27, 0.135), **cloth)
    parts = [rounded_box((0.66, 0.66, 0.14), 0.035, 3).moved(translate(0, -0.02, 0.235))]
    for sx in (-1, 1):
        arm = rounded_box((0.125, 0.73, 0.41), 0.058, 5)
        parts.append(arm.moved(translate(sx * 0.335, -0.015, 0.385) @ rotate((0, 1, 0), 3 * sx)))
    parts.append(rounded_box((0.74, 0.15, 0.62), 0.065, 5).moved(translate(0, 0.315, 0.495) @ rotate((1, 0, 0), -9)))
    parts.append(cushion((0.54, 0.60, 0.145), 0.050, 0.020).moved(translate(0, -0.075, 0.375)))
    back = cushion((0.53, 0.44, 0.150), 0.060, 0.030).moved(rotate((1, 0, 0), 90 - 11))
    parts.append(back.moved(translate(0, 0.175, 0.655)))
    legs = [
        furniture.leg((sx * 0.30, y * 1.06, 0), (sx * 0.275, y, 0.185), 0.011, 0.019)
        for sx in (-1, 1)
        for y in (-0.29, 0.26)
    ]
    scene.shape("Armchair", "Upholstery wool", scene.mesh("armchair", merge(*parts)))
    scene.shape("Armchair legs", "Walnut", scene.mesh("armchair-legs", merge(*legs)))


def curtains(scene):
    """A pair on a rod, for a window up to 2 m wide; the wall is y = 0."""
    scene.section("Curtains")
    brass(scene)
    scene.material(
        "Curtain linen", "diffusetransmission", reflectance=(0.45, 0.43, 0.385), transmittance=(0.36, 0.33, 0.27)
    )
    away, high, end = 0.135, 2.475, 1.42
    # The demo scene's curtains hang in the plane x = 0; a quarter turn takes their +x to -y.
    panels = [
        room.curtain(0.60, 0.088, seed, 100).moved(translate(x, -away, 0) @ rotate((0, 0, 1), -90))
        for seed, x in ((1.0, -1.36), (2.6, 0.76))
    ]
    ball = lathe(
        fillet([(0, -0.028), (0.006, -0.028), (0.026, -0.012), (0.026, 0.012), (0.012, 0.030), (0, 0.034)], 0.012, 4),
        20,
    )
    parts = [tube([(-end, -away, high), (0, -away, high), (end, -away, high)], 0.011, 16)]
    for sx in (-1, 1):
        parts.append(ball.moved(translate(sx * (end + 0.015), -away, high) @ rotate((0, 1, 0), 90 * sx)))
        parts.append(
            tube([(sx * 1.385, -0.001, high), (sx * 1.385, -away / 2, high), (sx * 1.385, -away, high)], 0.007, 10)
        )
        plate = rounded_box((0.032, 0.008, 0.075), 0.003)
        parts.append(plate.moved(translate(sx * 1.385, -0.0045, high)))
    t = np.linspace(0, 2 * np.pi, 8)
    eye = lathe(np.stack([0.021 + 0.0028 * np.cos(t), 0.0028 * np.sin(t)], 1), 14)
    for x0 in (-1.34, 0.80):
        for k in range(7):
            turn = rotate((0, 0, 1), 7 * np.sin(3 * k)) @ rotate((0, 1, 0), 90)
            parts.append(eye.moved(translate(x0 + 0.088 * k, -away, high - 0.010) @ turn))
    scene.shape("Curtains", "Curtain linen", scene.mesh("curtains", merge(*panels)))
    scene.shape("Curtain rod", "Brushed brass", scene.mesh("curtain-rod", merge(*parts)))


def floor_mirror(scene):
    """An arch that leans back on its stay."""
    scene.section("Floor mirror")
    brass(scene)
    mirror(scene)
    half, spring, foot = 0.34, 1.42, 0.03  # half the width; heights of the arch's beginning and of the lower edge
    t = np.linspace(0, np.pi, 33)
    arch = np.stack([half * np.cos(t), 0 * t, spring + half * np.sin(t)], 1)
    path = np.concatenate(
        [
            [(half, 0, z) for z in np.linspace(foot, spring, 9)[:-1]],
            arch,
            [(-half, 0, z) for z in np.linspace(spring, foot, 9)[1:]],
        ]
    )
    frame = sweep(path, rounded_rectangle(0.022, 0.030, 0.006), up=(0, 1, 0))
    bar = box_between((-half - 0.011, -0.015, foot - 0.011), (half + 0.011, 0.015, foot + 0.011), 0.006, 3)
    rim = path[:, ::2]
    count = len(rim)
    points = np.concatenate([rim, [(0, 0.8)]])
    v = np.stack([points[:, 0], np.full(count + 1, -0.004), points[:, 1]], 1)
    k = np.arange(count)
    fan = np.stack([k, np.full(count, count), (k + 1) % count], 1)
    glass = Mesh(v, np.tile([0.0, -1, 0], (count + 1, 1)), points, fan)
    if np.cross(v[fan[0, 1]] - v[fan[0, 0]], v[fan[0, 2]] - v[fan[0, 0]])[1] > 0:
        glass.f = glass.f[:, ::-1]
    back = Mesh(v + [0, 0.010, 0], -glass.n, points, glass.f[:, ::-1])
    lean = translate(0, -0.14, 0) @ rotate((1, 0, 0), -6)
    stay = [
        tube([(sx * 0.20, 0.005, 1.30), (sx * 0.215, 0.115, 0.66), (sx * 0.23, 0.24, 0.012)], 0.008, 12)
        for sx in (-1, 1)
    ]
    stay.append(tube([(-0.226, 0.2, 0.20), (0, 0.2, 0.20), (0.226, 0.2, 0.20)], 0.006, 10))
    scene.shape(
        "Mirror frame",
        "Brushed brass",
        scene.mesh("floor-mirror-frame", merge(merge(frame, bar, back).moved(lean), *stay)),
    )
    scene.shape("Mirror", "Mirror", scene.mesh("floor-mirror-glass", glass.moved(lean)))


def chair(scene):
    scene.section("Chair")
    oak(scene)
    scene.texture("cloth height", "float", "weave-height.png", encoding="linear", scale=0.0006, uscale=14, vscale=14)
    furniture.chair(scene)
    scene.place("Chair", rotate((0, 0, 1), 180))


def rug(scene):
    room.rug(scene, (0, 0), 0)


def picture(scene):
    walnut(scene)
    room.picture(scene, 0, 0)


def plant(scene):
    bark(scene)
    tableware.plant(scene, (0, 0))


def vase(scene):
    bark(scene)
    tableware.vase(scene)
    scene.place("Vase")


def books(scene):
    """A pile of five."""
    furniture.books(scene)
    sizes = ((0.21, 0.28, 0.034), (0.20, 0.27, 0.024), (0.19, 0.26, 0.030), (0.16, 0.22, 0.022), (0.15, 0.205, 0.026))
    furniture.stack_books(scene, (0, 0, 0), ("Blue", "Cream", "Ochre", "Red", "Green"), sizes, (88, 95, 84, 101, 92))


@dataclasses.dataclass
class Part:
    name: str
    build: Callable
    size: float  # diameter of a ball around it [m]
    middle: float  # z of that ball's centre [m]
    of_the_demo: bool = False  # its meshes are the demo scene's


PARTS = (
    Part("bed", bed, 2.75, 0.45),
    Part("bedside-table", bedside_table, 0.75, 0.26),
    Part("chest-of-drawers", chest_of_drawers, 1.40, 0.40),
    Part("armchair", armchair, 1.20, 0.40),
    Part("chair", chair, 1.00, 0.40, True),
    Part("floor-mirror", floor_mirror, 1.85, 0.88),
    Part("curtains", curtains, 3.60, 1.25),
    Part("woven-rug", rug, 2.70, 0.0, True),
    Part("framed-picture", picture, 1.05, 0.0, True),
    Part("table-lamp", table_lamp, 0.60, 0.25),
    Part("ceiling-lamp", ceiling_lamp, 0.98, -0.41),
    Part("plant", plant, 1.85, 0.85, True),
    Part("vase", vase, 0.85, 0.40, True),
    Part("books", books, 0.42, 0.06, True),
)
