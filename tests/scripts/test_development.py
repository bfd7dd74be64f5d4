# SPDX-License-Identifier: Apache-2.0
"""How pictures are developed by `restage render` and `merge`: tone curve, white balance, backdrop with alpha."""
import os
import pathlib
import subprocess

import numpy as np
import pytest

import exr_file

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))
# A wall of radiance 1 that covers the left half of the picture, before a grey sky.
HALF = """Camera "orthographic" "float screenwindow" [-1 1 -1 1]
Film "rgb" "integer xresolution" 16 "integer yresolution" 16 "string filename" "half.exr"
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.5 0.5]
AreaLightSource "diffuse" "rgb L" [1 1 1] "bool twosided" true
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "bilinearmesh" "point3 P" [-2 -2 1  0.0625 -2 1  -2 2 1  0.0625 2 1]
"""


def pixels(picture):
    """Its 8-bit values, integers [height, width, 3 or 4]."""
    linear = picture.with_suffix(picture.suffix + ".exr")
    restage("convert", picture, linear)
    found = exr_file.read(linear)
    values = np.stack([found[c] for c in "RGBA" if c in found], axis=-1).astype(np.float64)
    encoded = np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)
    encoded[..., 3:] = values[..., 3:]
    return np.rint(encoded * 255).astype(int)


def restage(*args):
    done = subprocess.run([RESTAGE, *map(str, args)], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done


@pytest.fixture(scope="module")
def half(tmp_path_factory):
    """Its scene, and a function that renders it to a picture of that name."""
    folder = tmp_path_factory.mktemp("half")
    scene = folder / "half.pbrt"
    scene.write_text(HALF)

    def render(name, *options):
        restage("render", scene, "-o", folder / name, "--spp", 16, *options)
        return pixels(folder / name) if name.endswith(("png", "jpg")) else folder / name
    return render


def test_a_tone_curve_changes_png_and_jpg(half):
    plain, agx, jpg = half("plain.png"), half("agx.png", "--tone", "agx"), half("agx.jpg", "--tone", "agx")
    left = plain[:, 0, 0], agx[:, 0, 0]
    assert (left[0] == 255).all() and (left[1] < 220).all() and (left[1] > 150).all()
    assert abs(jpg[8, 2] - agx[8, 2]).max() <= 3
    assert half("set.png", "--set", "film.tone=agx").tolist() == agx.tolist()


def test_white_balance_tint_and_vignette(half):
    warm = half("warm.png", "--white-balance", 9000)[8, 14]
    pink = half("pink.png", "--tint", 60)[8, 14]
    assert warm[0] > warm[2] + 10 and pink[1] < pink[0] - 5 and pink[1] < pink[2] - 5
    dim = half("dim.png", "--vignette", 1)
    assert dim[8, 8].max() - 20 > dim[15, 15].max()


def test_an_exr_stays_linear(half):
    a, b = half("a.exr"), half("b.exr", "--tone", "filmic", "--vignette", 1, "--bloom", 0.3, "--exposure", 2)
    assert a.read_bytes() == b.read_bytes()


def test_a_transparent_background_has_alpha(half):
    png = half("alpha.png", "--background", "transparent")
    assert png.shape == (16, 16, 4)
    assert (png[:, :8] == 255).all() and (png[:, 9:, 3] == 0).all()
    edge = png[:, 8]  # half covered, and in its own colour
    assert (abs(edge[:, 3] - 128) < 60).all() and (edge[:, :3] > 250).all()
    layers = exr_file.read(half("alpha.exr", "--background", "transparent"))
    assert np.allclose(layers["A"], layers["coverage.A"]) and layers["A"][:, :8].min() == 1
    assert layers["A"][:, 9:].max() == 0 and layers["R"][:, 9:].max() == 0
    assert np.allclose(layers["R"], layers["A"], atol=1e-3)  # premultiplied radiance of 1
    assert half("alpha.jpg", "--background", "transparent").shape == (16, 16, 3)
    assert "A" not in exr_file.read(half("opaque.exr"))


def test_a_coloured_background_is_as_it_was_asked_for(half):
    png = half("blue.png", "--background", "0,0,1", "--tone", "agx", "--exposure", 1)
    assert png.shape == (16, 16, 3) and (png[:, 9:] == (0, 0, 255)).all()
    assert (half("black.png", "--background", "black")[:, 9:] == 0).all()


@pytest.mark.parametrize("options, says", [
    (["--tone", "sepia"], "sepia"), (["--white-balance", 100], "--white-balance"), (["--bloom", 2], "--bloom"),
    (["--background", "1,2,3"], "is neither black, nor transparent, nor a colour"),
    (["--background", "1,1"], "is neither black, nor transparent, nor a colour"),
    (["--background", "white"], "is neither black, nor transparent, nor a colour")])
def test_wrong_options_are_refused(tmp_path, options, says):
    scene = tmp_path / "half.pbrt"
    scene.write_text(HALF)
    done = subprocess.run([RESTAGE, "render", str(scene), "-o", str(tmp_path / "x.png"), *map(str, options)],
                          capture_output=True, text=True, timeout=300)
    assert done.returncode != 0 and says in done.stderr


def test_merge_develops_a_rendered_picture(half, tmp_path):
    linear = half("linear.exr")
    restage("merge", linear, "-o", tmp_path / "agx.png", "--tone", "agx")
    direct = half("direct.png", "--tone", "agx")
    assert abs(pixels(tmp_path / "agx.png") - direct).max() <= 1


def test_a_shadow_catcher_has_the_alpha_of_its_shadow(tmp_path):
    scene = tmp_path / "ball.pbrt"
    scene.write_text("""LookAt 0 -4 2  0 0 0.3  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 48 "integer yresolution" 48
WorldBegin
LightSource "infinite" "rgb L" [0.3 0.4 0.6]
LightSource "distant" "rgb L" [3 3 3] "point3 from" [3 0 3] "point3 to" [0 0 0]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
AttributeBegin
  Translate 0 0 0.5
  Shape "sphere" "float radius" 0.5
AttributeEnd
Shape "bilinearmesh" "point3 P" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]
""")
    options = ["--set", "bilinearmesh.catcher=true", "--background", "transparent", "--spp", 32]
    restage("render", scene, "-o", tmp_path / "ball.png", *options)
    alpha = pixels(tmp_path / "ball.png")[..., 3]
    assert alpha[0, 0] == 0 and alpha[40:, :12].mean() < 20  # the sky, and the floor on the side of the sun
    assert alpha[20, 24] == 255  # the ball
    assert 120 < alpha[25:29, 33:37].mean() < 250  # its shadow, lit by the sky
    restage("render", scene, "-o", tmp_path / "half.exr", *options, "--aov", "all")
    layers = exr_file.read(tmp_path / "half.exr")
    assert layers["coverage.A"][44, 4] == 1 and layers["A"][40:, :12].mean() < 0.1
