# SPDX-License-Identifier: Apache-2.0
"""Finding and changing things through the package: each function, and undo of it."""
import json
import logging
import pathlib

import numpy as np
import pytest

import restage


def snapshot(session, tmp_path, name):
    """The scene, as the bytes of its export."""
    folder = tmp_path / name
    folder.mkdir()
    session.export(folder / "scene.pbrt", textures="absolute")
    return {p.relative_to(folder): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_things_are_found_by_name_position_and_pattern(demo):
    assert len(demo.objects) == 119 and len(demo.materials) == 38
    oak = demo.materials["Wall paint"]
    assert oak.name == "Wall paint" and demo.materials.by_id(oak.id) == oak and "Wall paint" in demo.materials
    assert [g.name for g in demo.groups.match("Chair*")] == ["Chair", "Chair 2", "Chair 3"]
    assert demo.materials[0] == next(iter(demo.materials)) and demo.materials[-1] == list(demo.materials)[-1]
    assert demo.materials.names == [m.name for m in demo.materials]
    part = demo.find("Chair").objects[-1]
    assert isinstance(demo.find("Chair"), restage.Group) and demo.find(part.name) == part and part.group == demo.find("Chair")
    assert hash(oak) == hash(demo.materials["Wall paint"]) and len({oak, demo.materials["Wall paint"]}) == 1
    assert 'Material' in repr(oak) and '"Wall paint"' in repr(oak)


def test_a_missing_name_is_a_key_error_with_a_suggestion(demo):
    with pytest.raises(KeyError, match='no material called "Wall pain"; did you mean "Wall paint"'):
        demo.materials["Wall pain"]
    with pytest.raises(KeyError, match='did you mean "Chair"'):
        demo.find("Chiar")
    with pytest.raises(IndexError):
        demo.materials[1000]
    with pytest.raises(restage.Error, match="no material with id 999"):
        demo.materials.by_id(999)


def test_moving_turning_and_scaling(demo):
    chair = demo.find("Chair")
    center, extent = np.array(chair.center), np.array(chair.extent)
    chair.move((1, 0.5, 0))
    assert np.allclose(chair.center, center + (1, 0.5, 0))
    chair.move_to(center)
    assert np.allclose(chair.center, center)
    part = chair.objects[0]
    before = part.transform
    chair.rotate(90)
    chair.rotate(-90)
    assert np.allclose(part.transform, before)
    chair.scale(2)
    assert np.allclose(chair.extent, 2 * extent) and np.allclose(chair.center, center)
    chair.scale((0.5, 0.5, 1), center=(0, 0, 0))
    assert np.allclose(chair.center, center * (0.5, 0.5, 1))
    matrix = np.eye(4)
    matrix[:3, 3] = 0.1, 0.2, 0.3
    was = np.array(chair.center)
    chair.transform_by(matrix)
    assert np.allclose(chair.center, was + (0.1, 0.2, 0.3))
    part.transform = before
    assert np.array_equal(part.transform, before)
    assert chair.bounds.shape == (2, 3) and (chair.bounds[1] > chair.bounds[0]).all()


def test_dropping_stands_things_on_the_floor(demo):
    vase = demo.find("Vase")
    z = vase.bounds[0, 2]
    vase.move((0, 0, 0.2))
    assert vase.drop() == pytest.approx(0.2, abs=2e-3)
    assert vase.bounds[0, 2] == pytest.approx(z, abs=2e-3)
    vase.move((0, 0, 0.5))
    vase.move((0, 0, -2), collide=True)
    assert vase.bounds[0, 2] == pytest.approx(z, abs=2e-3), "it stopped on what it stands on"
    vase.move((100, 0, 0))
    assert vase.drop() is None, "nothing is below"


def test_copies_share_and_removed_things_are_gone(demo):
    chair = demo.find("Chair")
    objects, triangles = len(demo.objects), [o.triangle_count for o in chair.objects]
    copy = chair.duplicate(by=(0, -2, 0))
    assert isinstance(copy, restage.Group) and copy.name == "Chair 4" and copy != chair
    assert np.allclose(np.array(copy.center) - chair.center, (0, -2, 0))
    assert [o.triangle_count for o in copy.objects] == triangles and copy.materials == chair.materials
    one = copy.objects[0].duplicate()
    assert isinstance(one, restage.Object) and one.material == copy.objects[0].material
    two = demo.select(chair, copy).duplicate()
    assert isinstance(two, restage.Selection) and len(two) == 2 * len(triangles) + 1
    two.remove()
    copy.remove()
    assert len(demo.objects) == objects and not copy.exists and "gone" in repr(copy)
    with pytest.raises(restage.Error, match="no group .* any more"):
        copy.center
    demo.undo()
    assert copy.exists and copy.name == "Chair 4"


def test_things_are_mirrored_and_repeated(demo):
    chair = demo.find("Chair")
    before, steps = chair.bounds.copy(), demo.history
    chair.mirror("x", at=1.0)
    assert np.allclose(chair.bounds[:, 0], 2 - before[::-1, 0]) and np.allclose(chair.bounds[:, 1:], before[:, 1:])
    chair.mirror("x", at=1.0)
    chair.mirror("y")
    assert np.allclose(chair.bounds, before)
    with pytest.raises(restage.Error, match="x, y or z"):
        chair.mirror("w")
    row = chair.array(4, by=(0, -1, 0))
    assert len(row) == 3 * len(chair.objects)
    assert np.allclose(row.bounds[0], before[0] - (0, 3, 0))
    assert len(demo.history) == len(steps) + 4
    ring = chair.array_around(4, center=(0, 0, 0))
    assert np.allclose(ring.objects[0].transform[:3, :3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]] @ chair.objects[0].transform[:3, :3])
    straight = chair.array_around(2, center=(0, 0, 0), axis=(0, 0, 1), degrees=90, turn=False)
    assert np.allclose(straight.center, (-chair.center[1], chair.center[0], chair.center[2]))
    start = chair.bounds.mean(0) * (1, 1, 0) + chair.bounds[0] * (0, 0, 1)
    along = chair.array_along([start + (2, 0, 0), start + (2, 2, 0)], count=3, smooth=False)
    assert np.allclose(along.objects[0].transform[:3, 3] - chair.objects[0].transform[:3, 3], (2, 0, 0))
    assert len(chair.array_along([start + (2, 0, 0)], spacing=0.5, turn=False)) == 4 * len(chair.objects)
    for wrong in {}, {"count": 2, "spacing": 1.0}, {"spacing": 0.0}, {"count": 0}:
        with pytest.raises(restage.Error):
            chair.array_along([start + (2, 0, 0)], **wrong)
    with pytest.raises(restage.Error, match="count is 0"):
        chair.array(0, by=(1, 0, 0))
    with pytest.raises(restage.Error, match="most is 100000"):
        chair.array(90000, by=(1, 0, 0))


