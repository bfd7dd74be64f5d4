# SPDX-License-Identifier: Apache-2.0
"""Scenes for all renderers alike: one size, box filter, no exposure."""
import pathlib
import re
import subprocess


class Failed(Exception):
    """A program failed; the text says which and why."""


def run(command, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)
    if done.returncode:
        lines = (done.stderr.strip() or done.stdout.strip() or f"exit code {done.returncode}").splitlines()
        raise Failed(f"{pathlib.Path(str(command[0])).name} {command[1] if len(command) > 1 else ''}: " + "\n".join(lines[-5:]))
    return done


def prepare(program, scene, folder, size):
    """Writes the scene as pbrt-v4 into `folder`, which Restage reads back unchanged, then changes film and filter.

    Returns the file and what the export lost."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "scene.pbrt"
    report = run([program, "convert", scene, file, "--set", "textures=absolute"]).stderr
    text = re.sub(r"^PixelFilter .*$", 'PixelFilter "box" "float xradius" [ 0.5 ] "float yradius" [ 0.5 ]', file.read_text(), flags=re.M)
    film = f'Film "rgb" "integer xresolution" [ {size[0]} ] "integer yresolution" [ {size[1]} ] "string filename" [ "scene.pfm" ]'
    file.write_text(re.sub(r"^Film .*$", film, text, count=1, flags=re.M))
    return file, losses(report)


def losses(log):
    return [line.split(": ", 2)[-1] for line in log.splitlines() if re.search(r": (approximated|dropped): ", line)]
