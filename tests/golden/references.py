#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the reference scenes and holds them against pbrt-v4's pictures: means, z-test, one line a scene.

Scenes come from RESTAGE_SCENES, references (two independent halves each) from RESTAGE_REFERENCES.
    references.py [--spp 256] [--out DIR] [--v3] [--spectral] [SCENE ...]
Writes DIR/<scene>.exr, .z.png, .diff.png and DIR/references.json. Exit code 1 when a scene fails to render.
"""
import argparse
import json
import os
import pathlib
import struct
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def exr_size(path):
    """Width and height of an EXR file from its data window."""
    head = path.read_bytes()[:4096]
    at = head.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
    x0, y0, x1, y1 = struct.unpack("<4i", head[at:at + 16])
    return x1 - x0 + 1, y1 - y0 + 1


def run(command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", help="names; default: all that have references")
    parser.add_argument("--restage", default=ROOT / "build/bin/restage")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/references")
    parser.add_argument("--v3", action="store_true", help="render scene-v3.pbrt where there is one")
    parser.add_argument("--tracer", default="embree")
    parser.add_argument("--spectral", action="store_true")
    args = parser.parse_args()
    scenes, references = (pathlib.Path(os.environ[v]) for v in ("RESTAGE_SCENES", "RESTAGE_REFERENCES"))
    names = args.scenes or sorted(p.name[:-6] for p in references.glob("*.1.exr"))
    args.out.mkdir(parents=True, exist_ok=True)
    print(f"{'scene':18} {'seconds':>8} {'lum %':>7} {'R %':>7} {'G %':>7} {'B %':>7} {'relMSE':>8} {'blocks |z|<3':>12} {'z rms':>6}")
    rows, failed = [], 0
    for name in names:
        scene = scenes / name / ("scene-v3.pbrt" if args.v3 else "scene.pbrt")
        if args.v3 and not scene.exists():
            continue
        halves = [references / f"{name}.{i}.exr" for i in (1, 2)]
        w, h = exr_size(halves[0])
        out = args.out / (name + ("-v3" if args.v3 else ""))
        render = run([args.restage, "render", scene, "-o", f"{out}.exr", "--spp", args.spp, "--size", f"{w}x{h}",
                      "--tracer", args.tracer, *(["--spectral"] if args.spectral else [])])
        if render.returncode:
            print(f"{name:18} {render.stderr.strip().splitlines()[-1]}")
            failed += 1
            continue
        seconds = float(render.stderr.split(" spp in ")[-1].split(" s,")[0])
        # The fractions of blocks are for the reader of the table: no threshold here.
        compare = run([args.restage, "compare", f"{out}.exr", "--reference-halves", *halves, "--clip", "0.001", "--json",
                       "--min-blocks", "0", "--z-map", f"{out}.z.png", "--diff", f"{out}.diff.png"])
        if compare.returncode:
            print(f"{name:18} {compare.stderr.strip()}")
            failed += 1
            continue
        c = json.loads(compare.stdout)
        a, b = c["mean_a"], c["mean_b"]
        channel = [100 * (x / y - 1) for x, y in zip(a, b)]
        luminance = 100 * (c["luminance_a"] / c["luminance_b"] - 1)
        z = c["z_test"]
        print(f"{name:18} {seconds:8.1f} {luminance:+7.2f} {channel[0]:+7.2f} {channel[1]:+7.2f} {channel[2]:+7.2f} "
              f"{c['rel_mse']:8.4f} {100 * z['share_passing']:12.2f} {z['rms']:6.2f}", flush=True)
        rows.append({"scene": out.name, "spp": args.spp, "width": w, "height": h, "seconds": seconds,
                     "luminance_percent": luminance, "channel_percent": channel, "rel_mse": c["rel_mse"], "z_test": z})
    (args.out / "references.json").write_text(json.dumps(rows, indent=1))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
