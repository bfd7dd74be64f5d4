# SPDX-License-Identifier: Apache-2.0
"""Writes a scene as pbrt-v4 text: named textures and materials, objects (ObjectBegin) and their named placements."""

import shutil

import numpy as np

from .mesh import write_ply


def numbers(values):
    """Six digits; mere rounding (the cosine of a right angle) is 0, not 1.11022e-16."""
    return " ".join(f"{float(x):.6g}" for x in np.round(np.ravel(np.asarray(values, float)), 9) + 0.0)


def note(generator):
    return f"# SPDX-License-Identifier: CC0-1.0\n# Written by {generator}: edit that, or this; not both.\n"


def emptied(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)


class Scene:
    textures = "textures"

    def __init__(self, folder):
        emptied(folder / "geometry")
        emptied(folder / "textures")
        self.begin(folder)

    def begin(self, folder):
        self.folder = folder
        self.materials, self.objects, self.placings, self.count, self.triangles = [], [], [], {}, 0

    def section(self, title):
        for lines in (self.materials, self.objects, self.placings):
            if lines and lines[-1].startswith("\n# ---"):
                lines.pop()
            lines.append(f"\n# --- {title}")

    def texture(self, name, kind, filename, **params):
        """kind is spectrum or float; params become \"string x\" or \"float x\"."""
        lines = [f'Texture "{name}" "{kind}" "imagemap"', f'    "string filename" [ "{self.textures}/{filename}" ]']
        for key, value in params.items():
            lines.append(
                f'    "string {key}" [ "{value}" ]' if isinstance(value, str) else f'    "float {key}" [ {value} ]'
            )
        self.materials.append("\n".join(lines))

    def material(self, name, kind, **params):
        """A parameter: rgb triple, number, ('texture', name), or a string (a named spectrum)."""
        lines = [f'MakeNamedMaterial "{name}"', f'    "string type" [ "{kind}" ]']
        for key, value in params.items():
            if isinstance(value, tuple) and value[0] == "texture":
                lines.append(f'    "texture {key}" [ "{value[1]}" ]')
            elif isinstance(value, str):
                lines.append(f'    "spectrum {key}" [ "{value}" ]')
            elif np.ndim(value) == 1:
                lines.append(f'    "rgb {key}" [ {numbers(value)} ]')
            else:
                lines.append(f'    "float {key}" [ {numbers(value)} ]')
        self.materials.append("\n".join(lines))

    def mesh(self, name, mesh):
        write_ply(self.folder / "geometry" / f"{name}.ply", mesh)
        self.triangles += len(mesh.f)
        return f'Shape "plymesh"\n        "string filename" [ "geometry/{name}.ply" ]'

    def object(self, name, *parts):
        """parts: (material, shape text as mesh() returns it, the part's name)."""
        lines = [f'ObjectBegin "{name}"']
        for material, shape, label in parts:
            lines += [f"    # name: {label}", f'    NamedMaterial "{material}"', f"    {shape}"]
        self.objects.append("\n".join(lines + ["ObjectEnd"]))

    def place(self, name, matrix=None):
        """Another instance of an object; the second chair is called "Chair 2", as in the importer."""
        self.count[name] = self.count.get(name, 0) + 1
        label = name if self.count[name] == 1 else f"{name} {self.count[name]}"
        lines = [f"# name: {label}", "AttributeBegin"]
        if matrix is not None:  # pbrt writes matrices column by column
            lines.append(f"    ConcatTransform [ {numbers(np.asarray(matrix).T)} ]")
        self.placings.append("\n".join(lines + [f'    ObjectInstance "{name}"', "AttributeEnd"]))

    def write(self, filename, head, lights):
        top = note("tools/make_demo_scene.py")
        (self.folder / "materials.pbrt").write_text(top + "\n".join(self.materials) + "\n")
        (self.folder / "objects.pbrt").write_text(top + "\n".join(self.objects) + "\n")
        (self.folder / filename).write_text(
            top
            + head
            + "\nWorldBegin\n"
            + lights
            + '\nInclude "materials.pbrt"\nInclude "objects.pbrt"\n'
            + "\n".join(self.placings)
            + "\n"
        )


class Piece(Scene):
    """A scene of one file, next to others in a folder; its textures are those of the demo scene in the next folder."""

    textures = "../demo/textures"

    def __init__(self, folder, demo_meshes=False):
        """With demo_meshes the meshes are the demo scene's, too, and not written again."""
        (folder / "geometry").mkdir(parents=True, exist_ok=True)
        self.begin(folder)
        self.demo_meshes = demo_meshes

    def mesh(self, name, mesh):
        if not self.demo_meshes:
            return super().mesh(name, mesh)
        self.triangles += len(mesh.f)
        return f'Shape "plymesh"\n        "string filename" [ "../demo/geometry/{name}.ply" ]'

    def shape(self, name, material, shape, emission=None, at=None):
        """One thing without ObjectBegin: pbrt's objects cannot emit. emission: radiance, rgb; at: its centre [m]."""
        lines = [f"# name: {name}", "AttributeBegin", f'    NamedMaterial "{material}"']
        if emission is not None:
            lines += ['    AreaLightSource "diffuse"', f'        "rgb L" [ {numbers(emission)} ]']
        if at is not None:
            lines.append(f"    Translate {numbers(at)}")
        self.placings.append("\n".join(lines + [f"    {shape}", "AttributeEnd"]))

    def write(self, filename, head="", lights=""):
        blocks = [note("tools/make_room_scene.py") + head + "\nWorldBegin\n" + lights]
        (self.folder / filename).write_text("\n".join(blocks + self.materials + self.objects + self.placings) + "\n")
