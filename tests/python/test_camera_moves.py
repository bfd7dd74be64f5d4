# SPDX-License-Identifier: Apache-2.0
"""Turntables, paths through cameras, and lights weighed in layers."""
import numpy as np
import pytest

import restage


def test_a_turntable_goes_once_around(cornell):
    start = cornell.camera.transform
    views = cornell.turntable(4)
    assert len(views) == 4 and np.allclose(views[0].transform, start)
    (low, high) = cornell.bounds
    middle = (low + high) / 2
    away = [np.linalg.norm(v.transform[:3, 3] - middle) for v in views]
    assert np.allclose(away, away[0])
    assert not np.allclose(views[1].transform, start)
    steps = len(cornell.history)
    cornell.set_view(views[2])
    assert np.allclose(cornell.camera.transform, views[2].transform) and len(cornell.history) == steps + 1
    cornell.undo()
    assert np.allclose(cornell.camera.transform, start)
    for wrong in (0, 100001):
        with pytest.raises(ValueError, match="1 to 100000"):
            cornell.turntable(wrong)


def test_a_path_goes_through_cameras(cornell):
    first = cornell.camera
    other = cornell.add_camera((1, 2, 3), (0, 0, 0), fov=60)
    views = cornell.camera_path(3, [first, other])
    assert np.allclose(views[0].transform, first.transform) and np.allclose(views[2].transform, other.transform)
    assert views[1].fov == pytest.approx((first.fov + 60) / 2)
    assert len(cornell.camera_path(5)) == 5
    with pytest.raises(restage.Error, match="at least one camera"):
        cornell.camera_path(3, [])


def test_lights_are_weighed_in_layers():
    with restage.new() as session:
        session.set_sky(color=(1, 1, 1))
        lamp = session.add_light("point", (2, 2, 2), name="Lamp")
        assert "Lamp" in session.light_layers
        steps = len(session.history)
        session.weigh_lights({"Lamp": (1, 0.5, 0)})
        assert len(session.history) == steps + 1
        assert np.allclose(np.array(lamp.value) / lamp.value[0], (1, 0.5, 0))
        with pytest.raises(KeyError, match="no light layer"):
            session.weigh_lights({"Lamb": 2})
        with pytest.raises(ValueError, match="at least 0"):
            session.weigh_lights({"Lamp": -1})
