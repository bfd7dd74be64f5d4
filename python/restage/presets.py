# SPDX-License-Identifier: Apache-2.0
"""Material presets: JSON files, of which Restage comes with some (share/restage/materials)."""
import json
import os
import pathlib
from typing import NamedTuple

from . import _core


class Preset(NamedTuple):
    """A file of a material: session.add_preset(preset.path)."""
    name: str
    category: str  # what it is: "Metal"
    type: str  # of its material
    source: str  # of its numbers
    path: pathlib.Path


def presets(folder: str | os.PathLike | None = None) -> list[Preset]:
    """The presets in a folder, by category and name; None: those that come with Restage."""
    at = pathlib.Path(folder) if folder is not None else pathlib.Path(_core.home()) / "share/restage/materials"
    found = []
    for path in sorted(at.glob("*.json")):
        try:
            data = json.loads(path.read_text(encoding="utf-8"))
            found.append(Preset(data["name"], data["category"], data["type"], data.get("source", ""), path))
        except (ValueError, KeyError, TypeError) as error:
            raise _core.Error(f"{path}: not a material preset: {error}") from None
    return sorted(found, key=lambda preset: (preset.category, preset.name))
