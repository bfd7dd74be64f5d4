# SPDX-License-Identifier: Apache-2.0
"""The table "to add X, touch Y" of ARCHITECTURE.md: a new layer of the film, tracer or kind of thing is named in
the documented places, and nowhere else."""
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = {".cpp", ".hpp", ".glsl", ".comp", ".rgen", ".rchit", ".rahit", ".rmiss", ".h"}
LAYERS = (ROOT / "engine/render/film_layers.hpp").read_text()


def naming(pattern, *folders):
    """The files below the folders that contain the pattern."""
    return {str(p.relative_to(ROOT)) for f in folders for p in (ROOT / f).rglob("*")
            if p.suffix in SOURCES and re.search(pattern, p.read_text())}


def guides():
    """(field of GuidePixel, name, layer in files, label in menus) of each layer that a path fills."""
    rows = re.findall(r'\.name = "(\w*)".*?\.in_file = "(\w*)".*?\.guide = (.*?),\s*\.look.*?\.label = "(\w*)"', LAYERS, re.S)
    return [(re.search(r"g\.(\w+)", guide).group(1), name, file, label) for name, file, guide, label in rows if "g." in guide]


def test_layers_of_the_film_are_found_here():
    assert {g[0] for g in guides()} == {"albedo", "normal", "depth", "coverage", "instance_id", "material_id",
                                     "caught", "shade", "without", "backdrop"}


@pytest.mark.parametrize("field, name, file, label", guides())
def test_a_layer_of_the_film_is_named_in_four_files(field, name, file, label):
    shaders = naming(rf"\b(g|a|guide|guides\.at\[i\])\.{field}\b", "shaders")
    assert shaders <= {"shaders/path/film.glsl", "shaders/path/step.glsl", "shaders/check_lab.glsl"}  # the lab's is a BSDF's
    words = "|".join({name, file} - {"", "id"})
    assert naming(rf'"({words})"', "engine/render", "engine/view", "app/commands", "python/src") <= {"engine/render/film_layers.hpp"}
    if not label:  # not in menus
        return
    assert naming(rf'"{label}"', "engine/render", "engine/view", "app/commands") <= {"engine/render/film_layers.hpp"}
    assert f'"{label}"' not in (ROOT / "app/editor/viewport_notes.cpp").read_text()


def test_a_tracer_is_named_in_the_list_and_its_file():
    names = re.findall(r'\.name = "(\w+)"', (ROOT / "engine/render/tracers.cpp").read_text())
    assert len(names) >= 2
    for name in names:
        assert naming(rf'"{name}"', "engine", "app", "python/src") == {"engine/render/tracers.cpp", f"engine/render/{name}_tracer.cpp"}


def test_the_tables_of_a_scene_are_listed_once():
    tables = re.findall(r"^    Table<\w+> (\w+);", (ROOT / "engine/scene/scene.hpp").read_text(), re.M)
    assert len(tables) == 9
    for table in tables:
        assert naming(rf"&Scene::{table}\b", "engine", "app", "python/src") == {"engine/scene/tables.hpp"}


def test_a_kind_of_light_is_named_in_its_row_and_its_formula():
    kinds = re.findall(r"\{LightKind::(\w+),", (ROOT / "engine/scene/light_kinds.hpp").read_text())
    assert kinds[0] == "point" and len(kinds) >= 3
    row = "engine/scene/light_kinds.hpp"
    for kind in kinds[1:]:  # the first is the default of a Light
        assert naming(rf"LightKind::{kind}\b", "engine", "app", "python/src") == {row}
        assert naming(rf'"{kind}"', "engine", "app", "python/src") == {row}
        assert naming(rf"LAMP_{kind.upper()}\b", "engine", "shaders", "app") == {"shaders/shared/lamps.h"}
        assert naming(rf"RESTAGE_LIGHT_{kind.upper()}\b", "engine", "app", "python/src") == {"engine/sdk/restage/scene_io.h"}
def test_no_texture_type_is_named_by_the_engine():
    types = {p.name for p in (ROOT / "plugins/textures").iterdir()}
    assert {"imagemap", "checkerboard", "fbm"} <= types
    for type in types - {"scale"}:  # also the name of a field in files
        assert naming(rf'"{type}"', "engine/plugin", "shaders") == set()
    for type in types - {"scale", "mix", "constant"}:
        assert naming(rf'"{type}"', "engine/render") == set()
