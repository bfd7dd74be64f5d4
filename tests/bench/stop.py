# SPDX-License-Identifier: Apache-2.0
"""Whether `restage render --error E` stops at E, on each scene: a table in Markdown.

    python tests/bench/stop.py SCENE... [--size 48x48] [--samples 32 128] [--seeds 8]

E is what renderings with other seeds claim after each of --samples (the median of three). The error at the stop is the spread of the seeds' pictures around their mean, in the measure of
--error (engine/render/film_error.hpp), relative to the luminance of a long rendering: in the mean of a few pictures a firefly would hide itself."""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scripts"))
import exr_file  # noqa: E402

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "build/bin/restage"
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def render(scene, size, seed, *options):
    """(luminance [height, width], samples per pixel, claimed relative error)"""
    with tempfile.TemporaryDirectory() as folder:
        out, file = pathlib.Path(folder, "x.exr"), pathlib.Path(folder, "x.json")
        subprocess.run([PROGRAM, "--quiet", "render", scene, "-o", out, "--size", size, "--seed", str(seed), "--statistics", file, *options],
                       check=True, capture_output=True)
        planes, figures = exr_file.read(out), json.loads(file.read_text())
    return sum(w * planes[c].astype(float) for w, c in zip(LUMINANCE, "RGB")), figures["samples"], figures["relative_error"]


def true_error(pictures, light):
    """Root mean square over pixels of the pictures' standard deviation over `light`; both are luminances."""
    return float(np.sqrt((np.var(pictures, axis=0, ddof=1) / (light + 0.01) ** 2).mean()))


def measure(scene, size, samples, seeds):
    """One row per number of samples: the error asked for, the true one at the stop and the mean of the claimed ones, and the samples of each seed."""
    light, _, _ = render(scene, size, 1000, "--spp", str(8 * max(samples)))
    rows = []
    for n in samples:
        error = statistics.median(render(scene, size, seed, "--spp", str(n))[2] for seed in range(1001, 1004))
        pictures, taken, claims = zip(*(render(scene, size, seed, "--error", str(error)) for seed in range(seeds)))
        rows.append({"asked": error, "true": true_error(pictures, light), "claimed": float(np.mean(claims)), "samples": taken})
    return rows


def table(rows):
    lines = ["| scene | E | true error at the stop / E | claimed / E | samples |", "|---|---|---|---|---|"]
    for scene, measured in rows.items():
        lines += [f"| {scene} | {r['asked']:.3f} | {r['true'] / r['asked']:.2f} | {r['claimed'] / r['asked']:.2f} | {min(r['samples'])} to {max(r['samples'])} |"
                  for r in measured]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--size", default="48x48")
    parser.add_argument("--samples", type=int, nargs="+", default=[32, 128])
    parser.add_argument("--seeds", type=int, default=8)
    options = parser.parse_args()
    rows = {}
    for scene in options.scenes:
        rows[scene.parent.name] = measure(scene, options.size, options.samples, options.seeds)
        print(table({scene.parent.name: rows[scene.parent.name]}).splitlines()[2:], file=sys.stderr)
    print(table(rows))


if __name__ == "__main__":
    main()
