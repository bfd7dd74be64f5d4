# SPDX-License-Identifier: Apache-2.0
"""A million samples without drift; and what does not change a picture: threads, order and batches."""
import pathlib
import subprocess
import sys

import numpy as np
import pytest
from conftest import BIN
from stage import diffuse, glass, lamp, rectangle_form, sky, square, within

import restage

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scripts"))
import exr_file  # noqa: E402

MILLION = 1 << 20


def test_a_million_equal_samples_are_their_mean(stage):
    """Radiance 0.7 in each of 2^20 samples: sums in single precision would lose up to 6 %, always in the same direction."""
    found = stage.render(sky(0.7), size=(1, 1), samples=MILLION)
    assert found.picture.samples == MILLION
    found.is_everywhere(0.7, 1e-6)
    assert found.picture.std_error.max() < 0.7 * 1e-6


def test_a_million_random_samples_reach_the_closed_form(stage):
    """The lamp over a plane to four digits: neither sums nor random numbers have a bias that shows."""
    body = diffuse(0.5) + square(0.05) + lamp(3, square(0.5, 1.5, up=False))
    found = stage.render(body, size=(1, 1), samples=MILLION)
    expected = 1.5 * rectangle_form(-0.5, 0.5, -0.5, 0.5, 1.5)
    found.is_mean(expected, 3e-5, sharp=2e-4)  # directions are floats


BODY = (sky(0.2) + diffuse(0.5) + square(2) + lamp(3, square(0.3, 1.5, up=False)) +
        within("Translate 0.3 0 0.3", glass(1.5) + 'Shape "sphere" "float radius" 0.25\n') +
        within("Translate -0.4 0.1 0.3", 'Material "conductor" "float roughness" 0.1\nShape "sphere" "float radius" 0.25\n'))
LOOK = {"eye": (0, -2.5, 1.2), "up": (0, 0, 1), "at": (0, 0, 0.2), "fov": 40.0, "size": (33, 29), "depth": 6}


def test_threads_and_runs_change_nothing(stage):
    pictures = [stage.render(BODY, samples=8, seed=5, threads=n, **LOOK) for n in (1, 2, 3, 2)]
    for other in pictures[1:]:
        assert np.array_equal(pictures[0].picture.color, other.picture.color)
        assert np.array_equal(pictures[0].picture.std_error, other.picture.std_error)


def test_order_and_batches_change_only_rounding(stage):
    """Sixteen samples at once; in two halves, merged; and of windows of the film, put together."""
    with restage.open(stage.scene(BODY, **LOOK)) as session:
        session.exposure = 1
        whole = session.render(samples=16, seed=5)
        halves = [session.render(samples=8, seed=5, first_sample=k) for k in (8, 0)]
        merged = restage.merge(halves)
        tolerance = 8 * 2 ** -24 * 16 * np.maximum(whole.color, 1)
        assert (np.abs(merged.color - whole.color) <= tolerance).all()
        width, height = session.size
        tiles = np.zeros_like(whole.color)
        for y0, y1 in ((20, 29), (0, 20)):  # from below, and with borders nowhere near a power of two
            for x0, x1 in ((17, 33), (0, 17)):
                session.crop = (x0 / width, x1 / width, y0 / height, y1 / height)
                tiles[y0:y1, x0:x1] = session.render(samples=16, seed=5).color
        assert np.array_equal(tiles, whole.color)


@pytest.mark.parametrize("options", [[], ["--caustics", "on"], ["--spectral"]], ids=" ".join)
def test_a_resumed_rendering_is_the_uninterrupted_one(stage, tmp_path, options):
    """Parts of 5 and 11 samples: neither maps of photons nor wavelengths may begin anew. A file holds means and errors, from which the sums follow to
    a few roundings of floats."""
    scene = stage.scene(BODY, **LOOK)

    def render(name, *more):
        subprocess.run([BIN, "--quiet", "render", scene, "-o", tmp_path / name, "--seed", "5", "--tracer", "embree", *options, *more], check=True)
        return exr_file.read(tmp_path / name)

    whole = render("whole.exr", "--spp", "16")
    part = render("part.exr", "--spp", "5")
    resumed = render("resumed.exr", "--spp", "16", "--resume", tmp_path / "part.exr")
    assert not np.allclose(part["G"], whole["G"], rtol=1e-3)
    for channel in "RGB":
        assert np.allclose(resumed[channel], whole[channel], rtol=1e-6, atol=1e-7), channel
    assert np.array_equal(resumed["id.instance"], whole["id.instance"])
