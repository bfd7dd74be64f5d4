#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes scenes/room, an empty room, and scenes/parts, things to furnish it with (pbrt-v4). Needs numpy.

Their textures, and the meshes of the things that the demo scene has as well, are those of scenes/demo.
"""

import numpy as np
from demo_scene import bedroom, daylight, parts
from demo_scene.writer import Piece, emptied, numbers

EYE, TARGET, FOV = (4.02, -4.52, 1.28), (1.62, -0.90, 1.28), 46.0
PART_FOV = 26.0
BRIGHTNESS = 1.25  # of sun and sky, in place of a longer exposure


def write_room(folder):
    emptied(folder)
    scene = Piece(folder)
    bedroom.room(scene)
    head = daylight.head("An empty room", "room", EYE, TARGET, FOV)
    scene.write("room.pbrt", head, daylight.lights(Piece.textures, BRIGHTNESS))
    return scene.triangles


def view(middle, size):
    """A camera in front of a thing, to its right and above it, which sees a ball about its middle [m]."""
    away = 1.08 * size / 2 / np.sin(np.radians(PART_FOV / 2))
    eye = middle + away * np.array([0.50, -0.80, 0.33])
    return f"""Scale -1 1 1
LookAt {numbers(eye)}  {numbers(middle)}  0 0 1
Camera "perspective"
    "float fov" [ {PART_FOV} ]
Film "rgb"
    "integer xresolution" [ 640 ]
    "integer yresolution" [ 640 ]
"""


def write_parts(folder):
    emptied(folder)
    total = 0
    for part in parts.PARTS:
        scene = Piece(folder, part.of_the_demo)
        part.build(scene)
        scene.write(f"{part.name}.pbrt", view(np.array([0, 0, part.middle]), part.size))
        total += scene.triangles
    return total


def main(scenes):
    print(f"room: {write_room(scenes / 'room')} triangles")
    print(f"parts: {write_parts(scenes / 'parts')} triangles")


if __name__ == "__main__":
    main(daylight.scenes_folder())
