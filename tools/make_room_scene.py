#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes scenes/room, an empty room, and scenes/parts, things to furnish it with (pbrt-v4). Needs numpy.

Their textures, and the meshes of the things that the demo scene has as well, are those of scenes/demo.
"""

import pathlib
import sys

import numpy as np
from demo_scene import bedroom, parts
from demo_scene.writer import Piece, emptied, numbers
from make_demo_scene import SKY_SCALE, SUN_IRRADIANCE, sun_from

EYE, TARGET, FOV = (4.02, -4.52, 1.28), (1.62, -0.90, 1.28), 46.0
PART_FOV = 26.0
BRIGHTNESS = 1.25  # of sun and sky, in place of a longer exposure


def head():
    return f"""
# An empty room at late morning. Metres; z is up. See scenes/README.md.
Scale -1 1 1
LookAt {numbers(EYE)}  {numbers(TARGET)}  0 0 1
Camera "perspective"
    "float fov" [ {FOV} ]
Film "rgb"
    "integer xresolution" [ 960 ]
    "integer yresolution" [ 540 ]
    "string filename" [ "room.exr" ]
PixelFilter "gaussian"
    "float xradius" [ 1.5 ]
    "float yradius" [ 1.5 ]
    "float sigma" [ 0.5 ]
Sampler "zsobol"
    "integer pixelsamples" [ 256 ]
Integrator "volpath"
    "integer maxdepth" [ 12 ]
"""


def lights():
    return f"""
# name: Sky
AttributeBegin
    LightSource "infinite"
        "string filename" [ "{Piece.textures}/sky.exr" ]
        "float scale" [ {BRIGHTNESS * SKY_SCALE} ]
AttributeEnd
# name: Sun
AttributeBegin
    LightSource "distant"
        "point3 from" [ {numbers(sun_from())} ]
        "point3 to" [ 0 0 0 ]
        "rgb L" [ {numbers(BRIGHTNESS * SUN_IRRADIANCE)} ]
AttributeEnd
"""


def write_room(folder):
    emptied(folder)
    scene = Piece(folder)
    bedroom.room(scene)
    scene.write("room.pbrt", head(), lights())
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
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent / "scenes")
