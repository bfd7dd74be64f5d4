# SPDX-License-Identifier: Apache-2.0
"""Measures error against samples and CPU time, and writes bench.json, charts and index.html.

Each configuration (a row of --rows) renders each scene with several seeds and sample counts. `restage bench a.pbrt --mitsuba python3`
compares with Mitsuba on the same scene, through our exporter."""
import argparse
import datetime
import math
import os
import pathlib
import platform
import re
import sys
import tempfile
import time

try:
    import numpy  # noqa: F401
except ImportError:
    sys.exit(f"restage: error: bench needs numpy, which {sys.executable} does not have; install it there (pip install numpy), "
             "or let RESTAGE_PYTHON name a Python that has it")

from .. import Error, _program, bundled_scene
from . import errors, growth, page, renderers, scenes

HERE = pathlib.Path(__file__).parent


def machine(program):
    cpuinfo = pathlib.Path("/proc/cpuinfo")
    found = re.search(r"^model name\s*:\s*(.*)", cpuinfo.read_text(), re.M) if cpuinfo.exists() else None
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return {"cpu": found[1] if found else platform.processor(), "cores": cores, "system": platform.platform(terse=True),
            "restage": scenes.run([program, "--version"]).stdout.split()[-1]}


def references(renderer, options, args, folder):
    """Parts of a reference by this renderer, of seeds that no measurement uses."""
    jobs = [(max(1, args.reference_spp // args.reference_parts), 1_000_000 + i) for i in range(args.reference_parts)]
    return [errors.read_pfm(r["file"]) for r in renderer.render(options, jobs, folder)]


def measure_scene(program, scene, args, folder, say):
    """(figures of a scene, its pictures by name)"""
    prepared, lost = scenes.prepare(program, scene, folder, args.size)
    notes = [f"not as in the file, for all renderers: {line}" for line in lost]
    restage = renderers.Restage(program, prepared)
    known = {"restage": restage}
    peers = {k: python for k, python in (("mitsuba", args.mitsuba), ("cycles", args.cycles)) if python and any(k == r for _, r, _ in args.rows)}
    if peers:
        xml, lost = renderers.export_for_peers(program, prepared)
        known |= {kind: renderers.Worker(kind, python, xml) for kind, python in peers.items()}
        notes += [f"for {' and '.join(peers)}: {line}" for line in lost]
    if args.pbrt:
        known["pbrt"] = renderers.Pbrt(prepared, args.pbrt)
    given = [errors.read_pfm(f) for f in args.reference]
    ours = errors.Reference(given or references(restage, [], args, folder))
    by_renderer, pictures, configurations = {"restage": ours}, {"reference": ours.mean}, []
    for name, kind, options in args.rows:
        if kind not in known:
            say(f"{scene.stem}: {name}: left out, {kind} is not given")
            continue
        if kind not in by_renderer:
            by_renderer[kind] = ours if given else errors.Reference(references(known[kind], options, args, folder))
        reference, runs, start = by_renderer[kind], [], time.monotonic()
        jobs = [(n, seed) for n in args.samples for seed in range(args.seeds)]
        for run in known[kind].render(options, jobs, folder):
            picture = errors.read_pfm(run.pop("file"))
            run["rel_mse"], run["trimmed"] = reference.errors(picture)
            runs.append(run)
        pictures[f"{name}, {runs[-1]['samples']} samples"] = picture
        row = {"name": name, "renderer": kind, "options": options, "runs": runs, "curve": errors.curve(runs, "rel_mse"),
               "curve_trimmed": errors.curve(runs, "trimmed"), "reference_noise": reference.noise()}
        if kind != "restage" and not given:
            row["bias"] = max(ours.errors(reference.mean)[0] - reference.noise(), 0)
        configurations.append(row)
        say(f"{scene.stem}: {name}: {time.monotonic() - start:.1f} s")
    notes += [f"for {kind}: {line}" for kind in peers for line in known[kind].losses]
    last = [c["curve"][-1]["error"] for c in configurations]
    target = args.target or max(min((e for e in last if e > 0), default=math.nan), 0)
    what = f"{len(given)} given pictures" if given else f"{args.reference_spp} samples in {args.reference_parts} parts"
    return {"width": args.size[0], "height": args.size[1], "seeds": args.seeds, "reference": what, "reference_noise": ours.noise(),
            "target_error": target, "configurations": configurations, "notes": notes}, pictures


def size(text):
    found = re.fullmatch(r"(\d+)x(\d+)", text)
    if not found or not int(found[1]) or not int(found[2]):
        raise argparse.ArgumentTypeError(f"\"{text}\" is not a size such as 256x256")
    return int(found[1]), int(found[2])


def parse(arguments):
    parser = argparse.ArgumentParser(prog="restage bench", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="scene file, or the name of a bundled scene: cornell, demo or spheres")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("restage-bench"), help="folder of the page (default: %(default)s)")
    parser.add_argument("--rows", type=pathlib.Path, default=HERE / "rows.txt", help="file of configurations, NAME: OPTIONS a line (default: %(default)s)")
    parser.add_argument("--size", type=size, default=(256, 256), metavar="WxH", help="of the pictures (default: 256x256)")
    parser.add_argument("--samples", type=int, nargs="+", default=[4, 16, 64], help="a pixel; squares suit all samplers (default: 4 16 64)")
    parser.add_argument("--seeds", type=int, default=5, help="of each point (default: %(default)s)")
    parser.add_argument("--reference", type=pathlib.Path, nargs="+", default=[], help=".pfm pictures of one scene, of other seeds; two or more tell their noise")
    parser.add_argument("--reference-spp", type=int, help="of references rendered here (default: 16 times the most samples)")
    parser.add_argument("--reference-parts", type=int, default=4, help="independent parts of a reference (default: %(default)s)")
    parser.add_argument("--target", type=float, help="relMSE for the column \"CPU-s to\" (default: the least that was reached)")
    parser.add_argument("--mitsuba", metavar="PYTHON", help="Python that has mitsuba (default: this one, if it has)")
    parser.add_argument("--cycles", metavar="PYTHON", help="Python that has bpy, likewise")
    parser.add_argument("--pbrt", metavar="BINARY", help="pbrt-v4")
    parser.add_argument("--growth", nargs="*", choices=growth.FIRST, metavar="KIND", help=f"measure growth, of all or some of {', '.join(growth.FIRST)}")
    parser.add_argument("--budget", type=float, default=120, help="seconds for growth (default: %(default)s)")
    args = parser.parse_args(arguments)
    if not args.scenes and args.growth is None:
        parser.error("a SCENE, or --growth, is needed")
    if args.reference and len(args.scenes) != 1:
        parser.error("--reference is for one scene")
    if min(args.samples) < 2 or args.seeds < 1 or args.reference_parts < 1:
        parser.error("--samples must be at least 2, --seeds and --reference-parts at least 1")
    args.samples = sorted(set(args.samples))
    args.reference_spp = args.reference_spp or 16 * args.samples[-1]
    args.mitsuba, args.cycles = renderers.python_with("mitsuba", args.mitsuba), renderers.python_with("bpy", args.cycles)
    args.rows = renderers.read_rows(args.rows)
    return args


def main(arguments=None):
    try:
        args = parse(arguments)
        program = _program()
        data = {"date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"), "machine": machine(program), "scenes": {}, "growth": {}}
        pictures = {}

        def say(text):
            print(text, file=sys.stderr, flush=True)

        with tempfile.TemporaryDirectory(prefix="restage-bench-") as made:
            folder = pathlib.Path(made)
            for number, text in enumerate(args.scenes):
                scene = pathlib.Path(text)
                if not scene.exists() and not scene.suffix:
                    scene = bundled_scene(text)
                name = scene.stem if scene.stem != "scene" else scene.resolve().parent.name
                name = name if name not in data["scenes"] else f"{name} {number + 1}"
                data["scenes"][name], pictures[name] = measure_scene(program, scene, args, folder / str(number), say)
            if args.growth is not None:
                data["growth"] = growth.measure(program, folder, args.budget, tuple(args.growth) or tuple(growth.FIRST), say=say)
        page.write(data, pictures, args.output)
        print(args.output / "index.html")
    except (scenes.Failed, Error, OSError, ValueError) as e:
        sys.exit(f"restage bench: {e}")


if __name__ == "__main__":
    main()
