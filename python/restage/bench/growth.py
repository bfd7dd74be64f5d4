# SPDX-License-Identifier: Apache-2.0
"""How speed and memory grow with triangles, instances, lights, resolution and depth: made scenes, tenfold steps, until the
budget would be exceeded."""
import json
import math
import os
import subprocess
import time

import numpy as np

HEAD = """LookAt 0 -3 2  0 0 0  0 0 1
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" {side} "integer yresolution" {side}
PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
Sampler "zsobol" "integer pixelsamples" 4
Integrator "volpath" "integer maxdepth" {depth}
WorldBegin
"""
SKY = 'LightSource "infinite" "rgb L" [ 0.5 0.5 0.5 ]\n'
LAMP = 'AreaLightSource "diffuse" "rgb L" [ {power} {power} {power} ] Shape "trianglemesh" "point3 P" [ {points} ] "integer indices" [ 0 1 2 0 2 3 ]\n'
FLOOR = 'Shape "trianglemesh" "point3 P" [ -2 -2 0 2 -2 0 2 2 0 -2 2 0 ] "integer indices" [ 0 1 2 0 2 3 ]\n'
DEEPEST = {"triangles": 20_000_000, "instances": 1_000_000, "lights": 100_000, "resolution": 4096, "depth": 64}
FIRST = {"triangles": 10_000, "instances": 1, "lights": 1, "resolution": 64, "depth": 1}


def hills(path, triangles):
    """A height field of about so many triangles, as PLY."""
    side = max(2, round(math.sqrt(triangles / 2)) + 1)
    x, y = np.meshgrid(np.linspace(-1.5, 1.5, side, dtype=np.float32), np.linspace(-1.5, 1.5, side, dtype=np.float32))
    points = np.stack([x, y, 0.1 * np.sin(9 * x) * np.cos(7 * y)], -1).astype("<f4")
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = np.empty(2 * len(corner), np.dtype([("n", "u1"), ("v", "<i4", 3)]))
    faces["n"] = 3
    faces["v"][0::2] = np.stack([corner, corner + 1, corner + side + 1], -1)
    faces["v"][1::2] = np.stack([corner, corner + side + 1, corner + side], -1)
    path.write_bytes(f"ply\nformat binary_little_endian 1.0\nelement vertex {side * side}\nproperty float x\nproperty float y\n"
                     f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode()
                     + points.tobytes() + faces.tobytes())
    return len(faces)


def grid(count):
    """Positions on a square, row by row."""
    side = math.ceil(math.sqrt(count))
    return [(-1.5 + 3 * (i % side + 0.5) / side, -1.5 + 3 * (i // side + 0.5) / side, 1.2 / side) for i in range(count)]


def make(kind, size, folder):
    """A scene file with `size` of `kind`, and the exact number."""
    side, depth = (size if kind == "resolution" else 128), (size if kind == "depth" else 5)
    text = [HEAD.format(side=side, depth=depth)]
    if kind == "triangles":
        size = hills(folder / "hills.ply", size)
        text += [SKY, 'Shape "plymesh" "string filename" "hills.ply"\n']
    elif kind == "instances":
        hills(folder / "hills.ply", 200)
        text += [SKY, FLOOR, 'ObjectBegin "o"\nShape "plymesh" "string filename" "hills.ply"\nObjectEnd\n']
        text += [f'AttributeBegin\nTranslate {x:.6g} {y:.6g} 0.2 Scale {s / 3:.6g} {s / 3:.6g} {s / 3:.6g}\nObjectInstance "o"\nAttributeEnd\n'
                 for x, y, s in grid(size)]
    elif kind == "lights":
        text += [FLOOR]
        for x, y, s in grid(size):
            h = s / 4
            points = " ".join(f"{a:.6g} {b:.6g} 0.5" for a, b in ((x - h, y - h), (x - h, y + h), (x + h, y + h), (x + h, y - h)))
            text += ["AttributeBegin\n", LAMP.format(power=4, points=points), "AttributeEnd\n"]
    else:
        hills(folder / "hills.ply", 10_000)
        text += [SKY, 'Shape "plymesh" "string filename" "hills.ply"\n']
    file = folder / "growth.pbrt"
    file.write_text("".join(text))
    return file, size


def measure_once(program, file, folder, options):
    """{rays_per_second, rays_per_cpu_second, memory [bytes], setup [s], wall [s]} or {failed}."""
    figures, start = folder / "growth.json", time.monotonic()
    command = [str(program), "-q", "render", str(file), "-o", str(folder / "growth.pfm"), "--spp", "4", "--statistics", str(figures), *options]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as child:
        said = child.stderr.read().decode(errors="replace")
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        return {"failed": (said.strip().splitlines() or [f"exit code {child.returncode}"])[-1]}
    s, wall = json.loads(figures.read_text()), time.monotonic() - start
    rays = s["rays"] + s["shadow_rays"]
    later = (s["cpu_seconds"] - s["cpu_seconds_first"]) * s["samples"] / (s["samples"] - 1)
    return {"rays_per_second": rays / max(s["seconds_shading"] + s["seconds_tracing"], 1e-9), "rays_per_cpu_second": rays / max(later, 1e-9),
            "memory": s["peak_memory"], "setup": used.ru_utime + used.ru_stime - s["cpu_seconds"], "wall": wall}


def measure(program, folder, budget, kinds=tuple(FIRST), options=(), say=print):
    """{kind: [{size, ...}]}. budget [s] is divided among the kinds; the first size of each is always measured."""
    result = {}
    for kind in kinds:
        points, size, start = [], FIRST[kind], time.monotonic()
        step = 10 if kind not in ("resolution", "depth") else 2
        while size <= DEEPEST[kind]:
            begun = time.monotonic()
            file, exact = make(kind, size, folder)
            points.append({"size": exact, **measure_once(program, file, folder, options)})
            took, left = time.monotonic() - begun, budget / len(kinds) - (time.monotonic() - start)
            say(f"growth: {exact:,} {kind}: {took:.1f} s")
            if "failed" in points[-1] or size == DEEPEST[kind] or took * step > left:  # at worst in proportion
                break
            size = min(size * step, DEEPEST[kind])
        result[kind] = points
    return result
