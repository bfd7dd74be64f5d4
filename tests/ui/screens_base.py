# SPDX-License-Identifier: Apache-2.0
"""The editor on a desk, brought into the states of screens_*.py and photographed (screens.py)."""
import json
import pathlib
import shutil
import time
import traceback

from PIL import Image

from desk import Editor

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEMO = ROOT / "scenes/demo/demo.pbrt"
states = {}  # of all modules that were imported


def state(function):
    states[function.__name__] = function
    return function


class Screens:
    def __init__(self, desk, binary, out, size, scale, theme, jpeg, folder):
        self.theme = theme
        self.desk, self.binary, self.out, self.size, self.scale = desk, binary, out, size, scale
        self.folder = pathlib.Path(folder)
        self.jpeg = jpeg
        self.editor, self.opened = None, None
        self.failed = []

    # --- reaching states ---
    def start(self, *arguments, config="config", fresh=False, settle=True, hint=False, recover=False):
        """An editor with these arguments; reuses the running one if it has them."""
        key = (config, *map(str, arguments))
        if not fresh and self.opened == key and self.editor.process.poll() is None:
            return self.editor
        self.stop()
        place = self.folder / config
        if not recover:  # recovery files of editors killed here
            shutil.rmtree(place / "recovery", ignore_errors=True)
        if not (place / "preferences.json").exists():
            place.mkdir(parents=True, exist_ok=True)
            (place / "preferences.json").write_text(json.dumps({"hint_seen": not hint, "theme": self.theme}))
        self.editor = Editor(self.desk, self.binary, "--scale", self.scale, *arguments, config=place,
                             probe=self.folder / "probe.json", size=self.size, hint=hint)
        self.opened = key
        if settle:
            self.editor.settled(samples=1, seconds=240)
        return self.editor

    def stop(self):
        if self.editor:
            self.editor.close()
            self.editor = None
        self.opened = None

    def tab(self, name):
        self.editor.click("tab." + name)
        self.rest()

    def rest(self):
        """Moves the mouse to an empty place."""
        self.editor.move((self.size[0] - 3, 3))
        time.sleep(0.3)

    def scroll(self):
        """One notch down, until it is drawn: at 2x on a busy machine a frame takes longer than any fixed pause."""
        drawn = self.editor.state()["latency"]["nframes"]
        self.desk.xdotool("click", 5)
        self.editor.wait(lambda t: t["latency"]["nframes"] >= drawn + 2, "two more frames")

    def show(self, mark, clicks=30):
        """Scrolls the panel at the right until the widget is well inside the window."""
        tab = self.editor.point("tab.Scene")
        self.desk.xdotool("mousemove", tab[0], self.size[1] * 0.45)
        for _ in range(clicks):
            found = self.editor.state()["marks"].get(mark)
            if found and found[3] < self.size[1] * 0.6:
                break
            self.scroll()

    def wheel(self, over, mark, lowest):
        """Scrolls the menu or dialog at the widget `over` until `mark` is above `lowest`, a fraction of the window's height."""
        self.editor.move(over)
        for _ in range(30):
            found = self.editor.wait(lambda t: mark in t["marks"], mark)["marks"][mark]
            if found[3] < self.size[1] * lowest:
                return
            self.scroll()

    def top(self):
        tab = self.editor.point("tab.Scene")
        self.desk.xdotool("mousemove", tab[0], self.size[1] * 0.45, "click", "--repeat", 60, "--delay", 5, 4)
        time.sleep(0.3)

    def select(self, *names):
        for i, name in enumerate(names):
            self.editor.key("Escape") if i == 0 else None
            self.editor.click("outliner.search")
            self.editor.key("ctrl+a")
            self.editor.type(name + "\n")
            self.editor.click("outliner." + name, keys=["ctrl"] if i else [])
        self.editor.click("outliner.search")
        self.editor.key("ctrl+a", "BackSpace", "Return")
        self.rest()

    def dialog(self, keys, title):
        self.editor.key(keys)
        self.editor.wait(lambda s: s["modal"] == title, title)
        self.rest()

    def calm(self):
        """Closes and releases everything that the previous state left open or pressed."""
        if not self.editor or self.editor.process.poll() is not None:
            return
        self.rest()
        self.desk.xdotool("mouseup", 1, "keyup", "shift")
        for _ in range(3):
            self.editor.key("Escape")
            if not self.editor.state()["modal"]:
                break

    # --- taking them ---
    def shoot(self, name):
        image = Image.fromarray(self.desk.screenshot()[: self.size[1], : self.size[0]])
        if self.jpeg:
            image.save(self.out / f"{name.replace('_', '-')}.jpg", quality=85, optimize=True)
        else:
            image.save(self.out / f"{name}.png")

    def run(self, names):
        for name in names:
            begin = time.monotonic()
            try:
                self.calm()
                states[name](self)
                time.sleep(0.7)  # popups opened by a click appear in the next frames
                self.shoot(name)
                print(f"{name}: {time.monotonic() - begin:.1f} s", flush=True)
            except Exception:  # continue with the others
                traceback.print_exc()
                self.failed.append(name)
                self.shoot(name + ".failed")
                self.stop()
        self.stop()
