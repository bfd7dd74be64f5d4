# SPDX-License-Identifier: Apache-2.0
"""Run manually: the edit of the thesis that this project follows, with a real mouse and real keys under Xvfb. "Country Kitchen"
becomes a different kitchen (island removed, table longer, chairs, places and the lamp cloned, walls repainted), and then the
same room in other materials. Only pointing, dragging, keys and typed numbers are used; where a person would check the position
of a thing, the script reads the editor's state (--probe).

    build/venv/bin/python tests/ui/thesis.py RESTAGE SCENES/kitchen/scene.pbrt OUT [kitchen] [materials] [bedroom] [render] [record]

writes the projects, screenshots and, with `render`, what `restage render` makes of them (denoised); with `record` also kitchen.webp
and so on, 20 s of the window (needs Pillow). A bedroom is furnished from the parts that the program ships. It
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
from record import Recorder

# Card, Moran, Newell 1980, Fig. 1 [s]: a key of a non-secretary typist, pointing, pressing or releasing a button, a hand from
# mouse to keyboard or back, making up one's mind.
KEY, POINT, BUTTON, HAND, MIND = 0.28, 1.1, 0.1, 0.4, 1.35
LOOK = 2.0  # ours: seeing what a drag did before the next one


class Hand:
    """An Editor's mouse and keys that count gestures and the time they would take a person."""

    def __init__(self, editor, eye):
        self.e, self.eye = editor, eye
        self.gestures, self.seconds, self.on_keys = [], 0.0, False

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
        lower, upper = self.bounds()
        return (lower + upper) / 2

    def box(self, lower, upper, what, expect):
        """Selects what is entirely inside a box on the screen, around this box of the scene."""
        self.e.settled(1)  # thin things are missing in coarse pictures
        corners = np.array([self.screen((x, y, z)) for x in (lower[0], upper[0]) for y in (lower[1], upper[1]) for z in (lower[2], upper[2])])
        self.e.drag(tuple(int(v) for v in corners.min(0) - 14), tuple(int(v) for v in corners.max(0) + 14))
        self.e.wait(lambda s: expect <= {item["name"] for item in s["selection"]}, what, 10)
        self.note(f"box around {what}", 2 * POINT + 2 * BUTTON)

    def bounds(self):
        items = self.state()["selection"]
        return np.min([i["lower"] for i in items], 0), np.max([i["upper"] for i in items], 0)

    def screen(self, point):
        return self.e.point(("picture", *self.eye.project(point)))

    def number(self, mark, part, text, what):
        """Ctrl + click on the part-th of the three fields of a widget, and a number typed into it."""
        self.e.point(mark)  # once it is stable
        x0, y0, x1, y1 = self.state()["marks"][mark]
        before = self.steps()
        at = (int(x0 + (x1 - x0) * (part + 0.5) / 3), int((y0 + y1) / 2))
        self.e.click(at, keys=["ctrl"])
        time.sleep(0.5)
        self.e.type(text)
        self.e.key("Return")
        self.e.wait(lambda s: s["history"]["position"] > before, what, 10)
        self.note(what, POINT + 2 * BUTTON + HAND + KEY * (len(text) + 2))

    def search(self, mark, name):
        """Types it into a search field."""
        self.e.click(mark)
        self.e.key("ctrl+a")
        self.e.type(name)
        self.note(f"search {name}", POINT + 2 * BUTTON + HAND + KEY * (len(name) + 2))

    def drag_onto(self, mark, where):
        """Drags a thing out of a panel onto the picture, and lets it go once the window says what it becomes there."""
        (x0, y0), (x1, y1) = self.e.point(mark), self.e.point(where)
        for attempt in range(3):  # a slow window may take the press for something else
            self.e.move((x0, y0))
            time.sleep(0.3)
            self.e.desk.xdotool("mousedown", 1)
            time.sleep(0.3)
            for i in range(1, 13):
                time.sleep(0.05)
                self.e.desk.xdotool("mousemove", x0 + (x1 - x0) * i // 12, y0 + (y1 - y0) * i // 12)
            try:
                self.e.wait(lambda s: "drop.preview" in s["marks"], "what it becomes", 8)
                break
            except AssertionError:
                if attempt == 2:
                    raise
            finally:
                self.e.desk.xdotool("mouseup", 1)

    def part(self, name, at):
        """Finds a part in the Assets panel and drags it to where this point of the scene is seen."""
        self.search("assets.search", name)
        self.e.wait(lambda s: [m for m in s["marks"] if m.startswith("asset.")][:1] == [f"asset.{name}"], name, 20)
        before = self.steps()
        self.drag_onto(f"asset.{name}", ("picture", *self.eye.project(at)))
        self.e.wait(lambda s: s["history"]["position"] > before, f"{name} inserted", 30)
        self.note(f"drag {name}", 2 * POINT + 2 * BUTTON)
        off = self.middle() - at
        assert np.linalg.norm(off[:2]) < 0.4, f"{name} is {off} from where it was dropped"

    def preset(self, name, where, only=False):
        """Finds a material in the library by its name and drags it to this place; `only` to the object there, not to all that share
        its material."""
        if "materials.search" not in self.state()["marks"]:
            self.click("tab.Materials")
        self.search("materials.search", name)
        self.e.wait(lambda s: f"materials.{name}" in s["marks"] and sum(m.startswith("materials.") and m[10].isupper() for m in s["marks"]) < 6, name)
        before = self.steps()
        self.drag_onto(f"materials.{name}", where)
        state = self.e.wait(lambda s: s["modal"] or s["history"]["position"] > before, f"{name} given", 20)
        self.note(f"drag {name}", 2 * POINT + 2 * BUTTON)
        if state["modal"]:
            self.click("scope.alone" if only else "scope.all")
            self.e.wait(lambda s: s["history"]["position"] > before, f"{name} given", 20)


class Eye:
    """A pinhole camera of a 16:9 picture."""

    def __init__(self, to_camera, fov):
        self.to_camera, self.half = np.array(to_camera), np.tan(np.radians(fov / 2))

    def project(self, point):
        """Its position in the picture: (0,0) top left, (1,1) bottom right."""
        x, y, z = (self.to_camera @ [*point, 1])[:3]
        return 0.5 + x / z / self.half / (16 / 9) / 2, 0.5 - y / z / self.half / 2


def looking(eye, at, fov):
    """From a point to another one; z is up."""
    forward = np.subtract(at, eye) / np.linalg.norm(np.subtract(at, eye))
    right = np.cross(forward, (0, 0, 1)) / np.linalg.norm(np.cross(forward, (0, 0, 1)))
    rows = np.array([right, np.cross(right, forward), forward])
    return Eye(np.column_stack([rows, -rows @ eye]), fov)


# The cameras of both scenes, from their files.
KITCHEN = Eye(np.array([[0.89874, -0.0182716, -0.4381, 0], [1.86265e-9, 0.999132, -0.0416703, 0],
                        [-0.438481, -0.0374507, -0.89796, 0], [0.600822, -1.63678, 4.06504, 1]]).T, 35.9834)
ROOM = looking((4.02, -4.52, 1.28), (1.62, -0.9, 1.28), 46)
project = KITCHEN.project


LAMP = ("picture", 0.739, 0.30)
WALL = ("picture", 0.936, 0.484)
LONGER = 1.42  # the table, and the displacement of copies of the things at and on it


def another_kitchen(hand):
    # The island and everything on it.
    hand.click(("picture", 0.385, 0.85), "SmallWorktop")
    hand.key("c")
    hand.e.wait(lambda s: s["selected"] == 43, "the whole island", 5)
    hand.key("Delete")
    hand.e.wait(lambda s: s["counts"]["instances"] == 299 - 43, "no island")

    # A copy of each chair at the near end of the table, nearer.
    chairs = (1.09, 1.01, -1.27), (-0.555, 1.03, -1.15)
    hand.click(("picture", *project(chairs[0])), "TableCross")
    hand.click(("picture", *project(chairs[1])), "TableCross", keys=["ctrl"])
    assert hand.state()["selected"] >= 18 + 14, hand.names()
    hand.slide(chairs[0], np.array([0, 0, LONGER]), "two more chairs", copy=True)

    # The table, longer, and its far end at the window again.
    hand.click(("picture", *project((0.15, 0.86, -0.80))), "Tabletop")
    assert hand.names() == ["TableCross 46", "TableCross 47", "TableCross 48", "Tabletop"], hand.names()
    hand.key("r")
    center, handle = (np.array(hand.e.point(mark), float) for mark in ("gizmo.center", "gizmo.z"))
    hand.pull("gizmo.z", (handle - center) / np.linalg.norm(handle - center) * 6,
              lambda s: 3.05 - (lambda b: b[1][2] - b[0][2])(hand.bounds()), what="the table longer")
    hand.key("w")
    lower, upper = hand.bounds()
    hand.slide((0.15, 0.86, upper[2] - 0.15), np.array([0, 0, -2.46 - lower[2]]), "the table to the window")

    # Four more places, by a box around those that are there.
    hand.box((-0.36, 0.86, -2.24), (0.63, 0.90, -0.94), "the places", {"Plates", "TableMats", "Cutlery"})
    hand.slide((-0.16, 0.878, -1.12), np.array([0, 0, LONGER]), "four more places", copy=True)

    # Another lamp.
    hand.click(LAMP, "Lamp")
    hand.slide((0.19, 2.3, -1.6), np.array([0, 0, 1.3]), "another lamp", copy=True)

    # The wall with the window, and the others, from the library.
    hand.preset("Paint, sky blue", WALL, only=True)
    hand.preset("Egg shell, white", ("picture", 0.30, 0.13))


def other_materials(hand):
    hand.preset("Concrete", ("picture", 0.724, 0.937))
    hand.preset("Varnished walnut", ("picture", 0.13, 0.90))
    hand.preset("Marble, polished", ("picture", 0.07, 0.786))
    hand.preset("Marble, matt", ("picture", 0.385, 0.85))
    hand.preset("Linen, natural", WALL)


def bedroom(hand):
    """An empty room, furnished with what the program ships."""
    hand.click("tab.Assets")
    for name, at in (("bedside-table", (1.16, -0.23, 0)), ("bedside-table", (3.56, -0.23, 0)), ("table-lamp", (1.10, -0.2, 0.52)),
                     ("table-lamp", (3.62, -0.2, 0.52)), ("books", (3.44, -0.3, 0.52)), ("framed-picture", (2.35, 0, 1.6)),
                     ("plant", (0.42, -0.48, 0)), ("bed", (2.35, -1.1, 0)), ("ceiling-lamp", (1.9, -1.2, 2.65)),
                     ("woven-rug", (1.9, -2.3, 0)), ("armchair", (0.8, -1.55, 0)), ("curtains", (0, -1.95, 2.45))):
        hand.part(name, at)
        if name == "armchair":
            hand.number("inspector.turn_by", 2, "62", "the armchair to the bed")
        if name == "curtains":
            center, handle = (np.array(hand.e.point(mark), float) for mark in ("gizmo.center", "gizmo.z"))
            hand.pull("gizmo.z", (center - handle) / np.linalg.norm(handle - center) * 6, lambda s: hand.bounds()[0][2] - 0.02, what="the curtains down")
    hand.preset("Velvet, blue", ("picture", *ROOM.project((0.8, -1.6, 0.45))))
    hand.key("Escape")


def save(hand, path):
    hand.key("ctrl+s")
    hand.e.wait(lambda s: s["modal"] == "Save as", "the question where")
    hand.e.point("browser.name")
    hand.e.key("ctrl+a")
    hand.e.type(str(path))
    hand.e.key("Return")
    hand.note("name of the project", KEY * 12, keys=True)
    hand.e.wait(lambda s: s["path"] == str(path) and not s["modified"], "the saved project")


def edit(binary, scene, out, name, how, eye, record):
    """Opens the scene, edits it, saves it; prints the effort."""
    project_file = out / f"{name}.restage"
    project_file.unlink(missing_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        desk = Desk(pathlib.Path(folder) / "desk", size=(1600, 900))
        editor = Editor(desk, binary, scene, config=f"{folder}/config", probe=f"{folder}/probe.json", size=(1600, 900))
        hand = Hand(editor, eye)
        try:
            editor.wait(lambda s: s["counts"]["instances"] > 1 and not s["opening"], "the scene", 60)
            editor.settled(1)
            recorder = Recorder(desk) if record else None
            started = time.monotonic()
            how(hand)
            wall = time.monotonic() - started
            save(hand, project_file)
            editor.settled(8)
            if recorder:
                recorder.stop()
                recorder.write(out / f"{name}.webp", seconds=20, width=960)
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
    wanted = sys.argv[4:] or ["kitchen", "materials", "bedroom", "render"]
    out.mkdir(parents=True, exist_ok=True)
    room = pathlib.Path(__file__).resolve().parents[2] / "scenes/room/room.pbrt"
    projects = {"before": scene, "room": room}
    for name, from_file, how, eye in (("kitchen", scene, another_kitchen, KITCHEN), ("materials", scene, other_materials, KITCHEN),
                                      ("bedroom", room, bedroom, ROOM)):
        if name in wanted:
            projects[name] = edit(binary, from_file, out, name, how, eye, "record" in wanted)
    if "render" in wanted:
        for name, file in projects.items():
            subprocess.run([binary, "render", file, "-o", out / f"{name}.png", "--size", "960x540", "--spp", "64", "--denoise"], check=True)


if __name__ == "__main__":
    main()