def test_hidden_objects_and_emission(demo):
    vase = demo.find("Vase")
    assert not vase.hidden
    vase.hidden = True
    assert vase.hidden and all(o.hidden for o in vase.objects)
    part = vase.objects[0]
    assert part.emission is None
    part.emission = (3, 2, 1)
    assert part.emission == (3, 2, 1)
    part.emission = None
    assert part.emission is None


def test_lights_are_switched_off(demo):
    sun = demo.lights["Sun"]
    assert not sun.hidden
    sun.hidden = True
    assert sun.hidden
    demo.undo()
    assert not sun.hidden


def test_parameters_are_checked_against_their_table(demo):
    paint = demo.materials["Wall paint"]
    paint["reflectance"] = (0.07, 0.17, 0.19)
    assert paint["reflectance"] == (0.07, 0.17, 0.19)
    paint["reflectance"] = 0.5
    assert paint["reflectance"] == (0.5, 0.5, 0.5)
    with pytest.raises(restage.Error, match='"colour" does not exist in a diffuse'):
        paint["colour"] = 1
    with pytest.raises(restage.Error, match="out of its range"):
        paint["reflectance"] = (2, 0, 0)
    with pytest.raises(restage.Error, match="expected a colour"):
        paint["reflectance"] = (1, 2)
    with pytest.raises(KeyError):
        paint["nothing"]
    assert paint["reflectance"] == (0.5, 0.5, 0.5), "a refused edit changes nothing"
    del paint["reflectance"]
    line = next(p for p in paint.parameters if p.id == "reflectance")
    assert paint["reflectance"] == line.default and line.type == "color" and line.texturable and line.range[0] == 0
    assert "reflectance" in paint and set(dict(paint)) == set(paint.keys())


