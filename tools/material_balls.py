#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders a ball of every material: the thumbnails in plugins/materials/*, and a sheet of all at five roughnesses.

    build/venv/bin/python tools/material_balls.py [--restage build/bin/restage] [--thumbnails] [--sheet FILE.jpg] [TYPE...]

On the ball of another scene, next to pbrt-v4's picture of it (two halves), with the material NAME of that file replaced:
    ... --scene $RESTAGE_SCENES/material-testball/scene.pbrt --material Material --sheet OUT.png \\
        --reference $RESTAGE_REFERENCES/material-testball.1.exr $RESTAGE_REFERENCES/material-testball.2.exr
Mind the licence of such a scene: its sheet is for viewing only.

Materials are those of `restage plugins`; a new one needs no entry here, but may have one in LOOKS."""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

ROOT = Path(__file__).resolve().parents[1]
ROUGHNESSES = (0, 0.1, 0.3, 0.6, 1)
LABELS = 110  # pixels left of the balls

# Parameters that show a material best, under pbrt's names (else those of its table); the others have their defaults.
LOOKS = {
    "coatedconductor": '"float conductor.roughness" 0.25',
    "coateddiffuse": '"rgb reflectance" [0.6 0.12 0.08]',
    "conductor": '"float uroughness" 0.1 "float vroughness" 0.1',
    "diffuse": '"rgb reflectance" [0.7 0.5 0.3]',
    "diffusetransmission": '"rgb reflectance" [0.3 0.45 0.2] "rgb transmittance" [0.4 0.5 0.15]',
    "emissive": '"rgb radiance" [1 0.62 0.25] "float scale" 0.75 "rgb reflectance" [0.2 0.2 0.2]',
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


class Stage:
    """A scene with a ball that `render` renders in any material. Its files are reached through links."""

    def __init__(self, options, folder):
        self.options, self.folder = options, Path(folder)
        if options.scene:
            for entry in options.scene.resolve().parent.iterdir():
                (self.folder / entry.name).symlink_to(entry)
            self.text = options.scene.read_text()
            self.place = re.compile(r'MakeNamedMaterial\s+"%s"(\s+"\w+ [^"]+"\s+(\[[^\]]*\]|"[^"]*"|\S+))*' % re.escape(options.material))
            if not self.place.search(self.text):
                sys.exit(f'{options.scene}: no MakeNamedMaterial "{options.material}" in it')

    def filled(self, material, parameters):
        if not self.options.scene:
            return SCENE % f'Material "{material}" {parameters}'
        named = f'MakeNamedMaterial "{self.options.material}" "string type" "{material}" {parameters}'
        return self.place.sub(lambda _: named, self.text, count=1)

    def render(self, material, parameters):
        return self.picture(self.filled(material, parameters))

    def picture(self, text):
        scene, picture = self.folder / "ball of all.pbrt", self.folder / "ball of all.png"
        scene.write_text(text)
        subprocess.run([self.options.restage, "-q", "render", scene, "-o", picture, "--spp", str(self.options.spp), "--size",
                        f"{self.options.size}x{self.options.size}", "--denoise"], check=True)
        return Image.open(picture).convert("RGB")


def reference(halves, size):
    """The mean of the pictures, cropped to the middle square: a narrower film shows the same height."""
    sys.path.insert(0, str(ROOT / "tests/scripts"))
    import exr_file

    color = np.mean([np.stack([exr_file.read(half)[c] for c in "RGB"], -1) for half in halves], axis=0, dtype=np.float32)
    height, width, _ = color.shape
    left = (width - height) // 2
    channels = [Image.fromarray(np.ascontiguousarray(color[:, left:left + height, c])).resize((size, size), Image.BOX) for c in range(3)]
    linear = np.clip(np.stack([np.asarray(c) for c in channels], -1), 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return Image.fromarray(np.uint8(encoded * 255 + 0.5))


def roughness_ids(folder):
    """Ids of the roughness parameters, from its table; the plugin's own GLSL struct is listed nowhere else."""
    text = "".join(f.read_text() for f in folder.glob("*.glsl"))
    ids = []
    for name in ("roughness", "uroughness", "vroughness", "conductor_uroughness", "conductor_vroughness", "clearcoat_roughness", "sigma", "beta_m", "beta_n"):
        if re.search(rf"\bm\.{name}\b", text):
            ids.append(name.replace("conductor_", "conductor."))  # in pbrt's syntax
    return ids


