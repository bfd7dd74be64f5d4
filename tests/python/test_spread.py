# SPDX-License-Identifier: Apache-2.0
"""Renders spread over Ray's workers: the same picture as one process, also when a worker is lost. Not part of
tools/setup: install `ray` with the package to run them."""
import importlib.util
import os
import pathlib

import numpy as np
import pytest

import restage

needs_ray = pytest.mark.skipif(importlib.util.find_spec("ray") is None,
                               reason="ray is not installed: pip install 'restage[ray]', to spread renders")


def test_samples_are_split_evenly():
    assert restage.spread.split(10, 3) == [(0, 3), (3, 3), (6, 4)]
    assert restage.spread.split(2, 8) == [(0, 1), (1, 1)]


def test_without_ray_it_says_what_to_install(monkeypatch):
    import sys
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(restage.Error, match="pip install"):
        restage.spread.render(restage.bundled_scene("cornell"), samples=4, parts=2)


@pytest.fixture(scope="module")
def ray():
    import ray
    yield ray
    if ray.is_initialized():
        ray.shutdown()


@needs_ray
def test_parts_are_the_whole_also_when_a_worker_dies(ray, tmp_path):
    scene, options = restage.bundled_scene("cornell"), dict(size=(48, 48), seed=9)
    marker = tmp_path / "died"

    def edit(session):
        session.materials[0]["reflectance"] = (0.2, 0.3, 0.4)
        if not marker.exists():
            marker.write_text(str(os.getpid()))
            os._exit(1)  # the first task takes its worker with it

    merged = restage.spread.render(scene, samples=12, parts=4, edit=edit, **options)
    assert marker.exists() and merged.samples == 12
    with restage.open(scene) as session:
        session.materials[0]["reflectance"] = (0.2, 0.3, 0.4)
        whole = session.render(samples=12, **options)
    assert np.allclose(merged.color, whole.color, rtol=1e-5, atol=1e-6)
    # The film keeps sums of squares as floats: where all samples are alike, as on a lamp, their difference is rounding.
    errors = np.abs(merged.std_error.astype(float)**2 - whole.std_error.astype(float)**2)
    assert (errors <= 1e-3 * whole.std_error**2 + 1e-6 * whole.color**2).all()
    assert np.array_equal(merged.object_id, whole.object_id)


@needs_ray
def test_each_gives_every_item_once(ray):
    def mean(seed):
        with restage.open(restage.bundled_scene("cornell")) as session:
            return float(session.render(size=(16, 16), samples=2, seed=seed, threads=1).color.mean())
    results = dict(restage.spread.each(mean, range(4)))
    assert results == {seed: mean(seed) for seed in range(4)}
    def fails(item):
        raise ValueError("mine")
    with pytest.raises(Exception, match="mine"):
        list(restage.spread.each(fails, [1]))
