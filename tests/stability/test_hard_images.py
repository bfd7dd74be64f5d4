# SPDX-License-Identifier: Apache-2.0
"""Textures with values that are not numbers, and images and films of 0x0, 1x1 and 16384 pixels a side."""
import math

import numpy as np
import pytest
from stage import diffuse, distant, square, write_pfm

import restage

LIGHT = distant(math.pi, (0, 0, 1))
SIDE = 16384
BAD = [np.nan, np.inf, -np.inf, 1e38, -1e38, -1.0]


def texture(name, kind, file):
    return f'Texture "{name}" "{kind}" "imagemap" "string filename" "{file}" "string encoding" "linear" "string wrap" "clamp"\n'


MATERIALS = {"reflectance": ("spectrum", 'Material "diffuse" "texture reflectance" "t"\n'),
             "roughness": ("float", 'Material "conductor" "rgb reflectance" [ .5 .5 .5 ] "texture roughness" "t"\n'),
             "displacement": ("float", 'Material "diffuse" "rgb reflectance" [ .5 .5 .5 ] "texture displacement" "t"\n'),
             "transmission": ("spectrum", 'Material "diffusetransmission" "texture transmittance" "t" "rgb reflectance" [ .5 .5 .5 ]\n'),
             "mix": ("float", 'MakeNamedMaterial "a" "string type" "diffuse"\nMakeNamedMaterial "b" "string type" "conductor"\n'
                              'Material "mix" "string materials" [ "a" "b" ] "texture amount" "t"\n'),
             "coat": ("float", 'Material "coateddiffuse" "texture roughness" "t" "rgb reflectance" [ .5 .5 .5 ]\n')}


@pytest.mark.parametrize("slot", MATERIALS)
def test_texels_that_are_no_numbers_stay_local(stage, slot):
    """One texel in 64 is NaN, infinite, huge or negative; the picture is finite, and where texels are numbers it is as without."""
    kind, material = MATERIALS[slot]
    shape = (8, 8, 3) if kind == "spectrum" else (8, 8)
    good = np.full(shape, 0.5)
    bad = good.copy()
    for k, value in enumerate(BAD):
        bad[1 + k // 3 * 5, 1 + k % 3 * 2] = value
    quad = ('Shape "trianglemesh" "point3 P" [ -1 -1 0 1 -1 0 1 1 0 -1 1 0 ] "integer indices" [ 0 1 2 0 2 3 ] '
            '"point2 uv" [ 0 0 1 0 1 1 0 1 ]\n')
    pictures = []
    for name, pixels in (("good.pfm", good), ("bad.pfm", bad)):
        write_pfm(stage.folder / name, pixels)
        body = LIGHT + texture("t", kind, name) + material + quad
        pictures.append(stage.render(body, eye=(0, 0, 5), fov=2 * math.degrees(math.atan(0.2)), size=(64, 64), samples=4, depth=3))
        pictures[-1].is_clean()
    # A texel reaches into its neighbours by bilinear interpolation: 1.5 texels of 8 pixels.
    near = np.zeros((64, 64), bool)
    ys, xs = np.nonzero((bad != good).reshape(8, 8, -1).any(-1))
    for y, x in zip(ys, xs):
        near[max(0, 8 * y - 5):8 * y + 13, max(0, 8 * x - 5):8 * x + 13] = True
    a, b = (p.pixels for p in pictures)
    either = near | near[:, ::-1] | near[::-1] | near[::-1, ::-1]  # whichever way round the picture is
    assert (~either).any() and np.allclose(a[~either], b[~either], rtol=1e-5)
    assert b.min() >= 0


def test_images_of_no_pixels_are_missing(stage):
    """The scene renders, and the report names the file."""
    for name, data in (("empty.pfm", b"PF\n0 0\n-1.0\n"), ("line.pfm", b"PF\n0 5\n-1.0\n"), ("no.png", b"")):
        (stage.folder / name).write_bytes(data)
        body = LIGHT + texture("t", "spectrum", name) + 'Material "diffuse" "texture reflectance" "t"\n' + square(1)
        found = stage.render(body)
        found.is_clean()
        assert any(name in line for line in found.report), found.report


@pytest.mark.parametrize("shape", [(1, 1), (1, SIDE), (SIDE, 1), (16, SIDE)])
def test_images_of_one_pixel_and_of_16k(stage, shape):
    """A ramp, looked up in its middle; as a sky, all of whose light arrives."""
    height, width = shape
    ramp = np.linspace(0, 1, height * width).reshape(height, width).astype(np.float32) if height * width > 1 else np.full(shape, 0.5)
    write_pfm(stage.folder / "ramp.pfm", np.repeat(ramp[..., None], 3, axis=2))
    quad = ('Shape "trianglemesh" "point3 P" [ -1 -1 0 1 -1 0 1 1 0 -1 1 0 ] "integer indices" [ 0 1 2 0 2 3 ] '
            '"point2 uv" [ 0 0 1 0 1 1 0 1 ]\n')
    body = LIGHT + texture("t", "spectrum", "ramp.pfm") + 'Material "diffuse" "texture reflectance" "t"\n' + quad
    stage.render(body).is_everywhere(0.5, 1e-2)
    with restage.open(stage.scene(diffuse(0.5) + square(1), size=(16, 16))) as session:
        session.exposure = 1
        session.set_sky(np.ones((height, width, 3), np.float32))
        picture = session.render(samples=16)
    color, error = picture.color[..., 1].astype(float), picture.std_error[..., 1].astype(float)
    sigma = math.sqrt((error ** 2).mean() / error.size)
    assert picture.not_finite == {} and abs(color.mean() - 0.5) < 4 * sigma + 1e-4 and sigma < 0.01


def test_films_of_no_pixels_one_and_16k(stage):
    body = LIGHT + diffuse(0.5) + square(1)
    with restage.open(stage.scene(body)) as session:
        session.exposure = 1
        for size in ((0, 0), (0, 5), (70000, 1)):
            with pytest.raises(restage.Error, match="size"):
                session.render(size=size, samples=1)
        for size in ((1, 1), (SIDE, 1), (1, SIDE)):
            picture = session.render(size=size, samples=1)
            assert picture.color.shape == (size[1], size[0], 3)
            middle = picture.color[size[1] // 2, size[0] // 2, 1]
            assert middle == pytest.approx(0.5, rel=1e-5)
        # All of 16384 x 16384 would be 20 GB of film; a window of it costs what it covers.
        session.size = (SIDE, SIDE)
        session.crop = (0.5, 0.5 + 16 / SIDE, 0.5, 0.5 + 16 / SIDE)
        picture = session.render(samples=1)
        assert picture.color.shape == (16, 16, 3) and np.allclose(picture.color, 0.5, rtol=1e-5)


def test_zero_pixels_in_a_file_are_refused(stage):
    path = stage.scene(LIGHT + diffuse(0.5) + square(1), size=(0, 8))
    with pytest.raises(restage.Error):
        with restage.open(path) as session:
            session.render(samples=1)
