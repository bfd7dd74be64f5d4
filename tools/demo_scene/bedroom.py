# SPDX-License-Identifier: Apache-2.0
"""The empty room of scenes/room: painted walls, plank floor, a large window to the left, a garden door behind the camera.

x 0..WIDTH from the window wall, y -DEPTH..0 with the far wall at y = 0, z 0..HEIGHT [m].
"""

import numpy as np

from .mesh import box_between, fillet, lathe, merge, rotate, sweep, translate
from .palette import brass
from .room import quad, wall_with_hole

WIDTH, DEPTH, HEIGHT = 4.4, 4.8, 2.65
WINDOW = (-2.95, -0.95, 0.46, 2.22)  # y0 y1 z0 z1 in the wall x = 0
DOOR = (0.9, 3.3, 0.02, 2.30)  # x0 x1 z0 z1 in the wall y = -DEPTH, not seen by the camera: it fills the shadows
REVEAL = 0.24  # thickness of the outer walls


def materials(scene):
    scene.section("The room")
    scene.texture(
        "plaster height", "float", "plaster-height.png", encoding="linear", scale=0.004, uscale=0.8, vscale=0.8
    )
    scene.texture("floor planks", "spectrum", "floor-planks.png", uscale=0.5, vscale=0.5)
    scene.texture("floor height", "float", "floor-height.png", encoding="linear", scale=0.0012, uscale=0.5, vscale=0.5)
    plaster = {"displacement": ("texture", "plaster height")}
    scene.material("White wall paint", "diffuse", reflectance=(0.80, 0.775, 0.735), **plaster)
    scene.material("Wall colour", "diffuse", reflectance=(0.40, 0.455, 0.42), **plaster)
    scene.material("Ceiling paint", "diffuse", reflectance=(0.84, 0.83, 0.80))
    scene.material(
        "Oak floor",
        "coateddiffuse",
        reflectance=("texture", "floor planks"),
        roughness=0.26,
        displacement=("texture", "floor height"),
    )
    scene.material("White gloss paint", "coateddiffuse", reflectance=(0.80, 0.79, 0.755), roughness=0.22)
    brass(scene)


def walls():
    """The three walls apart from the far one, their faces inwards."""
    w, d, h = WIDTH, DEPTH, HEIGHT
    window = wall_with_hole(d, h, (WINDOW[0] + d, WINDOW[1] + d, *WINDOW[2:]), REVEAL).moved(translate(0, -d, 0))
    # A quarter turn takes +x to +y and +y to -x: s runs from x = w to x = 0.
    door = wall_with_hole(w, h, (w - DOOR[1], w - DOOR[0], *DOOR[2:]), REVEAL)
    door = door.moved(translate(w, -d, 0) @ rotate((0, 0, 1), 90))
    right = quad((w, 0.1, -0.1), (0, -d - 0.2, 0), (0, 0, h + 0.2))
    return merge(window, door, right)


def around(profile):
    """A profile (distance from the wall, z) along the visible walls, its ends open: they lie in walls."""
    w, d = WIDTH, DEPTH
    return merge(
        sweep([(0, -d, 0), (0, 0, 0)], profile, caps=False),
        sweep([(0, 0, 0), (w, 0, 0)], profile, caps=False),
        sweep([(w, 0, 0), (w, -d, 0)], profile, caps=False),
    )


def shell(scene):
    w, d, h = WIDTH, DEPTH, HEIGHT
    far = quad((-0.1, 0, -0.1), (w + 0.2, 0, 0), (0, 0, h + 0.2))
    ceiling = quad((-0.1, -d - 0.1, h), (0, d + 0.2, 0), (w + 0.2, 0, 0))
    floor = quad((-0.1, -d - 0.1, 0), (w + 0.2, 0, 0), (0, d + 0.2, 0))
    skirting = fillet([(0, 0), (0.018, 0), (0.018, 0.100), (0.010, 0.125), (0, 0.125)], [0, 0.001, 0.006, 0.004, 0], 3)
    angle = np.linspace(0, np.pi / 2, 9)  # a hollow quarter round
    hollow = np.stack([0.075 - 0.060 * np.cos(angle), h - 0.075 + 0.060 * np.sin(angle)], 1)
    cove = np.concatenate([[(0, h - 0.090), (0.015, h - 0.090)], hollow, [(0.090, h - 0.015), (0.090, h), (0, h)]])
    scene.shape("Walls", "White wall paint", scene.mesh("walls", walls()))
    scene.shape("Far wall", "Wall colour", scene.mesh("far-wall", far))
    scene.shape("Ceiling", "Ceiling paint", scene.mesh("ceiling", ceiling))
    scene.shape("Floor", "Oak floor", scene.mesh("floor", floor))
    scene.shape("Skirting board", "White gloss paint", scene.mesh("skirting", around(skirting)))
    scene.shape("Cornice", "Ceiling paint", scene.mesh("cornice", around(cove)))


def window(scene):
    """Two casements, each with a cross bar; an opening without panes, so that light sampling reaches the room."""
    y0, y1, z0, z1 = WINDOW
    x0, x1 = -0.19, -0.12
    middle = (y0 + y1) / 2
    bars = [
        ((y0, z0), (y0 + 0.06, z1)),
        ((y1 - 0.06, z0), (y1, z1)),
        ((y0 + 0.004, z0), (y1 - 0.004, z0 + 0.07)),
        ((y0 + 0.004, z1 - 0.06), (y1 - 0.004, z1)),
    ]
    parts = [box_between((x0, ya, za), (x1, yb, zb), 0.006) for (ya, za), (yb, zb) in bars]
    parts.append(box_between((x0 - 0.004, middle - 0.042, z0 + 0.02), (x1 + 0.010, middle + 0.042, z1 - 0.02), 0.007))
    for ya, yb in ((y0 + 0.03, middle - 0.02), (middle + 0.02, y1 - 0.03)):
        for share in (1 / 3, 2 / 3):
            z = z0 + 0.07 + share * (z1 - z0 - 0.13)
            parts.append(box_between((x0 + 0.02, ya, z - 0.012), (x1 - 0.015, yb, z + 0.012), 0.005))
    sill = box_between((-0.12, y0 - 0.06, z0 - 0.014), (0.070, y1 + 0.06, z0 + 0.018), 0.008, 3)
    rosette = lathe(
        fillet([(0, 0), (0.014, 0), (0.014, 0.005), (0.006, 0.007), (0.006, 0.026), (0, 0.026)], 0.001, 2), 20
    )
    at = translate(x1 + 0.010, middle, 1.20) @ rotate((0, 1, 0), 90)
    lever = box_between((x1 + 0.030, middle - 0.009, 1.085), (x1 + 0.042, middle + 0.009, 1.212), 0.005, 3)
    scene.shape("Window frame", "White gloss paint", scene.mesh("window-frame", merge(*parts)))
    scene.shape("Window sill", "White gloss paint", scene.mesh("window-sill", sill))
    scene.shape("Window handle", "Brushed brass", scene.mesh("window-handle", merge(rosette.moved(at), lever)))


def room(scene):
    materials(scene)
    shell(scene)
    window(scene)
