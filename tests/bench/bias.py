# SPDX-License-Identifier: Apache-2.0
"""The bias of each switch that has one, on each scene: a table in Markdown.

    python tests/bench/bias.py SCENE... [--size 96x64] [--spp 256] [--seeds 4]

Each row is the change of the mean luminance against --reference, in percent, with the standard error of that difference over
seeds: both renders of a pair use the same random numbers, so that only the switch differs."""
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
# Limits are multiples of the picture's mean luminance.
SWITCHES = {
    "limit direct, 20 means": lambda mean: ["--clamp-direct", str(20 * mean)],
    "limit indirect, 20 means": lambda mean: ["--clamp-indirect", str(20 * mean)],
    "limit indirect, 5 means": lambda mean: ["--clamp-indirect", str(5 * mean)],
    "ray offset 1e-4": lambda mean: ["--ray-epsilon", "1e-4"],
    "denoised, high": lambda mean: ["--reference", "--denoise", "high"],
    "photon maps on": lambda mean: ["--caustics", "on"],
    "RGB instead of wavelengths": None,  # --reference against --reference --spectral
}


def mean_of(scene, seed, options, size, spp):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "x.exr"
        subprocess.run([PROGRAM, "--quiet", "render", scene, "-o", out, "--size", size, "--spp", str(spp), "--seed", str(seed), *options],
                       check=True, capture_output=True)
        planes = exr_file.read(out)
        return float(sum(w * planes[c].astype(np.float64).mean() for w, c in zip(LUMINANCE, "RGB")))


def difference(pairs):
    """Mean and standard error of the relative differences, in percent."""
    changes = [100 * (a / b - 1) for a, b in pairs]
    return statistics.fmean(changes), statistics.stdev(changes) / len(changes) ** 0.5


def measure(scene, switches, size, spp, seeds):
    plain = [mean_of(scene, seed, ["--reference"], size, spp) for seed in range(seeds)]
    row = {}
    for name, options in switches.items():
        if options:
            pairs = [(mean_of(scene, seed, options(plain[seed]), size, spp), plain[seed]) for seed in range(seeds)]
        else:
            pairs = [(plain[seed], mean_of(scene, seed, ["--reference", "--spectral"], size, spp)) for seed in range(seeds)]
        row[name] = difference(pairs)
    return row


def table(rows, switches):
    lines = ["| scene | " + " | ".join(switches) + " |", "|---|" + "---|" * len(switches)]
    for scene, row in rows.items():
        lines.append(f"| {scene} | " + " | ".join(f"{bias:+.2f} ± {error:.2f}" for bias, error in (row[s] for s in switches)) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--size", default="96x64")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--json", type=pathlib.Path, help="also write the figures")
    parser.add_argument("--only", metavar="SWITCH", choices=SWITCHES, help="just this column")
    options = parser.parse_args()
    switches = {options.only: SWITCHES[options.only]} if options.only else SWITCHES
    rows = {}
    for scene in options.scenes:
        rows[scene.parent.name] = measure(scene, switches, options.size, options.spp, options.seeds)
        print(scene.parent.name, rows[scene.parent.name], file=sys.stderr)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1))
    print(table(rows, switches))


if __name__ == "__main__":
    main()
