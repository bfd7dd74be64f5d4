# SPDX-License-Identifier: Apache-2.0
"""Geometry as arrays, new cameras and groups, the crop, and pictures in numpy and notebooks."""
import numpy as np
import pytest

import restage


@pytest.fixture
def session():
    with restage.new() as made:
        yield made


def test_a_mesh_goes_in_and_comes_out_as_arrays(session):
    positions = np.array([[0, 0, 0], [2, 0, 0], [0, 3, 0], [2, 3, 1]], float)
    triangles = [[0, 1, 2], [1, 3, 2]]
    uvs = positions[:, :2]
    paint = session.add_material("Paint", "diffuse")
    thing = session.add_mesh(positions, triangles, name="Sheet", material=paint, uvs=uvs, transform=np.diag([2, 2, 2, 1]))
    assert thing.name == "Sheet" and thing.material == paint and thing.triangle_count == 2 and thing.normals is None
    assert np.array_equal(thing.vertices, positions) and np.array_equal(thing.triangles, triangles)
    assert np.array_equal(thing.uvs, uvs) and thing.vertices.dtype == np.float32
    assert np.allclose(thing.bounds, [[0, 0, 0], [4, 6, 2]])
    with pytest.raises(ValueError):
        thing.vertices[0, 0] = 1
    kept = thing.vertices
    session.undo()
    assert not thing.exists and np.array_equal(kept, positions)  # the array keeps its data alive
    own = session.add_mesh(positions, triangles, normals=np.tile([0, 0, 1], (4, 1)))
    assert own.material.type == "diffuse" and own.normals.shape == (4, 3)
    session.undo()
    assert "Mesh" not in [m.name for m in session.materials]


def test_texture_coordinates_are_projected(session):
    sheet = session.add_mesh([[0, 0, 0], [2, 0, 0], [0, 3, 0]], [[0, 1, 2]], transform=np.diag([2, 1, 1, 1]))
    other = sheet.duplicate()
    sheet.project_texture(0.5)
    assert np.allclose(sheet.uvs, [[0, 0], [8, 0], [0, 6]])  # lengths in the world over the size
    assert other.uvs is None
    with pytest.raises(restage.Error, match="above 0"):
        sheet.project_texture(0)
    with pytest.raises(restage.Error, match="object or world"):
        sheet.project_texture(axes="own")


@pytest.mark.parametrize("positions, triangles, more, says", [
    ([[0, 0, 0]], [[0, 0, 1]], {}, "refers to vertex 1 of 1"),
    ([[0, 0, 0]], [[0, 0, -1]], {}, "refers to vertex -1"),
    ([[0, 0, 0]], [[0, 0, 2**32]], {}, "refers to vertex 4294967296"),
    ([[0, 0, float("nan")]], [[0, 0, 0]], {}, "not a finite number"),
    ([[0, 0]], [[0, 0, 0]], {}, "positions are an array"),
    ([0, 0, 0], [[0, 0, 0]], {}, "positions are an array"),
    (np.zeros((0, 3)), np.zeros((0, 3)), {}, "no triangles"),
    ([[0, 0, 0]], [[0, 0, 0]], {"normals": [[0, 0, 1], [0, 0, 1]]}, "2 normals for 1 vertices"),
    ([[0, 0, 0]], [[0, 0, 0]], {"uvs": [[0, 0, 1]]}, "uvs are an array"),
])
def test_an_invalid_mesh_is_refused(session, positions, triangles, more, says):
    before = session.history
    with pytest.raises(restage.Error, match=says):
        session.add_mesh(positions, triangles, **more)
    assert session.history == before


def test_new_cameras_and_groups(session):
    camera = session.add_camera((3, 2, 3), (0, 0, 0), fov=30, name="Corner")
    assert camera.position == (3, 2, 3) and camera.fov == 30 and session.history[-1] == "Add Corner"
    view = np.asarray(camera.transform)[:3, 2]
    assert np.allclose(view, -np.array([3, 2, 3]) / np.sqrt(22)) and session.camera != camera
    with pytest.raises(restage.Error, match="the viewpoint"):
        session.add_camera((1, 1, 1), (1, 1, 1), name="Nowhere")
    assert "Nowhere" not in [c.name for c in session.cameras]
    session.undo()
    assert not camera.exists

    triangle = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    a, b, c = (session.add_mesh(*triangle, name=name) for name in "abc")
    pair = session.add_group([a, b], "Pair")
    assert {o.name for o in pair.objects} == {"a", "b"} and pair.parent is None and a.group == pair
    trio = session.add_group([pair, c], "Trio")
    assert pair.parent == trio and a.group == pair and c.group == trio and len(trio.objects) == 3
    inner = session.add_group(a, "Inner")  # part of a group: stays within it
    assert inner.parent == pair and a.group == inner
    with pytest.raises(restage.Error, match="at least one object"):
        session.add_group([])


def test_a_crop_is_a_part_and_pictures_are_arrays(cornell):
    cornell.size = (32, 24)
    whole = cornell.render(samples=1)
    cornell.crop = (0.25, 0.75, 0.5, 1)
    assert cornell.crop == (0.25, 0.75, 0.5, 1)
    part = cornell.render(samples=1)
    assert part.size == (16, 12) and np.array_equal(part.depth, whole.depth[12:, 8:24])
    for bad in ((0.5, 0.5, 0, 1), (0, 2, 0, 1), (0, float("nan"), 0, 1)):
        with pytest.raises(restage.Error, match="crop"):
            cornell.crop = bad
    array = np.asarray(part)
    assert array.shape == (12, 16, 3) and np.array_equal(array, part.color)
    array[:] = 0
    assert part.color.max() > 0  # a copy
    assert np.asarray(part, dtype=np.float64).dtype == np.float64
    assert part._repr_png_().startswith(b"\x89PNG")


def test_things_hold_every_object_once():
    with restage.open(restage.bundled_scene("demo")) as session:
        things = [{o.name for o in t.objects} for t in session.things()]
        assert sorted(name for t in things for name in t) == sorted(o.name for o in session.objects)
        assert {"Vase", "Vase stems", "Vase leaves"} in things and {"Chair frame", "Chair cushion"} in things
        assert any("Floor" in t for t in things) and not any("Floor" in t and len(t) > 1 for t in things)
