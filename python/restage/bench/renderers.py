# SPDX-License-Identifier: Apache-2.0
"""Renderers of a prepared scene. Each has `render(options, jobs, folder)`, jobs being (samples, seed), and yields
{samples, seed, cpu, wall, file}; cpu counts all threads and leaves out loading and compiling."""
import importlib.util
import json
import pathlib
import re
import resource
import shlex
import sys
import time

from . import scenes

HERE = pathlib.Path(__file__).parent
KINDS = ("restage", "mitsuba", "cycles", "pbrt")


class Restage:
    def __init__(self, program, scene):
        self.program, self.scene = program, scene

    def render(self, options, jobs, folder):
        for samples, seed in jobs:
            file, figures = folder / f"{samples}-{seed}.pfm", folder / "statistics.json"
            scenes.run([self.program, "-q", "render", self.scene, "-o", file, "--spp", samples, "--seed", seed, "--statistics", figures,
                        *options])
            s = json.loads(figures.read_text())
            # The first sample compiles; its own cost is taken from the others.
            cpu = s["cpu_seconds"] - s["cpu_seconds_first"]
            cpu = cpu * samples / (samples - 1) if samples > 1 else s["cpu_seconds_first"]
            yield {"samples": s["samples"], "seed": seed, "cpu": cpu + s["cpu_seconds_denoising"], "wall": s["seconds"], "file": file}


def export_for_peers(program, scene):
    """(our Mitsuba XML of the scene, what it lost)"""
    xml = scene.with_suffix(".xml")
    return xml, scenes.losses(scenes.run([program, "convert", scene, xml, "--set", "textures=absolute"]).stderr)


class Worker:
    """Mitsuba or Cycles, by a worker in another Python that reads that XML: one process for all jobs."""

    def __init__(self, kind, python, xml):
        self.kind, self.python, self.xml, self.losses = kind, python, xml, []

    def render(self, options, jobs, folder):
        done = scenes.run([self.python, HERE / f"{self.kind}_worker.py", self.xml, folder, *options, "--jobs", *(f"{n}:{seed}" for n, seed in jobs)])
        missing = len(jobs)
        for line in done.stdout.splitlines():
            row = json.loads(line) if line.startswith("{") else {}
            if "loss" in row and row["loss"] not in self.losses:
                self.losses.append(row["loss"])
            if "file" in row:
                yield {**row, "file": pathlib.Path(row["file"])}
                missing -= 1
        if missing:
            raise scenes.Failed(f"{self.kind}: {missing} of {len(jobs)} pictures are missing: " + "\n".join(done.stdout.splitlines()[-3:]))


class Pbrt:
    def __init__(self, scene, binary):
        self.binary, self.scene = binary, scene

    def render(self, options, jobs, folder):
        base = self.cpu(options, 1, 0, folder)[0] if jobs else 0  # loading, and one sample
        for samples, seed in jobs:
            cpu, wall, file = self.cpu(options, samples, seed, folder)
            yield {"samples": samples, "seed": seed, "cpu": max(cpu - base, 0) * samples / max(samples - 1, 1), "wall": wall, "file": file}

    def cpu(self, options, samples, seed, folder):
        file = folder / f"{samples}-{seed}.pfm"
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        scenes.run([self.binary, "--quiet", "--spp", samples, "--seed", seed, "--outfile", file, *options, self.scene])
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, time.monotonic() - start, file


def read_rows(path):
    """[(name, renderer, options)] of a file of rows."""
    rows = []
    for number, line in enumerate(pathlib.Path(path).read_text().splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        found = re.match(r"\s*([^:]+?)\s*:(.*)$", line)
        if not found:
            raise ValueError(f"{path}:{number}: a row is NAME: OPTIONS")
        options = shlex.split(found[2])
        renderer = options.pop(0)[1:] if options and options[0].startswith("@") else "restage"
        if renderer not in KINDS:
            raise ValueError(f"{path}:{number}: there is no renderer @{renderer}; known: {', '.join('@' + k for k in KINDS)}")
        if found[1] in (name for name, *_ in rows):
            raise ValueError(f"{path}:{number}: the name \"{found[1]}\" occurs twice")
        rows.append((found[1], renderer, options))
    if not rows:
        raise ValueError(f"{path}: no rows")
    return rows


def python_with(module, given):
    """The Python that can import it: the given one, or this one if it can; None = neither."""
    return given or (sys.executable if importlib.util.find_spec(module) else None)
