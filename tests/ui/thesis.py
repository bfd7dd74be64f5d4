# SPDX-License-Identifier: Apache-2.0
"""Run manually: the edit of the thesis that this project follows, with a real mouse and real keys under Xvfb. "Country Kitchen"
becomes a different kitchen (island removed, table longer, chairs, places and the lamp cloned, walls repainted), and then the
same room in other materials. Only pointing, dragging, keys and typed numbers are used; where a person would check the position
of a thing, the script reads the editor's state (--probe).

    build/venv/bin/python tests/ui/thesis.py RESTAGE SCENES/kitchen/scene.pbrt OUT

writes before.png, kitchen.png and materials.png (the projects by `restage render`, denoised), the projects, and
prints the gestures, how long the script took, and how long a person would, by the keystroke-level model (S. Card, T. Moran,
A. Newell, "The keystroke-level model for user performance time with interactive systems", CACM 23(7), 1980)."""
import pathlib
import struct
import subprocess
import sys
import tempfile
import time
import zlib

import numpy as np

from desk import Desk, Editor

# Card, Moran, Newell 1980, Fig. 1 [s]: a key of a non-secretary typist, pointing, pressing or releasing a button, a hand from
# mouse to keyboard or back, making up one's mind.
KEY, POINT, BUTTON, HAND, MIND = 0.28, 1.1, 0.1, 0.4, 1.35
LOOK = 2.0  # ours: seeing what a drag did before the next one


class Hand:
    """An Editor's mouse and keys that count gestures and the time they would take a person."""

    def __init__(self, editor):
        self.e, self.gestures, self.seconds, self.on_keys = editor, [], 0.0, False

    def note(self, what, seconds, keys=False):
        self.gestures.append(what)
        self.seconds += MIND + seconds + (HAND if keys != self.on_keys else 0)
        self.on_keys = keys

    def state(self):
        return self.e.state()

    def names(self):
        return sorted(item["name"] for item in self.state()["selection"])

    def click(self, where, expect=None, keys=()):
        """`expect`: the material of the picked object."""
        before = self.state()["selection"]
        self.e.click(where, keys=keys)
        self.note(f"{'+'.join([*keys, 'click'])} {expect or where}", POINT + 2 * BUTTON + KEY * len(keys))
        if expect:
            self.e.wait(lambda s: s["selection"] != before and s["selection"] and s["selection"][-1]["material"] == expect,
                        f"a {expect} under the mouse at {where}", 10)

    def key(self, *keys):
        for key in keys:
            before = self.steps()
            self.e.key(key)
            self.note(f"key {key}", KEY * (1 + key.count("+")), keys=True)
            if key in ("Delete", "ctrl+g"):
                self.e.wait(lambda s: s["history"]["position"] > before, key, 10)
        time.sleep(0.6)  # frames may be slow; a person also looks

    def steps(self):
        return self.state()["history"]["position"]

    def pull(self, start, toward, good, keys=(), what="drag"):
        """Drags from a point in a direction on the screen (pixels) until good(state) is 0 or has changed its sign, then back in smaller
        steps, as by hand and eye. `good` is positive until it is done."""
        at = np.array(self.e.point(start), float)
        step = np.array(toward, float)
        before = self.steps()
        self.e.move(tuple(int(v) for v in at))
        for key in keys:
            self.e.desk.xdotool("keydown", key)
        self.e.desk.xdotool("mousedown", 1)
        time.sleep(0.15)
        at += step / max(np.linalg.norm(step), 1e-9) * 8  # beyond the threshold of a click
        last = None
        for _ in range(90):
            self.e.desk.xdotool("mousemove", int(round(at[0])), int(round(at[1])))
            time.sleep(0.12)
            value = good(self.state())
            if abs(value) < 0.01 or (last is not None and last * value < 0 and np.linalg.norm(step) <= 1.01):
                break
            if last is not None and last * value < 0:
                step = -step / 2
            last = value
            at += step
        else:
            raise AssertionError(f"{what}: not reached, {value:.3f} remains")
        self.e.desk.xdotool("mouseup", 1)
        for key in keys:
            self.e.desk.xdotool("keyup", key)
        self.e.wait(lambda s: s["history"]["position"] == before + 1, f"{what} as one step", 10)
        self.note(what, 2 * POINT + 2 * BUTTON + KEY * len(keys) + LOOK)

    def slide(self, point, by, what, copy=False):
        """Drags the selected thing itself from `point` (world) over the floor, by so much."""
        start = self.middle()
        a = self.screen(point)
        b = self.screen(np.array(point) + by)
        before = self.steps()
        self.e.drag(a, b, keys=["shift"] if copy else [], steps=16)
        self.e.wait(lambda s: s["history"]["position"] == before + 1, f"{what} as one step", 10)
        self.note(what, 2 * POINT + 2 * BUTTON + (KEY if copy else 0) + LOOK)
        moved = self.middle() - start
        assert np.linalg.norm(moved - by) < 0.12, f"{what}: moved by {moved}, not {by}"

    def middle(self):
        lower, upper = self.box()
        return (lower + upper) / 2

    def box(self):
        items = self.state()["selection"]
        return np.min([i["lower"] for i in items], 0), np.max([i["upper"] for i in items], 0)

    def screen(self, point):
        return self.e.point(("picture", *project(point)))

    def preset(self, name, where):
        """Finds a material in the library by its name and drags it to this place."""
        if "materials.search" not in self.state()["marks"]:
            self.click("tab.Materials")
        self.e.click("materials.search")
        self.e.key("ctrl+a")
        self.e.type(name)
        self.note(f"search {name}", POINT + 2 * BUTTON + HAND + KEY * (len(name) + 2))
        before = self.steps()
        self.e.drag(f"materials.{name}", where, steps=12)
        self.e.wait(lambda s: s["history"]["position"] > before, f"{name} given", 20)
        self.note(f"drag {name}", 2 * POINT + 2 * BUTTON)