def sheet_rows(chosen):
    """(label, type, roughnesses, other parameters): a material, and once more with multiscatter if it has that."""
    for material, folder in chosen.items():
        yield material, material, roughness_ids(folder), ""
        if any("m.multiscatter" in f.read_text() for f in folder.glob("*.glsl")):
            yield f"{material},\nmultiscatter", material, roughness_ids(folder), f'"string plugin" "{material}" "bool multiscatter" true'


def look_without(look, ids):
    """Removes roughness from the look."""
    for i in ids:
        look = re.sub(rf'"float {re.escape(i)}" \S+', "", look)
    return look


def draw_sheet(stage, chosen, halves):
    """One row per material; above them pbrt's picture of the scene, and Restage's of the same file."""
    size = stage.options.size
    rows = list(sheet_rows(chosen))
    top = size + 20 if stage.options.scene else 0
    sheet = Image.new("RGB", (LABELS + size * len(ROUGHNESSES), top + 20 + size * len(rows)), "white")
    draw = ImageDraw.Draw(sheet)
    if stage.options.scene:
        pair = ([("pbrt-v4", reference(halves, size))] if halves else []) + [("the same file", stage.picture(stage.text))]
        for x, (name, picture) in enumerate(pair):
            draw.text((LABELS + size * x + 4, 4), name, fill="black")
            sheet.paste(picture, (LABELS + size * x, 20))
    for x, roughness in enumerate(ROUGHNESSES):
        draw.text((LABELS + size * x + 50, top + 4), f"{roughness:g}", fill="black")
    for y, (label, material, ids, more) in enumerate(rows):
        draw.text((4, top + 20 + size * y + size // 2 - 6), label, fill="black")
        for x, roughness in enumerate(ROUGHNESSES if ids else ROUGHNESSES[:1]):  # without one: a single ball
            values = " ".join(f'"float {i}" {roughness * (90 if i == "sigma" else 1):g}' for i in ids)
            picture = stage.render(material, f"{look_without(LOOKS.get(material, ''), ids)} {values} {more}")
            sheet.paste(picture, (LABELS + size * x, top + 20 + size * y))
        print(label.replace("\n", " "), flush=True)
    return sheet


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--restage", default=str(ROOT / "build/bin/restage"))
    parser.add_argument("--thumbnails", action="store_true", help="into plugins/materials/TYPE/thumbnail.jpg")
    parser.add_argument("--sheet", help="JPEG of all materials at five roughnesses")
    parser.add_argument("--spp", type=int, default=128)
    parser.add_argument("--size", type=int, default=128, help="of a ball [pixel]")
    parser.add_argument("--scene", type=Path, help="a pbrt-v4 file with a ball")
    parser.add_argument("--material", default="Material", help="the name of its material there")
    parser.add_argument("--reference", type=Path, nargs="+", default=[], help="EXR files of it by pbrt-v4")
    parser.add_argument("types", nargs="*")
    o = parser.parse_args()
    chosen = {m: f for m, f in materials(o.restage).items() if not o.types or m in o.types}
    with tempfile.TemporaryDirectory() as folder:
        stage = Stage(o, folder)
        if o.thumbnails:
            for material in chosen:
                place = ROOT / "plugins/materials" / material
                if place.is_dir():
                    stage.render(material, LOOKS.get(material, "")).save(place / "thumbnail.jpg", quality=88)
                    print(place / "thumbnail.jpg", flush=True)
        if o.sheet:
            draw_sheet(stage, chosen, o.reference).save(o.sheet, quality=85)


if __name__ == "__main__":
    main()
