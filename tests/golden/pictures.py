#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the z-test pictures of docs/accuracy.md: each picture beside the map of its 8x8 blocks.

    pictures.py [--from DIR] [--out docs/images] [SCENE ...]
DIR is what references.py wrote: <scene>.exr and <scene>.z.png. Writes accuracy-<scene>.png. A picture of a scene may only be
shown if its licence allows (LICENSE.txt in its folder), with credit if required: see SCENES.
"""
import argparse
import pathlib
import sys

import numpy as np
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/scripts"))
import exr_file  # noqa: E402

# Scene: its author and licence. docs/accuracy.md gives the credit.
SCENES = {"coffee": "cekuhnen, CC-BY 3.0", "cornell-box": "Benedikt Bitterli, CC0", "material-testball": "Benedikt Bitterli, CC0",
          "veach-bidir": "Benedikt Bitterli, CC0"}
BLOCK, GAP = 8, 8


def srgb(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=list(SCENES), help="default: all that may be shown")
    parser.add_argument("--from", dest="source", type=pathlib.Path, default=ROOT / "build/references")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/images")
    args = parser.parse_args()
    for name in args.scenes:
        if name not in SCENES:
            parser.error(f"{name}: look at its LICENSE.txt, then enter it in SCENES")
        layers = exr_file.read(args.source / f"{name}.exr")
        picture = np.stack([layers[c] for c in "RGB"], -1)
        blocks = np.asarray(Image.open(args.source / f"{name}.z.png").convert("RGB"))
        height, width, _ = picture.shape
        z_map = blocks.repeat(BLOCK, 0).repeat(BLOCK, 1)[:height, :width]
        gap = np.full((height, GAP, 3), 255, np.uint8)
        both = np.concatenate([np.uint8(srgb(picture) * 255 + 0.5), gap, z_map], 1)
        file = args.out / f"accuracy-{name}.png"
        Image.fromarray(both).save(file, optimize=True)
        print(f"{file}: {file.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
