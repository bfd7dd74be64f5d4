# SPDX-License-Identifier: Apache-2.0
"""A desk for the editor: an X server without a screen, real mouse and key events (xdotool), screenshots, and the editor's
reported state (`restage edit --probe FILE`). Coordinates are screen pixels; the window is at (0, 0)."""
import json
import os
import pathlib
import struct
import subprocess
import time

import numpy as np


class Timeout(AssertionError):
    pass


class Desk:
    """A private Xvfb, with its frame buffer in a file."""

    def __init__(self, folder, size=(1280, 720)):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{size[0]}x{size[1]}x24", "-fbdir", str(self.folder),
             "-nolisten", "tcp"], pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.display = ":" + pipe.readline().strip()
        assert self.display != ":", "Xvfb did not start"
        self.environment = {**os.environ, "DISPLAY": self.display}

    def close(self):
        self.server.terminate()
        self.server.wait(10)

    def xdotool(self, *arguments):
        subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, check=True, timeout=30)

    def resize(self, title, size):
        """The window whose title contains this."""
        found = subprocess.run(["xdotool", "search", "--name", title], env=self.environment, check=True, capture_output=True, text=True)
        self.xdotool("windowsize", found.stdout.split()[-1], *size)

    def screenshot(self):
        """height x width x 3, uint8. The file is XWD version 7: a header of 32-bit big-endian words, a colour map, pixels."""
        data = (self.folder / "Xvfb_screen0").read_bytes()
        head = struct.unpack(">25I", data[:100])
        width, height, order, stride, colors = head[4], head[5], head[7], head[12], head[19]
        start = head[0] + colors * 12
        pixels = np.frombuffer(data, np.uint8, stride * height, start).reshape(height, stride)[:, : width * 4]
        pixels = pixels.reshape(height, width, 4)
        return np.ascontiguousarray(pixels[:, :, [2, 1, 0]] if order == 0 else pixels[:, :, [1, 2, 3]])


