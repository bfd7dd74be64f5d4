# SPDX-License-Identifier: Apache-2.0
"""Restage: open 3D scenes, change them, path-trace them, write them back.

    import restage

    with restage.open("room.pbrt") as session:
        session.find("Chair").duplicate(by=(1.2, 0, 0)).rotate(30)
        session.materials["Wall paint"]["reflectance"] = (0.07, 0.17, 0.19)
        picture = session.render(size=(640, 360), samples=64, denoise=True)
        picture.save("room.png")
        wall = picture.mask(session.materials["Wall paint"])  # bool (H, W)
        session.undo()
        session.export("edited.pbrt")

Lengths are in the scene's own unit, angles in degrees, colours linear sRGB. Every change goes through the session's
history, as in the editor. Failures raise restage.Error with a one-sentence message. The engine's warnings go to
Python's logger "restage".
"""
import pathlib as _pathlib

from . import _core, _sentences

_sentences.install(_core)  # before its functions get their public names

from ._core import (
    Action, ActionResult,
    Camera, Cameras, CameraView, Cancelled, Error, Group, Groups, Light, Lights, Material, Materials, Object, Objects, Parameter, Picture,
    Plugin, Progress, Report, ReportEntry, Selection, Session, Sky, Step, Texture, Textures,
    load_plugins, material_types, merge, new, open, plugins, reload_plugins, sky_types, texture_types,
)
from .bsdf import Bsdf, BsdfSample
from . import spread
from .presets import Preset, presets
from .checking import CheckReport, CheckStep, check

__version__ = _core.version()

_here = _pathlib.Path(__file__).parent
# In a wheel everything is inside the package; in a build tree or an installed one the package is lib/python/restage.
_core.set_home(_here if (_here / "share").is_dir() else _pathlib.Path(_core.__file__).parents[3])



def _program() -> _pathlib.Path:
    """The program `restage` of this installation."""
    program = _pathlib.Path(_core.home()) / "bin" / "restage"
    if not program.exists():
        raise Error(f"{program}: the program is missing; the installation is incomplete")
    return program


def bundled_scene(name: str) -> _pathlib.Path:
    """Path of a scene that comes with Restage: demo (a room), room (an empty one), cornell or spheres."""
    path = _pathlib.Path(_core.home()) / "share/restage/scenes" / f"{name}" / f"{name}.pbrt"
    if not path.exists():
        names = sorted(p.parent.name for p in path.parents[1].glob("*/*.pbrt") if p.parent.name == p.stem)
        raise Error(f"there is no bundled scene \"{name}\"; known: {', '.join(names)}")
    return path


__all__ = [
    "Action", "ActionResult",
    "Bsdf", "BsdfSample", "Camera", "Cameras", "CameraView", "Cancelled", "CheckReport", "CheckStep", "Error", "Group", "Groups", "Light", "Lights", "Material", "Materials",
    "Object", "Objects", "Parameter", "Picture", "Plugin", "Preset", "Progress", "Report", "ReportEntry", "Selection", "Session",
    "Sky", "Step", "Texture", "Textures", "bundled_scene", "check", "load_plugins", "material_types", "merge", "new", "open", "plugins", "presets", "reload_plugins",
    "sky_types", "spread", "texture_types",
]
