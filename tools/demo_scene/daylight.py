# SPDX-License-Identifier: Apache-2.0
"""Late morning: the head and the lights that the demo scene and the empty room have in common."""

import pathlib
import sys

import numpy as np

from .writer import numbers

SUN_ELEVATION, SUN_HEADING = 31.0, 5.0  # light travels along +x, turned by the heading about z [degrees]
SUN_IRRADIANCE = np.array([1.0, 0.86, 0.69]) * 20.0
SKY_SCALE = 4.0


def sun_from():
    e, h = np.radians(SUN_ELEVATION), np.radians(SUN_HEADING)
    return np.array([-np.cos(e) * np.cos(h), -np.cos(e) * np.sin(h), np.sin(e)])


def head(title, film, eye, target, fov):
    """Camera, film and sampling; fov: of the shorter side [degrees]."""
    return f"""
# {title} at late morning. Metres; z is up. See scenes/README.md.
Scale -1 1 1
LookAt {numbers(eye)}  {numbers(target)}  0 0 1
Camera "perspective"
    "float fov" [ {fov} ]
Film "rgb"
    "integer xresolution" [ 960 ]
    "integer yresolution" [ 540 ]
    "string filename" [ "{film}.exr" ]
PixelFilter "gaussian"
    "float xradius" [ 1.5 ]
    "float yradius" [ 1.5 ]
    "float sigma" [ 0.5 ]
Sampler "zsobol"
    "integer pixelsamples" [ 256 ]
Integrator "volpath"
    "integer maxdepth" [ 12 ]
"""


def lights(textures, brightness=1):
    """Sky and sun; textures: the folder of sky.exr, relative to the scene."""
    return f"""
# name: Sky
AttributeBegin
    LightSource "infinite"
        "string filename" [ "{textures}/sky.exr" ]
        "float scale" [ {brightness * SKY_SCALE} ]
AttributeEnd
# name: Sun
AttributeBegin
    LightSource "distant"
        "point3 from" [ {numbers(sun_from())} ]
        "point3 to" [ 0 0 0 ]
        "rgb L" [ {numbers(brightness * SUN_IRRADIANCE)} ]
AttributeEnd
"""


def scenes_folder():
    """Of the command line, else of this repository."""
    here = pathlib.Path(__file__).resolve()
    return pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here.parents[2] / "scenes"