class Editor:
    """A running `restage edit`."""

    def __init__(self, desk, binary, *arguments, config, probe, environment=None, size=(1280, 720), hint=False):
        self.desk, self.probe, self.size = desk, pathlib.Path(probe), size
        preferences = pathlib.Path(config) / "preferences.json"
        if not hint and not preferences.exists():  # the first-start hint covers the picture
            preferences.parent.mkdir(parents=True, exist_ok=True)
            preferences.write_text('{"hint_seen": true}')
        self.probe.unlink(missing_ok=True)
        self.log = open(str(probe) + ".log", "wb")
        self.process = subprocess.Popen(
            [str(binary), "edit", "--window", f"{size[0]}x{size[1]}", "--config", str(config), "--probe", str(probe),
             *map(str, arguments)], env={**desk.environment, **(environment or {})}, stdout=self.log, stderr=self.log)
        self.wait(lambda s: True, "the editor to start", 60)

    # --- the editor's state ---
    def state(self):
        for _ in range(100):
            try:
                return {"marks": {}, **json.loads(self.probe.read_text())}  # marks are missing in the first frames
            except (FileNotFoundError, json.JSONDecodeError):
                assert self.process.poll() is None, "the editor ended: " + self.output()
                time.sleep(0.05)
        raise Timeout("the editor writes no state: " + self.output())

    def output(self):
        self.log.flush()
        return pathlib.Path(self.log.name).read_text(errors="replace")[-2000:]

    def wait(self, condition, what, seconds=30):
        """The state for which condition(state) holds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.process.poll() is not None:
                raise AssertionError(f"the editor ended ({self.process.returncode}) while waiting for {what}: {self.output()}")
            if self.probe.exists():
                state = self.state()
                if condition(state):
                    return state
            time.sleep(0.05)
        raise Timeout(f"waited {seconds} s for {what}; the editor's state is {json.dumps(self.short_state())}\n{self.output()}")

    def short_state(self):
        state = self.state()
        state["marks"] = sorted(state.get("marks", {}))[:40]
        state.pop("latency", None)
        return state

    def settled(self, samples=4, seconds=90):
        """Waits for a full picture of the newest scene, with this many samples, and denoised."""
        return self.wait(lambda s: not s["opening"] and s["view"]["state"] in (2, 3) and s["view"]["divider"] == 1
                         and s["view"]["samples"] >= samples and s["view"]["current"] and not s["view"]["compiling"]
                         and s["view"]["denoised_samples"] >= samples, "a whole picture", seconds)

    # --- hands ---
    def point(self, where):
        """A mark's centre; ("picture", u, v); or (x, y)."""
        if isinstance(where, str):
            def there(s):  # dialogs are above the window until they know their size
                return where in s["marks"] and not (s["modal"] and s["marks"][where][1] < 0)

            rectangle = None
            while rectangle != (now := (state := self.wait(there, f"'{where}' to be on screen", 10))["marks"][where]):
                rectangle, drawn = now, state["latency"]["nframes"]
                time.sleep(0.15)
                if state["modal"]:  # dialogs settle their size in their first frames, and are drawn all the time
                    self.wait(lambda s: not s["modal"] or s["latency"]["nframes"] >= drawn + 2, "two more frames")
            x0, y0, x1, y1 = rectangle
            return int((x0 + x1) / 2), int((y0 + y1) / 2)
        if where[0] == "picture":
            x0, y0, x1, y1 = self.state()["marks"]["picture"]
            return int(x0 + where[1] * (x1 - x0)), int(y0 + where[2] * (y1 - y0))
        return where

    def reveal(self, mark):
        """Scrolls the panel at the right down until this mark is inside the window."""
        for _ in range(30):
            x, y = self.point(mark)
            if y < self.size[1] - 24:
                return
            self.click((x, int(self.size[1] * 0.85)), button=5)
        raise Timeout(f"{mark} cannot be scrolled to")

    def move(self, where):
        self.desk.xdotool("mousemove", *self.point(where))
        time.sleep(0.1)

    def click(self, where, button=1, keys=()):
        self.move(where)
        for key in keys:
            self.desk.xdotool("keydown", key)
        self.desk.xdotool("click", button)
        for key in keys:
            self.desk.xdotool("keyup", key)
        time.sleep(0.2)

    def drag(self, start, end, button=1, keys=(), steps=8):
        (x0, y0), (x1, y1) = self.point(start), self.point(end)
        self.move((x0, y0))
        for key in keys:
            self.desk.xdotool("keydown", key)
        self.desk.xdotool("mousedown", button)
        time.sleep(0.1)
        for i in range(1, steps + 1):
            self.desk.xdotool("mousemove", x0 + (x1 - x0) * i // steps, y0 + (y1 - y0) * i // steps)
            time.sleep(0.05)
        time.sleep(0.1)
        self.desk.xdotool("mouseup", button)
        for key in keys:
            self.desk.xdotool("keyup", key)
        time.sleep(0.2)

    def key(self, *keys):
        for key in keys:
            self.desk.xdotool("key", key)
            time.sleep(0.15)

    def type(self, text):
        self.desk.xdotool("type", "--delay", "30", text)
        time.sleep(0.2)

    # --- eyes ---
    def picture(self):
        """The content of the viewport, without its frame; float, 0..1. The screen may be a frame behind the state."""
        drawn = self.state()["latency"]["nframes"]
        self.wait(lambda s: s["latency"]["nframes"] >= drawn + 2, "two more frames")
        x0, y0, x1, y1 = (int(v) for v in self.state()["marks"]["picture"])
        return self.desk.screenshot()[y0:y1, x0:x1].astype(np.float32) / 255

    def kill(self):
        self.process.kill()
        self.process.wait(120)  # the driver's threads of lowest priority end late on a busy machine

    def close(self):
        if self.process.poll() is None:
            self.kill()
        self.log.close()