def test_every_parameter_of_every_material_type_goes_in_and_out(demo):
    """Over all loaded plugins: a new one is tested without a new line here."""
    types = restage.material_types()
    assert "diffuse" in types and "dielectric" in types
    other = demo.materials[0]
    for name, table in types.items():
        material = demo.add_material(f"test {name}", name)
        assert material.type == name
        for p in table:
            low, high = p.range
            value = {"float": high, "color": (low, high, low), "int": int(high), "bool": True, "text": "word",
                     "enum": p.choices[-1] if p.choices else "", "material": other, "texture": None, "table": "/nowhere/a.binary"}[p.type]
            material[p.id] = value
            assert material[p.id] == value, (name, p.id)
            del material[p.id]
            assert material[p.id] == p.default, (name, p.id)


def test_material_types_and_assignment(demo):
    metal = demo.add_material("Brushed brass", "conductor", uroughness=0.2, vroughness=0.05)
    assert (metal["uroughness"], metal["vroughness"]) == (0.2, 0.05)
    assert demo.history[-1] == "Add Brushed brass"
    count = len(demo.materials)
    with pytest.raises(restage.Error, match="does not exist in a conductor"):
        demo.add_material("Half", "conductor", uroughness=0.2, nonsense=1)
    assert len(demo.materials) == count and demo.history[-1] == "Add Brushed brass", "nothing of it remains"
    table = demo.find("Table")
    table.set_material(metal)
    assert table.materials == [metal] and set(metal.objects) == set(table.objects)
    unique = table.objects[0].make_unique(metal)
    assert unique != metal and table.objects[0].material == unique
    table.objects[0].material = metal
    metal.type = "coateddiffuse"
    assert metal.type == "coateddiffuse" and metal["uroughness"] == 0.2, "common values are kept"
    with pytest.raises(restage.Error, match="no material type"):
        metal.type = "unobtainium"
    with pytest.raises(restage.Error, match="in use|used|still"):
        metal.remove()
    metal.name = "Old brass"
    assert demo.materials["Old brass"] == metal


def test_textures_from_files_and_arrays(demo, scenes, tmp_path):
    paint = demo.materials["Wall paint"]
    paint["reflectance"] = scenes / "demo/textures/oak.png"
    texture = paint["reflectance"]
    assert isinstance(texture, restage.Texture) and texture.type == "imagemap" and texture.image_path.endswith("oak.png")
    texture["uscale"] = 3.0
    assert texture["uscale"] == 3.0 and "uscale" in texture.keys()
    checks = np.zeros((8, 8, 3), np.float32)
    checks[::2, ::2] = 1
    made = demo.add_texture(checks, name="checks")
    paint["reflectance"] = made
    assert paint["reflectance"] == made and made.name == "checks"
    paint["bump"] = str(scenes / "demo/textures/plaster-height.png")
    assert paint["bump"].scalar
    paint["bump"] = None
    assert paint["bump"] is None
    with pytest.raises(restage.Error, match="nowhere.png"):
        paint["reflectance"] = tmp_path / "nowhere.png"
    with pytest.raises(restage.Error, match="height, width"):
        demo.add_texture(np.zeros((8, 8)))


