#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A data set from one room: variations of the bundled scene in materials, layout, sky and camera, each with its picture,
guide images, instance labels and a JSON that lists the changes.

    python room_variations.py -o dataset --count 50             # one process
    python room_variations.py -o dataset --count 50 --ray       # the same files, frames spread over Ray's workers

Variation i of a seed is the same on any worker and in any order; existing ones are kept.
For each: 0007.png (denoised), 0007.exr (linear, with standard error, albedo, normal, depth, ids), 0007.npz (labels: index
into "things" of the JSON, uint16; depth; normal), 0007.json (written last: a variation without one is repeated).
"""
import argparse
import json
import os
import pathlib

import numpy as np

import restage

PAINTS = {"teal": (0.07, 0.17, 0.19), "brick": (0.35, 0.12, 0.08), "sage": (0.30, 0.36, 0.26), "ochre": (0.55, 0.36, 0.12),
          "chalk": (0.75, 0.73, 0.69), "ink": (0.05, 0.06, 0.11)}
TABLE_TOPS = [("as it is", None, {}), ("white lacquer", "coateddiffuse", {"reflectance": (0.72, 0.70, 0.66)}),
              ("steel", "conductor", {"use_reflectance": True, "reflectance": 0.55, "uroughness": 0.2, "vroughness": 0.2}),
              ("black plastic", "plastic", {"kd": (0.02, 0.02, 0.02), "roughness": 0.1})]
MOVABLE = ["Chair", "Chair 2", "Chair 3", "Plant"]


def overlaps(a, b, gap=0.01):
    """Whether boxes (2, 3) are closer than the gap."""
    return bool(np.all(a[0] < b[1] + gap) and np.all(b[0] < a[1] + gap))


def place(session, thing, rng, obstacles, room, tries=30):
    """Moves and turns a thing on the floor to a free place. Returns the change, or None if there is no place.

    Parts are separate boxes, so that a chair fits below a table, whose top and legs are boxes."""
    for _ in range(tries):
        by = np.array([*rng.normal(0, 0.45, 2), 0.0])
        turn = float(rng.uniform(-180, 180))
        thing.move(by)
        thing.rotate(turn)
        parts = [part.bounds for part in thing.objects]
        inside = all((p[0, :2] > room[0, :2]).all() and (p[1, :2] < room[1, :2]).all() for p in parts)
        if inside and not any(overlaps(p, o) for p in parts for o in obstacles):
            return {"moved_by": by.round(4).tolist(), "turned_by": round(turn, 2)}
        thing.rotate(-turn)
        thing.move(-by)
    return None


def vary(session, rng):
    """Changes the room; returns the changes, for the JSON."""
    changes = {}
    paint = rng.choice(list(PAINTS))
    session.materials["Wall paint"]["reflectance"] = PAINTS[paint]
    cushion = rng.uniform(0.05, 0.6, 3).round(3)
    session.materials["Cushion wool"]["reflectance"] = cushion
    name, kind, values = TABLE_TOPS[rng.integers(len(TABLE_TOPS))]
    if kind:
        session.find("Table").set_material(session.add_material(name, kind, **values))
    changes["materials"] = {"Wall paint": str(paint), "Cushion wool": cushion.tolist(), "Table": name}

    things = [session.find(name) for name in MOVABLE if name in session.groups]
    floor = np.array(session.find("Floor").bounds)
    room = floor + np.array([[0.05, 0.05, 0], [-0.05, -0.05, 0]])
    changes["layout"] = {}
    for thing in things:
        mine = {o.id for o in thing.objects}
        obstacles = [o.bounds for o in session.objects
                     if o.id not in mine and not o.hidden and np.ptp(o.bounds[:, 2]) > 0.03  # no rugs, no floor
                     and o.bounds[1, 2] > 0.03 and not (np.ptp(o.bounds[:, :2], axis=0) > 0.9 * np.ptp(room[:, :2], axis=0)).all()]
        done = place(session, thing, rng, obstacles, room)
        if done:
            changes["layout"][thing.name] = done
    if rng.random() < 0.3:
        session.find("Vase").remove()
        changes["layout"]["Vase"] = "removed"

    strength, rotation, sunlight = (round(float(x), 3) for x in rng.uniform((0.5, -180, 0), (1.5, 180, 1.5)))
    session.set_sky(strength=strength, rotation=rotation)
    sun = session.lights["Sun"]
    sun.value = np.array(sun.value) * sunlight
    changes["sky"] = {"strength": strength, "rotation": rotation, "sun": sunlight}

    camera = session.camera
    eye = np.array(camera.position) + rng.normal(0, (0.25, 0.25, 0.1))
    target = np.array(session.find("Table").center) + (0, 0, 0.4) + rng.normal(0, 0.15, 3)
    camera.look_at(target, position=eye)
    camera.fov = round(camera.fov * float(rng.uniform(0.85, 1.1)), 2)
    changes["camera"] = {"position": eye.round(4).tolist(), "target": target.round(4).tolist(), "fov": camera.fov}
    return changes


def things_of(session):
    """The labelled things: top-level groups, and objects in no group."""
    return [g for g in session.groups if g.parent is None] + [o for o in session.objects if o.group is None]


def labels_of(picture, things):
    """uint16 (H, W): 1 + index of the thing, 0 = nothing; and how many pixels each has."""
    label = np.zeros(picture.object_id.shape, np.uint16)
    for number, thing in enumerate(things, 1):
        label[picture.mask(thing)] = number
    return label, np.bincount(label.ravel(), minlength=len(things) + 1)[1:]


def make(index, o):
    """Makes variation `index` unless it exists. Returns True if it was made."""
    name = o.output / f"{index:04}"
    settings = {"index": index, "seed": o.seed, "size": list(o.size), "samples": o.samples}
    done = name.with_suffix(".json")
    if done.exists() and json.loads(done.read_text())["settings"] == settings:
        return False
    with restage.open(restage.bundled_scene("demo")) as session:
        changes = vary(session, np.random.default_rng([o.seed, index]))
        picture = session.render(size=o.size, samples=o.samples, seed=index, threads=o.threads, denoise=o.denoise)
        things = things_of(session)
        label, pixels = labels_of(picture, things)
        picture.save(name.with_suffix(".png"))
        picture.save(name.with_suffix(".exr"))
        np.savez_compressed(name.with_suffix(".npz"), label=label, depth=picture.depth, normal=picture.normal.astype(np.float16))
        text = json.dumps({
            "settings": settings, "changes": changes,
            "camera_to_world": session.camera.transform.tolist(), "fov": session.camera.fov,
            "things": [{"label": n, "name": t.name, "pixels": int(p), "box": t.bounds.round(4).tolist()}
                       for n, (t, p) in enumerate(zip(things, pixels), 1)],
            "relative_error": picture.relative_error}, indent=1)
    part = name.with_suffix(".part")
    part.write_text(text)
    os.replace(part, done)  # the other files are complete once this one exists
    return True


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--size", type=lambda t: tuple(map(int, t.split("x"))), default=(320, 180), metavar="WxH")
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--no-denoise", dest="denoise", action="store_false")
    parser.add_argument("--ray", action="store_true", help="spread over the workers of Ray")
    o = parser.parse_args(arguments)
    o.output = o.output.absolute()
    o.output.mkdir(parents=True, exist_ok=True)
    o.threads = 1 if o.ray else 0

    def task(index):
        return make(index, o)
    results = restage.spread.each(task, range(o.count)) if o.ray else ((i, task(i)) for i in range(o.count))
    made = 0
    for index, new in results:
        made += new
        print(f"{index:04} {'made' if new else 'exists'}", flush=True)
    print(f"{made} made, {o.count - made} existed, in {o.output}")


if __name__ == "__main__":
    main()
