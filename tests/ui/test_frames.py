# SPDX-License-Identifier: Apache-2.0
"""Eleven interactions with a real mouse and real keys, and every picture that the window showed meanwhile: none is black,
noisy, or older than one before. The pictures that the renderer offers are checked in tests/render/live_frames_test.cpp."""
import pathlib

import numpy as np

from record import Recorder

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
CUSHION = ("picture", 0.27, 0.82)


def luminance(picture):
    return picture.astype(np.float32) @ np.float32([0.2126, 0.7152, 0.0722]) / 255


def noise(picture):
    """Mean deviation of pixels from the mean of their neighbours: below that of a clean picture where it is upscaled."""
    y = luminance(picture)
    around = (y[1:-1, :-2] + y[1:-1, 2:] + y[:-2, 1:-1] + y[2:, 1:-1]) / 4
    return float(np.abs(y[1:-1, 1:-1] - around).mean())


def distance(a, b):
    return float(np.abs(luminance(a) - luminance(b)).mean())


def middle(state):
    """Rows and columns of the viewport's picture, without its frame and what is written in its corners."""
    x0, y0, x1, y1 = (int(v) for v in state["marks"]["picture"])
    inset = (y1 - y0) // 5
    return slice(y0 + inset, y1 - inset), slice(x0 + inset, x1 - inset)


def test_no_interaction_shows_a_black_noisy_or_old_picture(launch):
    editor = launch(SCENES / "demo/demo.pbrt")
    editor.settled(samples=2)

    def undo_all():
        editor.key("ctrl+z", "ctrl+z", "ctrl+z")
        editor.wait(lambda s: not s["modified"], "nothing left to undo")

    def another_scene():
        x, y = editor.point(("picture", 0.5, 0.5))
        partial = pathlib.Path(f"{editor.probe}.partial")
        partial.write_text(f"drop {SCENES / 'spheres/spheres.pbrt'} {x} {y}\n")
        partial.rename(f"{editor.probe}.in")
        editor.wait(lambda s: "spheres" in s["path"] and not s["opening"], "the other scene", 60)

    interactions = {
        "orbit": lambda: editor.drag(("picture", 0.4, 0.3), ("picture", 0.5, 0.33), keys=["alt"], steps=12),
        "pan": lambda: editor.drag(("picture", 0.4, 0.3), ("picture", 0.45, 0.35), button=2, steps=12),
        "drag": lambda: (editor.click(CUSHION), editor.drag(CUSHION, ("picture", 0.4, 0.85), steps=12)),
        "undo": lambda: editor.key("ctrl+z"),
        "redo": lambda: editor.key("ctrl+y"),
        "copy": lambda: editor.key("ctrl+d"),
        "remove": lambda: editor.key("Delete"),
        "frame": lambda: editor.key("Home"),
        "back": lambda: editor.key("bracketleft"),
        "undo all": undo_all,  # a question about changes would dim the picture
        "another scene": another_scene,
    }
    for name, act in interactions.items():
        before = editor.settled(samples=2)
        recorder = Recorder(editor.desk, per_second=20, crop=middle(before))
        act()
        after = editor.settled(samples=2)
        editor.wait(lambda s: s["latency"]["nframes"] >= after["latency"]["nframes"] + 2, "two more frames")
        recorder.stop()
        seen = [picture for _, picture in recorder.pictures]
        assert len(seen) >= 2, f"{name}: nothing changed"
        first, last = seen[0], seen[-1]
        least = 0.6 * min(luminance(first).mean(), luminance(last).mean())
        if name == "another scene":
            least = 0.15  # until its geometry is read the place is empty, and grey
        most = max(noise(first), noise(last))
        arrived = False
        for i, picture in enumerate(seen):
            where = f"{name}: picture {i} of {len(seen)}"
            assert luminance(picture).mean() > least, f"{where} is dark"
            assert noise(picture) < 1.4 * most + 0.002, f"{where} is noisy: {noise(picture):.4f}, at rest {most:.4f}"
            old, new = distance(picture, first), distance(picture, last)
            if distance(first, last) > 0.02:
                assert not (arrived and old < 0.3 * new), f"{where} is the old one again"
                arrived = arrived or new < 0.3 * old