def test_lights_cameras_and_sky(demo, scenes):
    sun = demo.lights["Sun"]
    assert sun.kind == "distant"
    sun.value = (1, 2, 3)
    assert sun.value == (1, 2, 3)
    lamp = demo.add_light("spot", value=(10, 10, 10), name="Lamp")
    lamp.position = (0, 0, 2)
    lamp.look_at((1, 0, 0))
    z = lamp.transform[:3, 2]
    assert np.allclose(z, np.array((1, 0, -2)) / np.sqrt(5)) and lamp.position == (0, 0, 2)
    lamp.cone_angle = 20
    assert lamp.cone_angle == 20
    lamp.remove()
    assert "Lamp" not in demo.lights

    camera = demo.camera
    mirrored = np.linalg.det(camera.transform[:3, :3])
    camera.look_at((0, 0, 1), position=(2, -3, 1.5))
    assert np.linalg.det(camera.transform[:3, :3]) == pytest.approx(mirrored) and camera.position == (2, -3, 1.5)
    camera.fov = 35
    assert demo.camera.fov == 35 and demo.camera == demo.cameras[0]
    with pytest.raises(restage.Error, match="up is the direction"):
        camera.look_at((2, -3, 9))

    demo.set_sky(color=(0.5, 0.6, 0.7), strength=2)
    assert not demo.sky.is_image and demo.sky.color == pytest.approx((1, 1.2, 1.4))
    demo.set_sky(np.ones((16, 32, 3), np.float32), rotation=30)
    assert demo.sky.is_image and demo.sky.mapping == "equirect"
    demo.set_sky(scenes / "spheres/sky.exr", strength=0.5)
    assert demo.sky.name == "sky" and demo.sky.color == (0.5, 0.5, 0.5)
    demo.set_sky(rotation=90, hidden_from_camera=True)
    assert demo.sky.hidden_from_camera and demo.sky.name == "sky"
    demo.remove_sky()
    assert demo.sky is None
    with pytest.raises(restage.Error, match="no sky to change"):
        demo.set_sky(strength=2)


def test_skies_of_plugins(demo, scenes, tmp_path):
    lines = {p.id: p for p in restage.sky_types()["sunsky"]}
    assert lines["elevation"].unit == "deg" and lines["turbidity"].range == (2, 10)
    assert demo.sky is None or demo.sky.type == ""
    steps = len(demo.history)
    demo.make_sky("sunsky", elevation=12, ground=(0.1, 0.2, 0.1))
    assert len(demo.history) == steps + 1
    assert demo.sky.type == "sunsky" and demo.sky.is_image and demo.sky.mapping == "octahedral"
    demo.make_sky("sunsky", turbidity=5)  # the others stay
    assert demo.sky.values["elevation"] == 12 and demo.sky.values["turbidity"] == 5
    demo.set_sky(strength=2)
    assert demo.sky.type == "sunsky" and demo.sky.color == (2, 2, 2)
    with restage.open(scenes / "cornell/cornell.pbrt") as other:
        other.make_sky("sunsky", elevation=12, turbidity=5)
        other.save(tmp_path / "sky.restage")
        with restage.open(tmp_path / "sky.restage") as again:
            assert again.sky.values == other.sky.values and again.sky.values["elevation"] == 12
    for values, words in (({"elevatoin": 1}, "known: mode"), ({"elevation": 91}, "out of its range"),
                          ({"sun": "yes"}, "True or False")):
        with pytest.raises(restage.Error, match=words):
            demo.make_sky("sunsky", **values)
    with pytest.raises(restage.Error, match='no sky "dome"; known: sunsky'):
        demo.make_sky("dome")
    demo.set_sky(color=(1, 1, 1))
    assert demo.sky.type == "" and demo.sky.values == {} and not demo.sky.is_image
    demo.undo()
    assert demo.sky.type == "sunsky"


def test_a_sky_is_blurred_in_one_step(demo):
    demo.set_sky(color=(1, 1, 1))
    with pytest.raises(restage.Error, match="no image to blur"):
        demo.blur_sky(10)
    demo.make_sky("sunsky", elevation=30)
    steps = len(demo.history)
    with pytest.raises(restage.Error, match="0.5 to 180"):
        demo.blur_sky(0.1)
    demo.blur_sky(10)
    assert len(demo.history) == steps + 1
    assert demo.sky.is_image and demo.sky.type == ""
    demo.undo()
    assert demo.sky.type == "sunsky"


