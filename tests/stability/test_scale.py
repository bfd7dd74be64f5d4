# SPDX-License-Identifier: Apache-2.0
"""Units from 1e-4 to 1e6, and scenes a million units from the origin."""
import math

import numpy as np
import pytest
from stage import diffuse, furnace, lamp, point, rectangle_form, room, sky, square, within

PLACES = [(1e-4, 0), (1, 0), (1e6, 0), (1, 1e6), (1e-4, 1e6), (1e6, 1e6)]


def placed(scale, offset):
    """The world's transform, and a function that places a point."""
    move = np.array([offset, -offset, offset], float)
    transform = f"Translate {offset!r} {-offset!r} {offset!r}\nScale {scale!r} {scale!r} {scale!r}\nRotate 35 1 2 3"
    axis = np.array([1, 2, 3]) / math.sqrt(14)
    a = math.radians(35)

    def place(p):
        p = np.asarray(p, float)
        turned = p * math.cos(a) + np.cross(axis, p) * math.sin(a) + axis * axis.dot(p) * (1 - math.cos(a))
        return tuple(move + scale * turned)
    return transform, place


def view(place, eye, at, **more):
    up = np.array(place((0, 0, 1))) - np.array(place((0, 0, 0)))
    return {"eye": place(eye), "at": place(at), "up": tuple(up / np.linalg.norm(up)), **more}


@pytest.mark.parametrize("scale,offset", PLACES)
def test_a_closed_grey_room_balances_its_energy(stage, scale, offset):
    """Emission 1 and albedo 1/2 on each surface, of meshes and quadrics alike: the same radiance in every direction, and the
    bounces are counted. Any ray that is lost, or leaves, shows in the mean."""
    transform, place = placed(scale, offset)
    body = (diffuse(0.5) + 'AreaLightSource "diffuse" "rgb L" [ 1 1 1 ]\n' + room() +
            within("Translate 0.4 0.3 -0.5\nRotate 20 1 1 0\nScale 0.3 0.3 0.3", "ReverseOrientation\n" + room()) +
            within("Translate -0.4 0.2 0.3", 'Shape "sphere" "float radius" 0.35\n'))
    found = stage.render(body, samples=64, depth=12, transform=transform, size=(16, 16),
                         **view(place, (0.1, -0.9, 0.1), (0, 1, 0), fov=70.0))
    found.is_mean(furnace(1, 0.5, 12), sharp=0.004)
    worst = np.abs(found.pixels - 2) / np.maximum(found.picture.std_error[..., 1], 1e-3)
    assert worst.max() < 6, "no pixel is off by more than its noise"


@pytest.mark.parametrize("scale,offset", PLACES)
def test_a_closed_room_is_black_whatever_the_sky(stage, scale, offset):
    transform, place = placed(scale, offset)
    found = stage.render(sky(1e3) + diffuse(0.9) + room(), samples=16, depth=8, transform=transform, size=(24, 24),
                         **view(place, (0.3, -0.9, 0.2), (0, 1, 0), fov=80.0))
    found.is_everywhere(0)


@pytest.mark.parametrize("scale,offset", PLACES)
def test_a_lamp_over_a_plane_has_its_form_factor(stage, scale, offset):
    transform, place = placed(scale, offset)
    body = diffuse(0.5) + square(0.2) + lamp(3, square(0.5, 1.5, up=False))
    found = stage.render(body, samples=64, transform=transform, size=(16, 16),
                         **view(place, (0, 0, 1), (0, 0, 0)) | {"up": tuple(np.subtract(place((0, 1, 0)), place((0, 0, 0))) / scale)})
    found.is_mean(1.5 * rectangle_form(-0.5, 0.5, -0.5, 0.5, 1.5), 1e-3)


def lit(found):
    """Fraction of pixels that are not black."""
    found.is_clean()
    return np.mean(found.picture.color.max(axis=-1) > 0)


def far_walls(stage, wall, turned):
    """Inside a room of 2 units whose walls are `wall` times that, with a lamp close behind each; the walls' coordinates are turned against
    the axes, or an instance of them is."""
    transform, place = placed(1, 0)
    lamps = "".join(point(1e4, tuple(1.2 * side * (axis == k) + 0.2 * (axis != k) for k in range(3))) for axis in range(3) for side in (-1, 1))
    if turned:
        text = room(1, wall, place) + within(transform, lamps)
    else:
        text = within(transform, room(1, wall) + lamps)
    return stage.render(diffuse(0.9) + text, samples=64, depth=8, size=(32, 32), **view(place, (0.3, -0.9, 0.2), (0, 1, 0), fov=80.0))


# Fraction of the pixels that may see light. Turned walls are only known to an ulp of their vertices.
@pytest.mark.parametrize("wall,turned,allowed", [(100, False, 0), (1e4, False, 0), (1e6, False, 0), (100, True, 0), (1e4, True, 0.1)])
def test_a_room_with_walls_far_beyond_it_is_black(stage, wall, turned, allowed):
    assert lit(far_walls(stage, wall, turned)) <= allowed
