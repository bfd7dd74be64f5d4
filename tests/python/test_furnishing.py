# SPDX-License-Identifier: Apache-2.0
"""The bundled room and the parts to furnish it with: they open without loss, and stand where scenes/README.md says."""

import pathlib

import numpy as np
import pytest

import restage

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
PARTS = sorted((SCENES / "parts").glob("*.pbrt"))
HUNG = {"ceiling-lamp", "curtains", "framed-picture"}


@pytest.fixture(scope="module")
def room():
    with restage.open(SCENES / "room/room.pbrt") as session:
        yield session


@pytest.mark.parametrize("path", [SCENES / "room/room.pbrt", *PARTS], ids=lambda p: p.stem)
def test_it_opens_without_loss(path):
    with restage.open(path) as session:
        lost = [entry for entry in session.report.entries if entry.fate != "kept"]
        assert not lost, lost


@pytest.mark.parametrize("path", PARTS, ids=lambda p: p.stem)
def test_a_part_stands_at_the_origin(room, path):
    before = len(room.history)
    part = room.insert(path)
    (x0, y0, z0), (x1, y1, z1) = np.asarray(part.bounds)
    if path.stem == "ceiling-lamp":
        assert -0.01 < z1 <= 0, "it touches the ceiling"
    elif path.stem == "framed-picture":
        assert abs(z0 + z1) < 0.01
    else:
        assert abs(z0) < 0.025
    if path.stem in HUNG - {"ceiling-lamp"}:
        assert -0.02 < y1 <= 0.001, "its back is at the wall"
    else:
        assert abs(y0 + y1) < 0.5 * (y1 - y0)
    assert abs(x0 + x1) < 0.2 * (x1 - x0)
    assert 0.1 < max(x1 - x0, y1 - y0, z1 - z0) < 3, "in metres"
    while len(room.history) > before:
        room.undo()


@pytest.mark.parametrize("name", ["table-lamp", "ceiling-lamp"])
def test_lamps_shine(room, name):
    before = len(room.history)
    lamp = room.insert(SCENES / f"parts/{name}.pbrt")
    assert [thing.name for thing in lamp.objects if thing.emission] == ["Bulb"]
    while len(room.history) > before:
        room.undo()
