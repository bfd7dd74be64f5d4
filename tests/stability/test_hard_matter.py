# SPDX-License-Identifier: Apache-2.0
"""1e5 transparent layers, opacity and roughness near 0 and 1, indices near 1, nested dielectrics, absorption of 0 and huge."""
import math

import numpy as np
import pytest
from stage import diffuse, fresnel, glass, lamp, sky, square, stack_transmittance, write_ply

LAYERS = 100000
BACK = lamp(1, square(5, -3))


def layers(stage, count, extra=""):
    """Parallel squares between z = -1 and 0, as one mesh."""
    z = -np.arange(count) / count
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    points = np.concatenate([np.broadcast_to(corners, (count, 4, 2)), np.broadcast_to(z[:, None, None], (count, 4, 1))], axis=2)
    first = 4 * np.arange(count)[:, None]
    write_ply(stage.folder / "layers.ply", points.reshape(-1, 3), np.concatenate([first + (0, 1, 2), first + (0, 2, 3)]))
    return f'Shape "plymesh" "string filename" "layers.ply" {extra}\n'


def test_a_hundred_thousand_transparent_layers(stage):
    """Of opacity 0: nothing is lost. Of opacity 1e-5: (1 - 1e-5)^1e5, one draw per layer."""
    clear = stage.render(BACK + diffuse(0) + layers(stage, LAYERS, '"float alpha" 0'), samples=1)
    clear.is_everywhere(1)
    faint = stage.render(BACK + diffuse(0) + layers(stage, LAYERS, f'"float alpha" {1 / LAYERS!r}'), samples=16, size=(8, 8))
    faint.is_mean((1 - 1 / LAYERS) ** LAYERS, sharp=0.1)
    null = stage.render(BACK + 'Material "interface"\n' + layers(stage, LAYERS), samples=1)
    null.is_everywhere(1)


@pytest.mark.parametrize("alpha", [0, 1e-6, 0.5, 1 - 1e-6, 1])
def test_opacity_near_its_ends(stage, alpha):
    """Of a black square before a lamp."""
    found = stage.render(BACK + diffuse(0) + square(1, extra=f'"float alpha" {alpha!r}'), samples=256, size=(16, 16))
    n = 256 * 256
    found.is_clean()
    assert abs(found.value - (1 - alpha)) <= 4 * math.sqrt(alpha * (1 - alpha) / n) + 2 / n * (0 < alpha < 1)


@pytest.mark.parametrize("panes", [1, 20])
def test_a_stack_of_panes(stage, panes):
    body = BACK + glass(1.5)
    for k in range(panes):
        body += square(1, -k / panes) + square(1, -(k + 0.5) / panes, up=False)
    found = stage.render(body, samples=128, depth=1000)
    found.is_mean(stack_transmittance([fresnel(1, 1.5)] * 2 * panes), sharp=0.02)


def test_nested_dielectrics(stage):
    """Water in a glass, by its three kinds of interface; and a bubble of air in it."""
    water_glass = glass(1.5 / 1.33)  # its inside is the glass
    wall = glass(1.5) + square(1, 0) + water_glass + square(1, -0.2, up=False)
    other = water_glass + square(1, -0.8) + glass(1.5) + square(1, -1, up=False)
    bubble = glass(1.33) + square(1, -0.4, up=False) + square(1, -0.6)
    a, b, w = fresnel(1, 1.5), fresnel(1, 1.5 / 1.33), fresnel(1, 1.33)
    stage.render(BACK + wall + other, samples=128, depth=200).is_mean(stack_transmittance([a, a, b, b]), sharp=0.005)
    found = stage.render(BACK + wall + bubble + other, samples=128, depth=200)
    found.is_mean(stack_transmittance([a, a, b, b, w, w]), sharp=0.005)


@pytest.mark.parametrize("off", [0, 1e-6, 1e-3])
@pytest.mark.parametrize("roughness", [0, 0.3])
def test_an_index_near_one_vanishes(stage, off, roughness):
    """At 45 degrees, before a white sky and before a lamp. Rough glass that is not quite of index 1 loses what its facets mask from both
    sides (single scattering; Walter et al. 2007, Eq. 34), and never gains."""
    pane = glass(1 + off, roughness=roughness) + square(9) + square(9, -0.1, up=False)
    look = {"eye": (1, 0, 1), "samples": 64, "depth": 50}
    masked = (2 / (1 + math.sqrt(1 + roughness))) ** 2  # alpha^2 = roughness, tangent 1
    for behind in (sky(1), lamp(1, square(30, -3))):
        found = stage.render(behind + pane, **look)
        if roughness > 0 and off > 1e-4:
            found.is_clean()
            assert masked - 4 * found.sigma <= found.value <= 1 + 4 * found.sigma
        else:
            found.is_mean(1, 5e-3)


@pytest.mark.parametrize("sigma,expected", [(0, 1), (1e-30, 1), (1, math.exp(-0.5)), (1e4, 0), (1e30, 0)])
def test_absorption_none_and_huge(stage, sigma, expected):
    """Half a unit of it in a pane of index 1.5; inside, every crossing is weakened."""
    medium = f'MakeNamedMedium "ink" "string type" "homogeneous" "rgb sigma_a" [ {sigma!r} {sigma!r} {sigma!r} ] "rgb sigma_s" [ 0 0 0 ]\n'
    body = BACK + medium + 'MediumInterface "ink" ""\n' + glass(1.5) + square(1) + square(1, -0.5, up=False)
    r = fresnel(1, 1.5)
    t = (1 - r) ** 2 * expected / (1 - (r * expected) ** 2)
    found = stage.render(body, samples=256, depth=100)
    found.is_mean(t, sharp=0.01) if t else found.is_everywhere(0)
