# SPDX-License-Identifier: Apache-2.0
"""What removing the features that a scene lacks saves: a table in Markdown.

    python tests/bench/needs.py SCENE... [--size 96x96] [--samples 16] [--runs 3]

Each scene is rendered as usual, and with shaders that keep every feature (--all-features, which --help does not list), in turns. Kernels, SPIR-V,
machine code (Mesa's cache, compressed) and the CPU time to the first sample are of one run with empty caches; CPU time per sample is the median of later runs. The pictures have other
noise, but must agree: z is the difference of a pair in its standard errors, root mean square over pixels."""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scripts"))
import exr_file  # noqa: E402

LUMINANCE = (0.2126, 0.7152, 0.0722)
PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "build/bin/restage"


def bytes_below(folder):
    return sum(f.stat().st_size for f in folder.rglob("*") if f.is_file() and f.name != "index")


class Variant:
    def __init__(self, scene, size, folder, everything):
        self.scene, self.size, self.folder = scene, size, folder
        self.env = {**os.environ, "XDG_CACHE_HOME": str(folder), "MESA_SHADER_CACHE_DIR": str(folder / "mesa")}
        self.options = ["--all-features"] if everything else []

    def render(self, samples):
        """(statistics, planes of the picture)"""
        out, figures = self.folder / "x.exr", self.folder / "x.json"
        subprocess.run([PROGRAM, "--quiet", "render", self.scene, "-o", out, "--size", self.size, "--spp", str(samples), "--tracer", "embree", "--statistics", figures, *self.options],
                       check=True, env=self.env, capture_output=True)
        return json.loads(figures.read_text()), exr_file.read(out)

    def compile(self):
        """Kernels [number], spirv, machine [byte] and first [CPU-s] of a run with empty caches."""
        figures, _ = self.render(1)
        spirv = self.folder / "restage/spirv"
        return {"kernels": sum(f.is_file() for f in spirv.rglob("*")), "spirv": figures["shader_bytes"], "machine": bytes_below(self.folder / "mesa"),
                "scene": figures["scene_bytes"], "first": figures["cpu_seconds_first"]}


def per_sample(figures):
    """CPU seconds of a sample per pixel, the first left out: it compiles."""
    return (figures["cpu_seconds"] - figures["cpu_seconds_first"]) / (figures["samples"] - 1)


def rms_z(a, b):
    """Of two pictures' luminances, over pixels that have noise."""
    difference = sum(w * (a[c].astype(float) - b[c]) for w, c in zip(LUMINANCE, "RGB"))
    variance = a["stderr.Y"].astype(float) ** 2 + b["stderr.Y"].astype(float) ** 2
    return float(np.sqrt(np.mean(difference[variance > 0] ** 2 / variance[variance > 0])))


def measure(scene, size, samples, runs):
    """{needed: ..., all: ...}: see Variant.compile; `cpu`: seconds per sample; `z`: see above."""
    with tempfile.TemporaryDirectory() as a, tempfile.TemporaryDirectory() as b:
        variants = {"needed": Variant(scene, size, pathlib.Path(a), False), "all": Variant(scene, size, pathlib.Path(b), True)}
        rows = {name: variant.compile() for name, variant in variants.items()}
        cpu = {name: [] for name in variants}
        pictures = {}
        for _ in range(runs):
            for name, variant in variants.items():
                figures, pictures[name] = variant.render(samples + 1)
                cpu[name].append(per_sample(figures))
        for name in variants:
            rows[name]["cpu"] = statistics.median(cpu[name])
        return {**rows, "z": rms_z(pictures["needed"], pictures["all"])}


def name_of(scene):
    return scene.parent.name if scene.stem == "scene" else scene.stem


def table(rows):
    lines = ["| scene | kernels | SPIR-V KiB | machine code KiB | first sample, CPU-s | CPU ms per sample | its ratio | scene KiB | z |",
             "|---|---|---|---|---|---|---|---|---|"]
    for name, row in rows.items():
        n, a = row["needed"], row["all"]
        lines.append(f"| {name} | {n['kernels']} | {n['spirv'] / 1024:.0f} / {a['spirv'] / 1024:.0f} | {n['machine'] / 1024:.0f} / {a['machine'] / 1024:.0f} | "
                     f"{n['first']:.1f} / {a['first']:.1f} | {1000 * n['cpu']:.1f} / {1000 * a['cpu']:.1f} | {n['cpu'] / a['cpu']:.2f} | {n['scene'] / 1024:.0f} | "
                     f"{row['z']:.2f} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--size", default="96x96")
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    rows = {}
    for scene in options.scenes:
        name = name_of(scene)
        rows[name] = measure(scene, options.size, options.samples, options.runs)
        print(table({name: rows[name]}).splitlines()[2], file=sys.stderr, flush=True)
    print(table(rows))


if __name__ == "__main__":
    main()