# The kitchen's camera, from its file: world to camera.
TO_CAMERA = np.array([[0.89874, -0.0182716, -0.4381, 0], [1.86265e-9, 0.999132, -0.0416703, 0],
                      [-0.438481, -0.0374507, -0.89796, 0], [0.600822, -1.63678, 4.06504, 1]]).T
HALF = np.tan(np.radians(35.9834 / 2))


LAMP = ("picture", 0.739, 0.30)
WALL = ("picture", 0.936, 0.484)
LONGER = 1.42  # the table, and the displacement of copies of the things at and on it


def project(point):
    """Its position in the kitchen camera's picture: (0,0) top left, (1,1) bottom right."""
    x, y, z, _ = TO_CAMERA @ [*point, 1]
    return 0.5 + x / z / HALF / (16 / 9) / 2, 0.5 - y / z / HALF / 2


def another_kitchen(hand):
    # The island and everything on it.
    hand.click(("picture", 0.385, 0.85), "SmallWorktop")
    hand.key("c")
    hand.e.wait(lambda s: s["selected"] == 43, "the whole island", 5)
    hand.key("Delete")
    hand.e.wait(lambda s: s["counts"]["instances"] == 299 - 43, "no island")

    # A copy of each chair at the near end of the table, nearer.
    for at, material, count in (((1.09, 1.01, -1.27), "TableCross", 18), ((-0.555, 1.03, -1.15), "TableCross", 14)):
        hand.click(("picture", *project(at)), material)
        assert hand.state()["selected"] >= count, hand.names()
        hand.slide(at, np.array([0, 0, LONGER]), "another chair", copy=True)

    # The table, longer, and its far end at the window again.
    hand.click(("picture", *project((0.15, 0.86, -0.80))), "Tabletop")
    assert hand.names() == ["TableCross 46", "TableCross 47", "TableCross 48", "Tabletop"], hand.names()
    hand.key("r")
    center, handle = (np.array(hand.e.point(mark), float) for mark in ("gizmo.center", "gizmo.z"))
    hand.pull("gizmo.z", (handle - center) / np.linalg.norm(handle - center) * 6,
              lambda s: 3.05 - (lambda b: b[1][2] - b[0][2])(hand.box()), what="the table longer")
    hand.key("w")
    lower, upper = hand.box()
    hand.slide((0.15, 0.86, upper[2] - 0.15), np.array([0, 0, -2.46 - lower[2]]), "the table to the window")

    # Four more places: what is on the table, but not the table.
    hand.click(("picture", *project((-0.16, 0.878, -1.12))), "Plates")
    hand.key("c")
    hand.slide((-0.16, 0.878, -1.12), np.array([0, 0, LONGER]), "four more places", copy=True)

    # Another lamp.
    hand.click(LAMP, "Lamp")
    hand.slide((0.19, 2.3, -1.6), np.array([0, 0, 1.3]), "another lamp", copy=True)

    # The wall with the window, and the others, from the library.
    hand.preset("Paint, foliage green", WALL)
    hand.preset("Egg shell, white", ("picture", 0.30, 0.13))