def test_undo_leads_back_and_redo_forward(demo, tmp_path):
    before = snapshot(demo, tmp_path, "before")
    start = len(demo.history)
    with demo.step("Restyle"):
        demo.find("Chair").move((1, 0, 0))
        demo.materials["Wall paint"]["reflectance"] = (0.1, 0.1, 0.1)
        demo.find("Vase").remove()
        with demo.step("inner"):
            demo.add_material("M", "mirror")
    assert len(demo.history) == start + 1 and demo.history[-1] == "Restyle" and demo.modified
    after = snapshot(demo, tmp_path, "after")
    assert after != before
    assert demo.undo() and snapshot(demo, tmp_path, "undone") == before
    assert demo.redo() and snapshot(demo, tmp_path, "redone") == after
    demo.undo()
    assert not demo.modified


def test_size_exposure_and_settings_are_edits(demo):
    demo.size, demo.exposure, demo.samples, demo.max_depth, demo.spectral = (64, 48), 2.0, 4, 3, True
    assert (demo.size, demo.exposure, demo.samples, demo.max_depth, demo.spectral) == ((64, 48), 2.0, 4, 3, True)
    assert (demo.adaptive, demo.guiding, demo.caustics) == (False, "auto", "auto")
    demo.adaptive, demo.guiding, demo.caustics = True, "off", "on"
    assert (demo.adaptive, demo.guiding, demo.caustics) == (True, "off", "on")
    with pytest.raises(restage.Error, match="caustics: 'maybe' is none of auto, on and off"):
        demo.caustics = "maybe"
    for _ in range(8):
        demo.undo()
    assert (demo.adaptive, demo.guiding, demo.caustics) == (False, "auto", "auto")
    assert demo.size != (64, 48) and demo.exposure != 2.0
    demo.tone, demo.white_balance, demo.tint, demo.vignette, demo.bloom = "agx", 3200, -10, 0.5, 0.25
    assert (demo.tone, demo.white_balance, demo.tint, demo.vignette, demo.bloom) == ("agx", 3200, -10, 0.5, 0.25)
    with pytest.raises(restage.Error, match='tone: "sepia" is unknown; known: srgb, filmic, agx, neutral'):
        demo.tone = "sepia"
    with pytest.raises(restage.Error, match="a white balance of 5; it must be from 1667 to 25000"):
        demo.white_balance = 5
    for _ in range(5):
        demo.undo()
    assert (demo.tone, demo.white_balance, demo.tint, demo.vignette, demo.bloom) == ("srgb", 6504, 0, 0, 0)
    assert demo.up == (0, 0, 1) and demo.bounds.shape == (2, 3) and demo.format == "pbrt-v4"


def test_packing(scenes, tmp_path):
    with restage.open(scenes / "cornell/cornell.pbrt") as session:
        session.materials[0]["reflectance"] = (0.25, 0.5, 0.75)
        assert session.pack(tmp_path / "packed.zip") == []
        assert session.modified  # only a copy was written
        with pytest.raises(restage.Error, match="is not an empty folder"):
            session.pack(scenes)
    with restage.open(tmp_path / "packed.zip") as again:
        assert again.materials[0]["reflectance"] == pytest.approx((0.25, 0.5, 0.75))
        assert again.path == str(tmp_path / "packed/packed.restage")


def test_reports_export_projects_and_reopening(scenes, tmp_path):
    with restage.open(scenes / "cornell/cornell.pbrt") as session:
        assert session.report.dropped == 0 and session.report.kept >= 0 and "kept" in repr(session.report)
        session.materials[0]["reflectance"] = (0.25, 0.5, 0.75)
        report = session.export(tmp_path / "v3.pbrt", version="v3")
        assert isinstance(report, restage.Report)
        with pytest.raises(restage.Error, match="v9"):
            session.export(tmp_path / "x.pbrt", version="v9")
        with pytest.raises(restage.Error, match="unknownformat"):
            session.export(tmp_path / "x.unknownformat")
        session.save(tmp_path / "edited.restage")
        assert not session.modified
        with pytest.raises(restage.Error, match="projects"):
            session.save(tmp_path / "x.pbrt")
        assert json.loads((tmp_path / "edited.restage").read_text())["restage"] == 1
    for file in ("v3.pbrt", "edited.restage"):
        with restage.open(tmp_path / file) as again:
            assert again.materials[0]["reflectance"] == pytest.approx((0.25, 0.5, 0.75))


