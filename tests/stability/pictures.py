#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the hard cases of docs/stability.md as contact sheets, to be looked at.

    pictures.py [--out docs/images] [--size 128] [--samples 16] [SHEET ...]
Writes stability-<sheet>.png. RESTAGE_BIN: the program whose package is used.
"""
import argparse
import math
import pathlib
import sys
import tempfile

import numpy as np
from PIL import Image, ImageDraw

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))
import conftest  # noqa: E402,F401  puts the package on the path
from stage import Stage, diffuse, distant, glass, lamp, mesh, point, rectangle, room, sky, square, within  # noqa: E402
from test_hard_lights import wall_with_hole  # noqa: E402
from test_scale import placed, view  # noqa: E402

CAPTION = 14
FLOOR = ('Texture "check" "spectrum" "checkerboard" "float uscale" 12 "float vscale" 12 "rgb tex1" [ .2 .2 .25 ] "rgb tex2" [ .7 .7 .7 ]\n'
         'AttributeBegin\nMaterial "diffuse" "texture reflectance" "check"\n'
         'Shape "trianglemesh" "point3 P" [ -6 -6 0 6 -6 0 6 6 0 -6 6 0 ] "integer indices" [ 0 1 2 0 2 3 ] '
         '"point2 uv" [ 0 0 1 0 1 1 0 1 ]\nAttributeEnd\n')
LOOK = {"eye": (0, -6, 2.6), "at": (0, 0, 0.6), "up": (0, 0, 1), "fov": 34.0, "depth": 24}
DAY = sky((0.5, 0.6, 0.8)) + distant((2.5, 2.3, 2.0), (-1, -1.2, 2)) + FLOOR
ROW = [-1.35, -0.45, 0.45, 1.35]
METAL = 'Material "conductor" "rgb reflectance" [ .9 .85 .7 ] "float roughness" {} "bool remaproughness" false\n'


def ball(x, material, radius=0.42, z=None, y=0):
    return within(f"Translate {x} {y} {radius if z is None else z}", material + f'Shape "sphere" "float radius" {radius}\n')


def cornell(scale, offset):
    transform, place = placed(scale, offset)
    walls = room().split("Shape")[1:]  # -x, +x, -y, +y, -z, +z
    body = "".join(diffuse(c) + "Shape" + w for c, w in zip(((.6, .1, .1), (.1, .5, .1), .7, .7, .7, .7), walls))
    body += lamp(9, rectangle(-0.35, 0.35, -0.35, 0.35, 0.99, up=False)) + ball(0.4, glass(1.5), 0.35, z=-0.65, y=-0.1)
    body += ball(-0.4, METAL.format(0.05), 0.35, z=-0.65, y=0.4)
    return body, {"transform": transform, "depth": 12, **view(place, (0, -0.98, 0), (0, 1, 0), fov=75.0)}


def fan_ball(turns, rings):
    """A sphere of needles: each triangle from pole to pole is `rings` times as long as wide."""
    u = np.linspace(0, 2 * math.pi, turns, endpoint=False)
    v = np.linspace(0, math.pi, rings + 1)
    p = [(math.sin(b) * math.cos(a), math.sin(b) * math.sin(a), math.cos(b)) for b in v for a in u]
    faces = [t for k in range(rings) for i in range(turns)
             for j in [(i + 1) % turns] for t in ((k * turns + i, (k + 1) * turns + i, (k + 1) * turns + j),
                                                  (k * turns + i, (k + 1) * turns + j, k * turns + j))]
    return p, faces


def geometry():
    p, f = fan_ball(2000, 8)
    yield "needles 1:250", DAY + within("Translate 0 0 1", diffuse((.8, .5, .2)) + mesh(p, f)), {}
    p, f = fan_ball(10, 6)
    yield "shading normals", DAY + "".join(within(f"Translate {x} 0 0.55\nScale 0.5 0.5 0.5", m + mesh(p, f, normals=p)) for x, m in
                                           ((-1.15, diffuse(.7)), (0, METAL.format(0)), (1.15, glass(1.5)))), {}
    shear = "ConcatTransform [ 1 0 0 0  0 1 0 0  1.2 0 1 0  0 0 0 1 ]"
    yield "mirror, shear, flatten", DAY + "".join(
        within(f"Translate {x} 0 0.5\n{t}\nScale 0.5 0.5 0.5", diffuse((.3, .6, .7)) + mesh(p, f)) for x, t in
        ((-1.3, "Scale -1 1 1"), (0, shear), (1.3, "Scale 1 1 1e-3"))), {}
    transform, place = placed(1, 0)
    body = sky(10) + diffuse(.7) + room(1, 1e4) + lamp(9, rectangle(-0.35, 0.35, -0.35, 0.35, 0.9, up=False))
    yield "walls of 1e4, sky 10", body, {"transform": transform, "depth": 12, **view(place, (0, -0.98, 0), (0, 1, 0), fov=75.0)}
    yield "shell of 1e-4 glass", DAY + within("Translate 0 0 1", glass(1.5) + 'Shape "sphere" "float radius" 0.9\n' +
                                              'ReverseOrientation\nShape "sphere" "float radius" 0.8999\n'), {}


def matter():
    yield "index 1, 1.0001, 1.1, 1.5", DAY + "".join(ball(x, glass(e)) for x, e in zip(ROW, (1, 1.0001, 1.1, 1.5))), {}
    yield "rough 0, .001, .1, 1", DAY + "".join(ball(x, METAL.format(a)) for x, a in zip(ROW, (0, .001, .1, 1))), {}
    clear = glass(1.01)
    ink = "".join(f'MakeNamedMedium "m{k}" "string type" "homogeneous" "rgb sigma_a" [ {s} {s * .5} 0 ] "rgb sigma_s" [ 0 0 0 ]\n'
                  for k, s in enumerate((0, 1, 10, 1e6)))
    yield "absorb 0, 1, 10, 1e6", DAY + ink + "".join(within(f'MediumInterface "m{k}" ""', ball(x, clear)) for k, x in enumerate(ROW)), {}
    water = (within("Translate 0 0 0.02", glass(1.5) + 'Shape "cylinder" "float radius" 0.9 "float zmin" 0 "float zmax" 1.8\n'
                    'Shape "disk" "float radius" 0.9\n') +
             within("Translate 0 0 0.12", glass(1.5 / 1.33) + 'ReverseOrientation\nShape "cylinder" "float radius" 0.8 "float zmin" 0 "float zmax" 1.2\n'
                    'Shape "disk" "float radius" 0.8\n'))
    yield "glass of water", DAY + water + within("Translate 0 0 1.32", glass(1.33) + 'Shape "disk" "float radius" 0.8\n'), {}
    sheets = diffuse((.9, .3, .2)) + "".join(square(1.2, 0.02 + 1e-3 * k, extra='"float alpha" 0.002') for k in range(1500))
    yield "1500 layers of 0.2 %", DAY + sheets, {}


def lights():
    dark = FLOOR + sky(0.02)
    yield "lamp in glass", dark + within("Translate 0 0 1", lamp((9, 7, 4), 'Shape "sphere" "float radius" 0.3\n') + glass(1.5) +
                                         'Shape "sphere" "float radius" 0.9\n'), {}
    grey = wall_with_hole(0.15, 0, 5).replace("[ 0.0 0.0 0.0 ]", "[ .6 .6 .6 ]")
    wall = within("Translate 0 1 0\nRotate -90 1 0 0", "Translate 0 -1 0\n" + grey)
    yield "keyhole", FLOOR + wall + lamp(900, within("Translate 0 3 1.4\nRotate 90 1 0 0", square(0.4))), {}
    mirror = within("Translate 0 2 1.5\nRotate 90 1 0 0", METAL.format(0) + square(1.2))
    screen = within("Translate 0 -0.2 0.8\nRotate 90 1 0 0", diffuse(.1) + square(0.4))
    back = lamp(12, within("Translate 0 -0.15 0.8\nRotate -90 1 0 0", square(0.35)))
    yield "mirror only", FLOOR + mirror + screen + back, {}
    many = "".join(point(2e-5, (6 * math.cos(2.4 * k) * math.sqrt(k / 1e5), 6 * math.sin(2.4 * k) * math.sqrt(k / 1e5), 0.3))
                   for k in range(100000)) + point(4.0, (1.2, -1, 2.0))
    yield "100001 lights", FLOOR + many + ball(0, diffuse(.7), 0.5), {}
    yield "lamp of 1e6 units", FLOOR + lamp(0.8, square(1e6, 5, up=False)) + ball(-0.8, diffuse(.7), 0.6) + ball(0.8, METAL.format(0), 0.6), {}
    sun = np.zeros((64, 64, 3))
    sun[30, 37] = 1e3
    yield "sun of one texel", FLOOR + 'LightSource "infinite" "string filename" "sun.pfm"\n' + ball(0, diffuse(.7), 0.6), {"sun": sun}


SHEETS = {"scale": lambda: ((f"{s:g}{f', at {o:g}' if o else ''}", *cornell(s, o)) for s, o in ((1, 0), (1e-4, 0), (1e6, 0), (1e-4, 1e6))),
          "geometry": geometry, "matter": matter, "lights": lights}


def srgb(linear):
    linear = np.clip(linear, 0, 1)
    return np.uint8(255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055) + 0.5)


def main():
    from stage import write_pfm
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sheets", nargs="*", default=list(SHEETS))
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/images")
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--samples", type=int, default=16)
    args = parser.parse_args()
    for name in args.sheets:
        tiles = []
        for caption, body, look in SHEETS[name]():
            with tempfile.TemporaryDirectory() as folder:
                look = LOOK | look
                if (sun := look.pop("sun", None)) is not None:
                    write_pfm(pathlib.Path(folder) / "sun.pfm", sun)
                found = Stage(folder).render(body, samples=args.samples, size=(args.size, args.size), **look)
            tile = Image.new("RGB", (args.size, args.size + CAPTION), "white")
            tile.paste(Image.fromarray(srgb(found.picture.color)), (0, 0))
            ImageDraw.Draw(tile).text((2, args.size + 1), caption, fill="black")
            tiles.append(tile)
            print(f"{name}: {caption}: mean {found.value:.4g}, not finite {found.picture.not_finite}, {found.report}", flush=True)
        sheet = Image.new("RGB", (len(tiles) * (args.size + 4) - 4, args.size + CAPTION), "white")
        for k, tile in enumerate(tiles):
            sheet.paste(tile, (k * (args.size + 4), 0))
        file = args.out / f"stability-{name}.png"
        sheet.quantize(128).save(file, optimize=True)
        print(f"{file}: {file.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
