# SPDX-License-Identifier: Apache-2.0
"""Run manually: the editor's behaviour with many objects. Makes a scene of N boxes (pbrt ObjectInstances) and measures, with real
keys and clicks: the window's frames, and how long selecting all, hiding, undo, copying, moving and searching take.

    build/venv/bin/python tests/ui/many.py RESTAGE [N]"""
import pathlib
import sys
import tempfile
import time

import numpy as np

from desk import Desk, Editor


def write_scene(path, count):
    side = int(np.ceil(np.sqrt(count)))
    box = ('Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1] '
           '"integer indices" [0 1 3 0 3 2 4 5 7 4 7 6 0 1 5 0 5 4 2 3 7 2 7 6 0 2 6 0 6 4 1 3 7 1 7 5]')
    lines = [f'LookAt {side} {-side} {side} {side} {side} 0 0 0 1', 'Camera "perspective" "float fov" [ 40 ]',
             'Film "rgb" "integer xresolution" [ 640 ] "integer yresolution" [ 360 ] "string filename" [ "x.exr" ]', "WorldBegin",
             'LightSource "infinite" "rgb L" [ 1 1 1 ]', f'ObjectBegin "box"\n{box}\nObjectEnd']
    for i in range(count):
        lines.append(f'AttributeBegin\nTranslate {i % side * 2} {i // side * 2} 0\nObjectInstance "box"\nAttributeEnd')
    path.write_text("\n".join(lines) + "\n")


def main():
    binary, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 20000
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        write_scene(folder / "many.pbrt", count)
        desk = Desk(folder / "desk")
        started = time.monotonic()
        editor = Editor(desk, binary, folder / "many.pbrt", config=folder / "config", probe=folder / "probe.json")
        try:
            editor.wait(lambda s: s["counts"]["instances"] == count and not s["opening"], "the scene", 120)
            print(f"{'open':24s} {time.monotonic() - started:7.2f} s")
            editor.wait(lambda s: s["view"]["request"] > 0, "a picture", 120)
            print(f"{'first picture':24s} {time.monotonic() - started:7.2f} s")

            def measure(what, act, done):
                editor.wait(lambda s: s["view"]["current"], "rest", 120)
                time.sleep(1)
                begin = time.monotonic()
                act()
                editor.wait(done, what, 120)
                seconds = time.monotonic() - begin
                time.sleep(1)
                frames = editor.state()["latency"]["frames"][-40:]
                print(f"{what:24s} {seconds:7.2f} s; the slowest of the last frames {max(frames):6.0f} ms, median {np.median(frames):5.1f} ms")

            measure("nothing", lambda: editor.move(("picture", 0.4, 0.5)), lambda s: True)
            measure("search", lambda: (editor.click("outliner.search"), editor.type("7")), lambda s: True)
            editor.key("BackSpace")
            editor.click(("picture", 0.5, 0.02))
            measure("select all", lambda: editor.desk.xdotool("key", "ctrl+a"), lambda s: s["selected"] == count)
            measure("with all selected", lambda: editor.move(("picture", 0.5, 0.5)), lambda s: True)
            measure("hide all", lambda: editor.desk.xdotool("key", "h"), lambda s: s["counts"]["hidden"] == count)
            measure("undo it", lambda: editor.desk.xdotool("key", "ctrl+z"), lambda s: s["counts"]["hidden"] == 0)
            measure("copy all", lambda: editor.desk.xdotool("key", "ctrl+d"), lambda s: s["counts"]["instances"] == 2 * count)
            measure("undo it", lambda: editor.desk.xdotool("key", "ctrl+z"), lambda s: s["counts"]["instances"] == count)
            editor.key("ctrl+a")
            x, y = editor.point("gizmo.x")
            measure("move all", lambda: editor.drag((x, y), (x + 30, y)), lambda s: s["history"]["undo"].startswith("Move"))
        finally:
            editor.close()
            desk.close()


if __name__ == "__main__":
    main()
