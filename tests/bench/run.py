#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures Restage and writes docs/bench: bench.json (all figures), README.md (a table) and charts as SVG.

Scenes come from RESTAGE_SCENES; rows that need them are left out without.
Every figure is the median of its runs; ratios are of runs in one process. CPU time counts all threads.
"""
import argparse
import datetime
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import editor
import machine
import needs
import report

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ["kitchen", "veach-mis"]


class Bench:
    """Runs the measuring program; remembers how."""

    def __init__(self, args):
        self.restage = args.restage
        self.program = args.restage.parent / "restage_bench"
        self.options = ["--quick"] if args.quick else []
        self.quick, self.runs, self.out = args.quick, args.runs, args.out
        self.peers = [word for name in ("mitsuba", "cycles", "pbrt") if getattr(args, name) for word in (f"--{name}", getattr(args, name))]
        # References are valid for one commit only; a modified checkout recomputes its own each time.
        self.made = tempfile.TemporaryDirectory()
        commit = machine.commit()
        self.references = pathlib.Path(self.made.name) if commit.endswith("+") else ROOT / "build/bench-references" / commit
        if not self.program.exists():
            sys.exit(f"{self.program} is missing; build it: ninja restage_bench in the build folder")

    def measure(self, *command, runs=None, env=None):
        """One call of restage_bench: its JSON."""
        times = ["--runs", str(self.runs if runs is None else runs)]
        done = subprocess.run([str(self.program), *times, *self.options, *map(str, command)], capture_output=True, text=True,
                              env={**os.environ, **(env or {})})
        if done.returncode:
            sys.exit(f"restage_bench {' '.join(map(str, command))}: {done.stderr.strip()}")
        return json.loads(done.stdout)


def folder_of(variable):
    path = os.environ.get(variable)
    return pathlib.Path(path) if path else None


def rays(bench):
    return bench.measure("rays")


def edits(bench):
    return bench.measure("edits")


def copies(bench):
    return bench.measure("copies")


def actions(bench):
    return bench.measure("actions")


def features(bench):
    """Each variant with a cold cache once, for its machine code, and then measured warm; variants take turns."""
    rows = {}
    for variant in ("alone", "types", "features", "all"):
        with tempfile.TemporaryDirectory() as cache:
            env = {"XDG_CACHE_HOME": cache, "MESA_SHADER_CACHE_DIR": f"{cache}/mesa"}
            cold = bench.measure("features", variant, runs=0, env=env)
            code = sum(f.stat().st_size for f in pathlib.Path(cache, "mesa").rglob("*") if f.is_file() and f.name != "index")
            warm = bench.measure("features", variant, env=env)
        rows[variant] = {**warm, "machine_code_cache_bytes": code, "first_sample_wall_cold": cold["first_sample_wall"],
                         "first_sample_cpu_cold": cold["first_sample_cpu"]}
    return rows


def needs_of_scenes(bench):
    """Of the bundled scenes and all of RESTAGE_SCENES."""
    needs.PROGRAM = bench.restage
    files = [ROOT / f"scenes/{name}/{name}.pbrt" for name in ("cornell", "spheres", "demo")]
    others = folder_of("RESTAGE_SCENES")
    if others:
        files += sorted(others.glob("*/scene.pbrt"))
    return {needs.name_of(f): needs.measure(f, "64x64", 64, bench.runs) for f in (files[:1] if bench.quick else files)}


def multiscatter(bench):
    return bench.measure("multiscatter")


def first_image(bench):
    """The program itself, from process start; then where the time goes."""
    scenes = folder_of("RESTAGE_SCENES")
    if not scenes:
        return None
    scene = scenes / "kitchen/scene.pbrt"
    with tempfile.TemporaryDirectory() as folder:
        def once(cache):
            env = {**os.environ, "XDG_CACHE_HOME": cache, "MESA_SHADER_CACHE_DIR": f"{cache}/mesa"}
            before, start = os.times(), time.monotonic()
            subprocess.run([str(bench.restage), "-q", "render", str(scene), "-o", f"{folder}/image.exr", "--spp", "1", "--size",
                            "640x360", "--tracer", "embree"], check=True, env=env, stdout=subprocess.DEVNULL)
            wall, after = time.monotonic() - start, os.times()
            return {"wall": wall, "cpu": after.children_user + after.children_system - before.children_user - before.children_system}

        cold = [once(f"{folder}/cold{i}") for i in range(1 if bench.quick else bench.runs)]
        warm = [once(f"{folder}/cold0") for _ in range(bench.runs)]
        env = {"XDG_CACHE_HOME": f"{folder}/cold0", "MESA_SHADER_CACHE_DIR": f"{folder}/cold0/mesa"}
        return {"target_seconds": 5, "cold": cold, "warm": warm, "stages_warm": bench.measure("first-image", scene, env=env)}


def standard(bench):
    spp = {"cornell": 64, "room": 32, "room-flat": 32} if bench.quick else {"cornell": 256, "room": 128, "room-flat": 128}
    return {name: bench.measure("standard", name, "--folder", bench.references, "--reference-spp", spp[name]) for name in spp}


def chart(bench):
    """`restage bench` of the bundled scenes, with Mitsuba and so on where given; its page is written to the folder `chart`. Of the scenes of
    RESTAGE_SCENES only figures and charts are: their pictures are not ours to give."""
    small = ["--size", "64x64", "--samples", "4", "16", "--seeds", "2"] if bench.quick else ["--size", "96x96"]
    env, out = {**os.environ, "RESTAGE_PYTHON": sys.executable}, bench.out / "chart"

    def measure(folder, *arguments):
        subprocess.run([str(bench.restage), "bench", *arguments, *small, "-o", str(folder), *bench.peers], check=True, env=env, stdout=subprocess.DEVNULL)
        return json.loads((folder / "bench.json").read_text())

    figures = measure(out, "cornell", "demo", "--growth", "--budget", "20" if bench.quick else "60")
    others = folder_of("RESTAGE_SCENES")
    if others:
        with tempfile.TemporaryDirectory() as folder:
            figures["scenes"] |= measure(pathlib.Path(folder), *(str(others / name / "scene.pbrt") for name in SCENES))["scenes"]
            for name in SCENES:
                shutil.copy(pathlib.Path(folder, f"{name}-rel_mse-cpu.svg"), out)
    return figures


def editor_latency(bench):
    scenes = folder_of("RESTAGE_SCENES")
    return editor.measure(bench.restage, scenes / "kitchen/scene.pbrt", (0.73, 0.72)) if scenes else None


ROWS = {"rays": rays, "edits": edits, "copies": copies, "actions": actions, "features": features, "needs": needs_of_scenes, "multiscatter": multiscatter, "first_image": first_image, "standard": standard, "chart": chart, "editor": editor_latency}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--restage", type=pathlib.Path, default=ROOT / "build/bin/restage", help="the program; restage_bench is in the same folder")
    parser.add_argument("--out", type=pathlib.Path, help="default docs/bench; with --quick build/bench-quick")
    parser.add_argument("--only", nargs="+", choices=ROWS, help="measure these rows again, keep the others of bench.json")
    parser.add_argument("--runs", type=int, help="of each figure (default 3; 1 with --quick)")
    parser.add_argument("--quick", action="store_true", help="a quick run of two minutes: fewer runs, samples and scenes")
    parser.add_argument("--mitsuba", metavar="PYTHON", help="Python that has mitsuba, for the row chart")
    parser.add_argument("--cycles", metavar="PYTHON", help="Python that has bpy (Cycles), likewise")
    parser.add_argument("--pbrt", metavar="BINARY", help="pbrt-v4, likewise")
    parser.add_argument("--report", action="store_true", help="measure nothing, write table and charts from bench.json")
    args = parser.parse_args()
    args.runs = args.runs or (1 if args.quick else 3)
    args.out = args.out or ROOT / ("build/bench-quick" if args.quick else "docs/bench")
    args.out.mkdir(parents=True, exist_ok=True)
    file = args.out / "bench.json"
    keep = args.only or args.report
    data = json.loads(file.read_text()) if keep and file.exists() else {"rows": {}}
    if not args.report:
        bench = Bench(args)
        described, commit, begun = machine.describe(args.restage), machine.commit(), time.monotonic()
        for name in args.only or ROWS:
            start = time.monotonic()
            with machine.Watch() as watch:
                figures = ROWS[name](bench)
            if figures is None:
                print(f"{name}: left out, RESTAGE_SCENES is not set", flush=True)
                data["rows"].pop(name, None)
                continue
            data["rows"][name] = {"date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
                                  "commit": commit, "machine": described, "load_before": watch.load_before,
                                  "others_cpu": watch.others_cpu, "quick": args.quick, "figures": figures}
            print(f"{name}: measured in {time.monotonic() - start:.0f} s", flush=True)
            file.write_text(json.dumps(data, indent=1) + "\n")
        print(f"all: {time.monotonic() - begun:.0f} s")
    report.write(data, args.out)
    print(f"written: {args.out}")


if __name__ == "__main__":
    main()