def other_materials(hand):
    hand.preset("Asphalt", ("picture", 0.724, 0.937))
    hand.preset("Paint, blue", ("picture", 0.13, 0.90))
    hand.preset("Marble, polished", ("picture", 0.07, 0.786))
    hand.preset("Marble, polished", ("picture", 0.385, 0.85))
    hand.preset("Cream", WALL)


def save(hand, path):
    hand.key("ctrl+s")
    hand.e.wait(lambda s: s["modal"] == "Save as", "the question where")
    hand.e.point("browser.name")
    hand.e.key("ctrl+a")
    hand.e.type(str(path))
    hand.e.key("Return")
    hand.note("name of the project", KEY * 12, keys=True)
    hand.e.wait(lambda s: s["path"] == str(path) and not s["modified"], "the saved project")


def edit(binary, scene, out, name, how):
    """Opens the scene, edits it, saves it; prints the effort."""
    project_file = out / f"{name}.restage"
    project_file.unlink(missing_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        desk = Desk(pathlib.Path(folder) / "desk", size=(1600, 900))
        editor = Editor(desk, binary, scene, config=f"{folder}/config", probe=f"{folder}/probe.json", size=(1600, 900))
        hand = Hand(editor)
        try:
            editor.wait(lambda s: s["counts"]["instances"] == 299 and not s["opening"], "the kitchen", 60)
            editor.settled(1)
            started = time.monotonic()
            how(hand)
            wall = time.monotonic() - started
            save(hand, project_file)
            editor.settled(8)
        except Exception:
            print(hand.names())
            raise
        finally:
            write_png(out / f"{name}.screen.png", desk.screenshot())
            print(f"{name}:\n  " + "\n  ".join(hand.gestures))
            editor.close()
            desk.close()
    print(f"{name}: {len(hand.gestures)} gestures; the script took {wall:.0f} s; a person, by the keystroke-level model: "
          f"{hand.seconds / 60:.1f} minutes (an estimate)")
    return project_file


def write_png(path, pixels):
    raw = b"".join(b"\0" + row.tobytes() for row in pixels)
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(raw, 6)) + chunk(b"IEND", b""))


def main():
    binary, scene, out = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    wanted = sys.argv[4:] or ["kitchen", "materials"]
    out.mkdir(parents=True, exist_ok=True)
    projects = {"before": scene}
    for name, how in (("kitchen", another_kitchen), ("materials", other_materials)):
        if name in wanted:
            projects[name] = edit(binary, scene, out, name, how)
    if "render" in wanted or len(wanted) == 2:
        for name, file in projects.items():
            subprocess.run([binary, "render", file, "-o", out / f"{name}.png", "--size", "960x540", "--spp", "64", "--denoise"], check=True)


if __name__ == "__main__":
    main()