def test_broken_and_missing_files_say_where(scenes, tmp_path):
    with pytest.raises(restage.Error, match="nowhere.pbrt"):
        restage.open("nowhere.pbrt")
    broken = tmp_path / "broken.pbrt"
    broken.write_text('WorldBegin\nShape "sphere" "float radius" [ "one" ]\n')
    with pytest.raises(restage.Error, match=r"broken.pbrt:2:\d+"):
        restage.open(broken)


def test_inserting_a_file_and_removing_what_is_unused(scenes):
    with restage.new() as session:
        assert session.up == (0, 1, 0) and session.sky.is_image
        pear = session.insert(scenes / "demo/geometry/pear.ply")
        assert pear.triangle_count > 0
        materials = len(session.materials)
        pear.remove()
        session.remove_unused()
        assert len(session.materials) < materials


def test_plugins_and_a_folder_that_holds_none(tmp_path):
    plugins = restage.plugins()
    assert any("material diffuse" in p.provides for p in plugins) and all(p.loaded for p in plugins)
    assert {p.kind for p in plugins} == {"material", "texture", "importer", "exporter", "denoiser", "sky", "action, panel"}
    with pytest.raises(restage.Error, match="contains no plugin"):
        restage.load_plugins(tmp_path)
    with pytest.raises(restage.Error, match="no such folder"):
        restage.load_plugins(tmp_path / "nowhere")
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad/plugin.json").write_text("{ not json")
    with pytest.raises(restage.Error, match="plugin.json"):
        restage.load_plugins(tmp_path)


def test_closed_sessions_and_foreign_things_are_refused(scenes):
    session = restage.open(scenes / "cornell/cornell.pbrt")
    other = restage.open(scenes / "cornell/cornell.pbrt")
    with pytest.raises(restage.Error, match="another session"):
        session.objects[0].material = other.materials[0]
    with pytest.raises(restage.Error, match="another session"):
        session.select(other.objects[0])
    with pytest.raises(TypeError, match="expected objects"):
        session.select("Chair")
    material = session.materials[0]
    session.close()
    with pytest.raises(restage.Error, match="closed"):
        session.objects[0]
    with pytest.raises(restage.Error, match="closed"):
        material["reflectance"]
    assert "closed" in repr(session) and not material.exists
    other.close()


def test_everything_public_is_documented_and_in_the_stub():
    stub = (pathlib.Path(restage.__file__).parent / "_core.pyi").read_text()
    compile(stub, "_core.pyi", "exec")
    assert (pathlib.Path(restage.__file__).parent / "py.typed").exists()
    public = {name for name in vars(restage) if not name.startswith("_") and name not in ("bench", "bsdf", "checking")}
    assert public == set(restage.__all__)
    missing = []
    for name in restage.__all__:
        thing = getattr(restage, name)
        if not thing.__doc__:
            missing.append(name)
        if not isinstance(thing, type) or thing.__module__ != "restage._core":
            continue
        for member, value in vars(thing).items():
            if not member.startswith("_") and not getattr(value, "__doc__", None):
                missing.append(f"{name}.{member}")
            if not member.startswith("_") and f"def {member}(" not in stub:
                missing.append(f"{name}.{member} in the stub")
    assert not missing, missing
    assert "numpy.float32" in stub or "float32" in stub


def test_the_engines_warnings_go_to_logging(caplog, tmp_path, scenes):
    """A non-finite texel of a texture is replaced and logged."""
    image = np.full((4, 4, 3), np.nan, np.float32)
    with restage.open(scenes / "cornell/cornell.pbrt") as session, caplog.at_level(logging.WARNING, "restage"):
        session.materials[0]["reflectance"] = session.add_texture(image, name="holes")
        session.render(size=(8, 8), samples=1)
    assert any("holes" in r.getMessage() for r in caplog.records), [r.getMessage() for r in caplog.records]
