# SPDX-License-Identifier: Apache-2.0
"""The editor's latencies, with real mouse and key events under Xvfb: from input to changed pixels, and the window's frames."""
import pathlib
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/ui"))

from desk import Desk, Editor  # noqa: E402


def percentile(values, p):
    values = sorted(values)
    return values[min(len(values) - 1, int(p / 100 * len(values)))] if values else None


def during(editor, act):
    """Latencies of the changes made by `act` [ms], and how long a denoised picture took afterwards [s]. Only the newest 512 are kept."""
    editor.wait(lambda s: s["view"]["current"] and s["view"]["divider"] == 1, "rest", 120)
    before = editor.state()["latency"]["count"]
    act()
    time.sleep(0.5)
    state = editor.wait(lambda s: s["view"]["current"] and s["view"]["denoised_request"] == s["view"]["request"], "a denoised picture", 120)
    pixels = state["latency"]["pixels"][-(state["latency"]["count"] - before):]
    clean = editor.wait(lambda s: s["view"]["first_clean_request"] == s["view"]["request"], "a usable denoised picture", 120)
    return {"pixels_ms": pixels, "median_ms": percentile(pixels, 50), "p95_ms": percentile(pixels, 95),
            "denoised_s": clean["view"]["first_clean_seconds"]}


def choose_type(editor, name):
    """Opens the list of material types, scrolls to one and clicks it."""
    editor.click("material.type")
    mark = f"material.type.{name}"
    for _ in range(40):
        x, y = editor.point(mark)
        if 40 < y < editor.size[1] - 40:
            break
        marks = editor.state()["marks"]
        seen = [at for other in marks if other.startswith("material.type.") and 40 < (at := editor.point(other))[1] < editor.size[1] - 40]
        editor.click(seen[len(seen) // 2], button=5 if y > 40 else 4)
    editor.click(mark)
    editor.wait(lambda s: s["selection"][0]["type"] == name, f"the type {name}", 20)


def new_type(editor, name):
    """The latency of a type whose code is not cached; and when it, not its stand-in, is shown [s]."""
    started = time.monotonic()
    row = during(editor, lambda: choose_type(editor, name))
    editor.wait(lambda s: s["view"]["current"] and not s["view"]["compiling"], "the new code", 120)
    return {**row, "own_code_s": time.monotonic() - started}


def measure(binary, scene, picture_of_object):
    """`picture_of_object`: where in the picture (u, v) something can be picked. Caches are warm but for the new type."""
    with tempfile.TemporaryDirectory() as folder:
        desk = Desk(pathlib.Path(folder) / "desk")
        environment = {"XDG_CACHE_HOME": f"{folder}/cache", "MESA_SHADER_CACHE_DIR": f"{folder}/cache/mesa"}

        def start():
            return Editor(desk, binary, scene, config=f"{folder}/config", probe=f"{folder}/probe.json", environment=environment)

        editor = start()
        try:
            editor.settled(1, 180)
            editor.key("ctrl+q")  # caches are written at the end
            editor.process.wait(60)
            editor.close()
            started = time.monotonic()
            editor = start()
            editor.wait(lambda s: s["view"]["request"] > 0, "a first picture", 180)
            first = time.monotonic() - started
            editor.wait(lambda s: s["view"]["divider"] == 1 and s["view"]["denoised_samples"] > 0, "a denoised one", 180)
            whole = time.monotonic() - started
            rows = {"orbit": during(editor, lambda: editor.drag(("picture", 0.4, 0.3), ("picture", 0.6, 0.35), keys=["alt"], steps=40))}
            editor.key("bracketleft")  # the view as it was
            editor.click(("picture", *picture_of_object))
            editor.wait(lambda s: s["selection"], "a selection", 20)
            x, y = editor.point("gizmo.x")
            rows["gizmo drag"] = during(editor, lambda: editor.drag((x, y), (x + 60, y), steps=40))
            editor.key("ctrl+z")
            rows["material type, new code"] = new_type(editor, "plastic")
            editor.reveal("material.roughness")
            x, y = editor.point("material.roughness")
            rows["material value"] = during(editor, lambda: editor.drag((x - 30, y), (x + 30, y), steps=40))
            frames = editor.state()["latency"]["frames"]
            return {"first_image_s": first, "whole_denoised_s": whole, "rows": rows,
                    "ui_frame_ms": {"median": percentile(frames, 50), "p99": percentile(frames, 99), "frames": len(frames)}}
        finally:
            editor.close()
            desk.close()
