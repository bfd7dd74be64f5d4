# SPDX-License-Identifier: Apache-2.0
"""Callbacks that return False: restage.Cancelled if there is no partial result, and no files remain."""
import json
import os
import shutil

import pytest

import restage


@pytest.fixture(scope="module")
def waits(tmp_path_factory, program):
    """The type of a denoiser that runs until it is cancelled."""
    folder = tmp_path_factory.mktemp("plugins") / "waits"
    folder.mkdir()
    shutil.copy(program.parents[1] / "tests/plugins_bad/denoiser_waits.so", folder / "waits.so")
    (folder / "plugin.json").write_text(json.dumps({
        "id": "org.example.denoiser.waits", "provides": ["restage.denoiser/1"], "version": "1.0.0", "licence": "MIT",
        "needs": {"host": ">=0.2"}, "library": "waits"}))
    restage.load_plugins(folder.parent)
    return "waits"


@pytest.fixture
def stop():
    """A callback that stops immediately, and records its arguments."""
    def callback(*told):
        callback.told.append(told)
        return False

    callback.told = []
    return callback


def stopped(stop, call, *arguments, **more):
    with pytest.raises(restage.Cancelled) as cancelled:
        call(*arguments, progress=stop, **more)
    assert isinstance(cancelled.value, restage.Error) and str(cancelled.value)
    assert len(stop.told) == 1, "it is not called again"


def fails(*told):
    raise ZeroDivisionError("mine")


@pytest.mark.parametrize("file", ["demo/demo.pbrt", "demo/geometry/pear.ply"])
def test_opening(scenes, stop, file):
    stopped(stop, restage.open, scenes / file)
    with pytest.raises(ZeroDivisionError, match="mine"):
        restage.open(scenes / file, progress=fails)


def test_opening_a_project(scenes, stop, tmp_path):
    with restage.open(scenes / "cornell/cornell.pbrt") as session:
        session.save(tmp_path / "p.restage")
    stopped(stop, restage.open, tmp_path / "p.restage")


def test_inserting(cornell, scenes, stop):
    objects = len(cornell.objects)
    stopped(stop, cornell.insert, scenes / "demo/geometry/pear.ply")
    assert len(cornell.objects) == objects and not cornell.modified


def test_exporting(cornell, stop, tmp_path):
    kept = tmp_path / "kept.pbrt"
    kept.write_text("what was there")
    stopped(stop, cornell.export, kept)
    assert kept.read_text() == "what was there" and os.listdir(tmp_path) == ["kept.pbrt"]
    with pytest.raises(ZeroDivisionError, match="mine"):
        cornell.export(kept, progress=fails)
    assert kept.read_text() == "what was there"


def test_denoising(cornell, stop, waits):
    picture = cornell.render(size=(16, 16), samples=2)
    color = picture.color.copy()
    stopped(stop, picture.denoise, denoiser=waits)
    assert stop.told == [(0.5,)]
    assert picture.denoised is None and picture.denoiser == "none" and (picture.color == color).all()
    asked = []
    with pytest.raises(restage.Cancelled):
        picture.denoise(denoiser=waits, progress=lambda fraction: asked.append(fraction) or len(asked) < 3)
    assert asked == [0.5] * 3, "None and True continue"
    with pytest.raises(ZeroDivisionError, match="mine"):
        picture.denoise(denoiser=waits, progress=fails)
    assert picture.denoise(progress=lambda fraction: True).denoised is not None, "and it still works"
    before = picture.denoised.copy()
    with pytest.raises(restage.Cancelled):
        picture.denoise(denoiser=waits, progress=lambda fraction: False)
    assert (picture.denoised == before).all() and picture.denoiser.startswith("oidn")


def test_rendering_returns_what_there_is(cornell, waits):
    """A picture of fewer samples is valid: no exception, and `finished` is False."""
    picture = cornell.render(size=(16, 16), samples=1 << 20, progress=lambda p: p.samples < 2)
    assert not picture.finished and 2 <= picture.samples < 1 << 20
    picture = cornell.render(size=(16, 16), samples=2, denoise=True, denoiser=waits, progress=lambda p: p.samples < 2)
    assert not picture.finished and picture.samples == 2 and picture.denoised is None
    with pytest.raises(ZeroDivisionError, match="mine"):
        cornell.render(size=(16, 16), samples=2, denoise=True, denoiser=waits, progress=fails_after_the_samples)


def fails_after_the_samples(progress):
    return fails() if progress.samples >= 2 else None
