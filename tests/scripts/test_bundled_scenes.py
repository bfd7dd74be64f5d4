# SPDX-License-Identifier: Apache-2.0
"""The bundled scenes are whole: every file they name is there and sound, and the generator still writes them."""

import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
ENTRIES = sorted(SCENES.glob("*/*.pbrt"))


def read_ply(path):
    """Positions, normals, triangles of the binary PLY that tools/demo_scene/mesh.py writes."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    vertices, faces = (int(n) for n in re.findall(rb"element \w+ (\d+)", head))
    floats = np.frombuffer(body, "<f4", vertices * 8).reshape(-1, 8)
    face = np.dtype([("count", "u1"), ("index", "<i4", 3)])
    assert len(body) == vertices * 32 + faces * face.itemsize
    return floats[:, :3], floats[:, 3:6], np.frombuffer(body, face, faces, vertices * 32)["index"]


@pytest.mark.parametrize("path", ENTRIES, ids=lambda p: p.name)
def test_every_named_thing_exists(path):
    text = path.read_text()
    for name in re.findall(r'(?:"string filename" \[ |Include )"([^"]+)"', text):
        assert name.endswith(".exr") or (path.parent / name).is_file(), name
    whole = "".join(p.read_text() for p in path.parent.glob("*.pbrt"))
    for use, definition in (
        (r'ObjectInstance "([^"]+)"', r'ObjectBegin "([^"]+)"'),
        (r'\n *NamedMaterial "([^"]+)"', r'MakeNamedMaterial "([^"]+)"'),
        (r'"texture \w+" \[ "([^"]+)" \]', r'Texture "([^"]+)"'),
    ):
        assert set(re.findall(use, whole)) == set(re.findall(definition, whole))


def test_no_file_lies_about_unused():
    for folder in ("geometry", "textures"):
        text = "".join(p.read_text() for p in (SCENES / "demo").glob("*.pbrt"))
        for path in (SCENES / "demo" / folder).iterdir():
            assert f'"{folder}/{path.name}"' in text, path


def test_names_are_unique():
    text = (SCENES / "demo" / "demo.pbrt").read_text()
    names = re.findall(r"^# name: (.+)$", text, re.M)
    assert len(names) == len(set(names)) > 50
    assert {"Table", "Chair", "Chair 3", "Carafe", "Vase", "Sun", "Sky"} <= set(names)


@pytest.mark.parametrize("path", sorted((SCENES / "demo" / "geometry").glob("*.ply")), ids=lambda p: p.stem)
def test_mesh_is_sound(path):
    v, n, f = read_ply(path)
    assert np.isfinite(v).all() and f.min() == 0 and f.max() == len(v) - 1
    assert np.abs(np.linalg.norm(n, axis=1) - 1).max() < 1e-4
    face = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    area = np.linalg.norm(face, axis=1)
    assert area.min() > 0
    agree = np.einsum("ij,ij->i", face, n[f].mean(1)) / area
    assert area[agree < 0].sum() < 1e-4 * area.sum()  # windings follow the normals


def test_generator_writes_the_same_scene(tmp_path):
    subprocess.run([sys.executable, ROOT / "tools" / "make_demo_scene.py", tmp_path], check=True, capture_output=True)
    for name in ("demo.pbrt", "objects.pbrt", "materials.pbrt"):
        assert (tmp_path / "demo" / name).read_text() == (SCENES / "demo" / name).read_text(), name
    for path in sorted((SCENES / "demo" / "geometry").glob("*.ply")):
        for ours, anew in zip(read_ply(path), read_ply(tmp_path / "demo" / "geometry" / path.name), strict=True):
            assert ours.shape == anew.shape and np.allclose(ours, anew, atol=1e-5), path.name
