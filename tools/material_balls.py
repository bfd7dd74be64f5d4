#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders a ball of every material: the thumbnails in plugins/materials/*, and a sheet of all at five roughnesses.

    build/venv/bin/python tools/material_balls.py [--restage build/bin/restage] [--thumbnails] [--sheet FILE.jpg] [TYPE...]

Materials are those of `restage plugins`; one that is new needs no line here, but may have one in LOOKS."""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

from PIL import Image, ImageDraw

ROOT = Path(__file__).resolve().parents[1]
ROUGHNESSES = (0, 0.1, 0.3, 0.6, 1)

# What shows a material best, by the names pbrt has for it (else those of its table); the rest is its default.
LOOKS = {
    "coatedconductor": '"float conductor.roughness" 0.25',
    "coateddiffuse": '"rgb reflectance" [0.6 0.12 0.08]',
    "conductor": '"float uroughness" 0.1 "float vroughness" 0.1',
    "diffuse": '"rgb reflectance" [0.7 0.5 0.3]',
    "diffusetransmission": '"rgb reflectance" [0.3 0.45 0.2] "rgb transmittance" [0.4 0.5 0.15]',
    "plastic": '"rgb Kd" [0.1 0.25 0.5] "rgb Ks" [0.3 0.3 0.3]',
    "principled": '"rgb base_color" [0.1 0.35 0.6] "float roughness" 0.25 "float clearcoat" 1',
    "substrate": '"rgb Kd" [0.35 0.1 0.3] "rgb Ks" [0.05 0.05 0.05]',
    "translucent": '"rgb Kd" [0.6 0.5 0.3] "rgb Ks" [0.1 0.1 0.1]',
    "uber": '"rgb Kd" [0.1 0.4 0.3] "rgb Ks" [0.2 0.2 0.2]',
}

SCENE = """LookAt 0 -6.2 2.5  0 0 0.93  0 0 1
Camera "perspective" "float fov" 24
Film "rgb" "integer xresolution" 128 "integer yresolution" 128
Integrator "path" "integer maxdepth" 12
WorldBegin
LightSource "infinite" "rgb L" [0.28 0.33 0.42]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [11 10 8.6]
  Translate -3.6 -3 4.6
  Rotate 47 1 -0.85 0
  Shape "bilinearmesh" "point3 P" [-1.1 -1.1 0  -1.1 1.1 0  1.1 -1.1 0  1.1 1.1 0]
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [3 3.6 5]
  Translate 4 2.5 3.2
  Rotate -55 -0.6 1 0
  Shape "bilinearmesh" "point3 P" [-0.7 -1.4 0  -0.7 1.4 0  0.7 -1.4 0  0.7 1.4 0]
AttributeEnd
Texture "tiles" "spectrum" "checkerboard" "rgb tex1" [0.55 0.54 0.52] "rgb tex2" [0.16 0.16 0.18] "float uscale" 20 "float vscale" 20
Material "diffuse" "texture reflectance" "tiles"
Shape "bilinearmesh" "point3 P" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]
%s
AttributeBegin
  Translate 0 0 1
  Shape "sphere"
AttributeEnd
"""


def materials(restage):
    plugins = json.loads(subprocess.run([restage, "plugins", "--json"], capture_output=True, text=True, check=True).stdout)
    found = {}
    for plugin in plugins:
        for name in plugin["provides"]:
            if name.startswith("material ") and name.split()[1] not in ("interface", "mix"):
                found[name.split()[1]] = Path(plugin["folder"])
    return dict(sorted(found.items()))


def ball(restage, material, parameters, spp, folder):
    scene, picture = Path(folder) / "ball.pbrt", Path(folder) / "ball.png"
    scene.write_text(SCENE % f'Material "{material}" {parameters}')
    subprocess.run([restage, "-q", "render", scene, "-o", picture, "--spp", str(spp), "--denoise"], check=True)
    return Image.open(picture).convert("RGB")


def roughness_ids(folder):
    """Ids of the parameters that are roughnesses, as its table says; of the plugin's own GLSL struct there is no other list."""
    text = "".join(f.read_text() for f in folder.glob("*.glsl"))
    ids = []
    for name in ("roughness", "uroughness", "vroughness", "conductor_uroughness", "conductor_vroughness", "sigma"):
        if f"m.{name}" in text:
            ids.append(name.replace("conductor_", "conductor."))  # as pbrt writes it
    return ids


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--restage", default=str(ROOT / "build/bin/restage"))
    parser.add_argument("--thumbnails", action="store_true", help="into plugins/materials/TYPE/thumbnail.jpg")
    parser.add_argument("--sheet", help="JPEG of all materials at five roughnesses")
    parser.add_argument("--spp", type=int, default=128)
    parser.add_argument("types", nargs="*")
    o = parser.parse_args()
    chosen = {m: f for m, f in materials(o.restage).items() if not o.types or m in o.types}
    with tempfile.TemporaryDirectory() as folder:
        if o.thumbnails:
            for material in chosen:
                place = ROOT / "plugins/materials" / material
                if place.is_dir():
                    ball(o.restage, material, LOOKS.get(material, ""), o.spp, folder).save(place / "thumbnail.jpg", quality=88)
                    print(place / "thumbnail.jpg", flush=True)
        if o.sheet:
            rows = [(m, ids) for m, f in chosen.items() if (ids := roughness_ids(f))]
            sheet = Image.new("RGB", (110 + 128 * len(ROUGHNESSES), 20 + 128 * len(rows)), "white")
            draw = ImageDraw.Draw(sheet)
            for x, roughness in enumerate(ROUGHNESSES):
                draw.text((110 + 128 * x + 50, 4), f"{roughness:g}", fill="black")
            for y, (material, ids) in enumerate(rows):
                draw.text((4, 20 + 128 * y + 58), material, fill="black")
                for x, roughness in enumerate(ROUGHNESSES):
                    values = " ".join(f'"float {i}" {roughness * (90 if i == "sigma" else 1):g}' for i in ids)
                    look = LOOKS.get(material, "")
                    for i in ids:  # what the look says of it gives way
                        start = look.find(f'"float {i}"')
                        if start >= 0:
                            end = look.find('"', start + len(f'"float {i}"'))
                            look = look[:start] + (look[end:] if end >= 0 else "")
                    picture = ball(o.restage, material, f"{look} {values}", o.spp, folder)
                    sheet.paste(picture, (110 + 128 * x, 20 + 128 * y))
                print(material, flush=True)
            sheet.save(o.sheet, quality=85)


if __name__ == "__main__":
    main()
