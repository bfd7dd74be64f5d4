# SPDX-License-Identifier: Apache-2.0
"""A material that looks up a file: its picture and report if the file is valid, missing, broken and changed."""

import os

import numpy as np
import pytest
import restage

SCENE = """LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "measured" "string filename" "lambert.binary"
Shape "disk" "float radius" 4
"""


def write_lambert(file, albedo, counts=(6, 5, 4)):
    planes = [np.full(counts, albedo / np.pi / scale) for scale in (1 / 1500, 1.15 / 1500, 1.66 / 1500)]
    file.write_bytes(np.array(counts, "<i4").tobytes() + np.array(planes, "<f8").tobytes())
    return file


@pytest.fixture
def session(tmp_path):
    write_lambert(tmp_path / "lambert.binary", 0.7)
    (tmp_path / "scene.pbrt").write_text(SCENE)
    with restage.open(tmp_path / "scene.pbrt") as opened:
        yield opened


def mean(session):
    return float(np.asarray(session.render(samples=64, denoise=False).color).mean())


def test_the_picture_follows_the_file(session, tmp_path, caplog):
    material = session.materials[0]
    assert material["filename"] == str(tmp_path / "lambert.binary")
    assert mean(session) == pytest.approx(0.7, abs=0.01)
    material["filename"] = write_lambert(tmp_path / "dark.binary", 0.2)
    assert mean(session) == pytest.approx(0.2, abs=0.01)
    # Missing and broken: grey, reported once, and the scene still renders.
    material["filename"] = tmp_path / "gone.binary"
    assert mean(session) == pytest.approx(0.5, abs=0.01)
    assert "gone.binary: cannot be opened: No such file or directory; shown as grey" in caplog.text
    (tmp_path / "text.binary").write_text("this is no table of doubles")
    material["filename"] = str(tmp_path / "text.binary")
    assert mean(session) == pytest.approx(0.5, abs=0.01)
    assert "text.binary: is text, not a MERL file" in caplog.text
    for expected in (0.5, 0.2, 0.7):
        session.undo()
        assert mean(session) == pytest.approx(expected, abs=0.01)
    # A changed file is read again with the next edit of a material.
    dark = write_lambert(tmp_path / "lambert.binary", 0.4)
    os.utime(dark, (dark.stat().st_atime, dark.stat().st_mtime + 2))
    material["tint"] = (1, 1, 0.999)
    assert mean(session) == pytest.approx(0.4, abs=0.01)
    # Broken, fixed, broken again: reported each time, but not with each edit.
    caplog.clear()
    for n, (text, expected) in enumerate([("no table", 0.5), ("", 0.5), (None, 0.4), ("no table", 0.5)]):
        if text is None:
            write_lambert(dark, 0.4)
        elif text:
            dark.write_text(text)
        os.utime(dark, (dark.stat().st_atime, dark.stat().st_mtime + 4 + 2 * n))
        material["tint"] = (1, 1, 0.998 - 0.001 * n)
        assert mean(session) == pytest.approx(expected, abs=0.01)
    assert caplog.text.count("shown as grey") == 2
    with pytest.raises(restage.Error, match="expected the path of a file, not 3"):
        material["filename"] = 3
    del material["filename"]
    assert material["filename"].endswith("glossy_paint.binary")


def test_both_tracers_and_the_lab_read_it(session, tmp_path):
    pictures = [session.render(samples=16, denoise=False, tracer=t, seed=2).color for t in ("embree", "vulkan")]
    assert np.abs(pictures[0] - pictures[1]).max() < 1e-4
    up = np.array([[0.3, 0.2, 0.933]])
    f = restage.Bsdf("measured").eval(up, up, {"filename": tmp_path / "lambert.binary"})
    assert f[0, 1] == pytest.approx(0.7 / np.pi * 0.933, rel=1e-3)


def test_the_report_names_what_is_missing(session, tmp_path):
    assert "looks up" in str([e.note for e in session.report.entries])
    (tmp_path / "lambert.binary").unlink()
    with restage.open(tmp_path / "scene.pbrt") as again:
        assert any(e.fate == "dropped" and "lambert.binary: cannot be opened" in e.note for e in again.report.entries)
        assert mean(again) == pytest.approx(0.5, abs=0.01)
