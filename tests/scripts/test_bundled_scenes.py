# SPDX-License-Identifier: Apache-2.0
"""The bundled scenes are complete: every file they name exists and is valid, and the generators still write them."""

import importlib
import json
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
ENTRIES = sorted(SCENES.glob("*/*.pbrt"))
MESHES = sorted(SCENES.glob("*/geometry/*.ply"))
PARTS = sorted((SCENES / "parts").glob("*.pbrt"))


def read_ply(path):
    """Positions, normals, uvs, triangles of the binary PLY that tools/demo_scene/mesh.py writes."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    vertices, faces = (int(n) for n in re.findall(rb"element \w+ (\d+)", head))
    floats = np.frombuffer(body, "<f4", vertices * 8).reshape(-1, 8)
    face = np.dtype([("count", "u1"), ("index", "<i4", 3)])
    assert len(body) == vertices * 32 + faces * face.itemsize
    return floats[:, :3], floats[:, 3:6], floats[:, 6:], np.frombuffer(body, face, faces, vertices * 32)["index"]


@pytest.mark.parametrize("path", ENTRIES, ids=lambda p: p.name)
def test_every_named_thing_exists(path):
    text = path.read_text()
    for name in re.findall(r'(?:"string filename" \[ |Include )"([^"]+)"', text):
        assert name.endswith(".exr") or (path.parent / name).is_file(), name
    whole = (
        text if path.parent.name in ("room", "parts") else "".join(p.read_text() for p in path.parent.glob("*.pbrt"))
    )
    for use, definition in (
        (r'ObjectInstance "([^"]+)"', r'ObjectBegin "([^"]+)"'),
        (r'\n *NamedMaterial "([^"]+)"', r'MakeNamedMaterial "([^"]+)"'),
        (r'"texture \w+" \[ "([^"]+)" \]', r'Texture "([^"]+)"'),
    ):
        assert set(re.findall(use, whole)) == set(re.findall(definition, whole))


@pytest.mark.parametrize("scene", ["demo", "room", "parts"])
def test_no_file_is_unused(scene):
    text = "".join(p.read_text() for p in (SCENES / scene).glob("*.pbrt"))
    for path in [*(SCENES / scene).glob("geometry/*"), *(SCENES / scene).glob("textures/*")]:
        assert f'"{path.parent.name}/{path.name}"' in text, path


def test_names_are_unique():
    text = (SCENES / "demo" / "demo.pbrt").read_text()
    names = re.findall(r"^# name: (.+)$", text, re.M)
    assert len(names) == len(set(names)) > 50
    assert {"Table", "Chair", "Chair 3", "Carafe", "Vase", "Sun", "Sky"} <= set(names)


def test_assets_exist_and_comprise_all_parts():
    """The Assets panel leaves out what is missing, and inserts "meshes"."""
    listed = json.loads((SCENES / "assets.json").read_text())
    for name in (name for names in listed.values() for name in names):
        assert (SCENES / name).is_file(), name
    assert {SCENES / name for name in listed["meshes"]} >= set(PARTS) and "room/room.pbrt" in listed["scenes"]


def test_the_parts_are_small():
    assert sum(p.stat().st_size for p in (SCENES / "parts").rglob("*") if p.is_file()) < 3_000_000


@pytest.mark.parametrize("path", MESHES, ids=lambda p: p.stem)
def test_mesh_is_sound(path):
    v, n, uv, f = read_ply(path)
    assert np.isfinite(v).all() and np.isfinite(uv).all() and f.min() == 0 and f.max() == len(v) - 1
    assert np.abs(np.linalg.norm(n, axis=1) - 1).max() < 1e-4
    face = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    area = np.linalg.norm(face, axis=1)
    assert area.min() > 0
    agree = np.einsum("ij,ij->i", face, n[f].mean(1)) / area
    assert area[agree < 0].sum() < 1e-4 * area.sum()  # windings follow the normals


NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])")


def assert_same(folder, anew, texts=("demo.pbrt", "objects.pbrt", "materials.pbrt")):
    """Equal up to rounding: a unit of the sixth digit in texts, and of the last bit of a float (2^-23) in meshes,
    where 1e-9 allows for the loss of doubles (1e-16 a step, times the metres, over the shortest edges of 1e-4 m)."""
    for name in texts:
        ours, theirs = (p.read_text() for p in (folder / name, anew / name))
        assert NUMBER.sub("#", ours) == NUMBER.sub("#", theirs), name
        a, b = (np.array([float(x) for x in NUMBER.findall(text)]) for text in (ours, theirs))
        assert np.allclose(a, b, rtol=1.01e-5, atol=1.01e-9), name
    ours, theirs = ({p.name for p in (f / "geometry").iterdir()} for f in (folder, anew))
    assert ours == theirs
    for name in sorted(ours):
        for a, b in zip(read_ply(folder / "geometry" / name), read_ply(anew / "geometry" / name), strict=True):
            assert a.shape == b.shape and np.allclose(a, b, rtol=1.2e-7, atol=1e-9), name


def test_generator_writes_the_same_scene(tmp_path):
    subprocess.run([sys.executable, ROOT / "tools" / "make_demo_scene.py", tmp_path], check=True, capture_output=True)
    assert_same(SCENES / "demo", tmp_path / "demo")


def assert_same_room(anew):
    assert {p.name for p in (anew / "parts").glob("*.pbrt")} == {p.name for p in PARTS}
    assert_same(SCENES / "room", anew / "room", ["room.pbrt"])
    assert_same(SCENES / "parts", anew / "parts", [p.name for p in PARTS])


def test_generator_writes_the_same_room_and_parts(tmp_path):
    for name in ("one", "two"):
        subprocess.run(
            [sys.executable, ROOT / "tools" / "make_room_scene.py", tmp_path / name], check=True, capture_output=True
        )
    assert_same_room(tmp_path / "one")
    for path in sorted(p for p in (tmp_path / "one").rglob("*") if p.is_file()):  # to the bit on one machine
        assert path.read_bytes() == (tmp_path / "two" / path.relative_to(tmp_path / "one")).read_bytes(), path


@pytest.mark.parametrize("seed", range(2))
def test_no_shape_depends_on_the_last_bits_of_a_library(seed, tmp_path, monkeypatch):
    """Sines, powers and lengths off by up to 4 ulp, as between processors and libraries."""
    monkeypatch.syspath_prepend(ROOT / "tools")
    generator, rooms = importlib.import_module("make_demo_scene"), importlib.import_module("make_room_scene")
    random = np.random.default_rng(seed)

    def shaken(function):
        def call(*args, **kwargs):
            exact = np.asarray(function(*args, **kwargs))
            return exact * (1 + random.integers(-4, 5, exact.shape) * 2.0**-53)

        return call

    for owner, names in ((np, ("sin", "cos", "tan", "arccos", "exp", "power", "cross")), (np.linalg, ("norm", "inv"))):
        for name in names:
            monkeypatch.setattr(owner, name, shaken(getattr(owner, name)))
    scene = generator.Scene(tmp_path / "demo")
    generator.furnish(scene)
    generator.write(scene)
    assert_same(SCENES / "demo", tmp_path / "demo")
    rooms.main(tmp_path)
    assert_same_room(tmp_path)
