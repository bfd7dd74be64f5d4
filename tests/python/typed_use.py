# SPDX-License-Identifier: Apache-2.0
"""The package as shown in its documentation. Type checkers must accept this file (test_types.py); it is run as well."""
import pathlib

import numpy as np

import restage


def use(folder: pathlib.Path) -> None:
    with restage.new() as session:
        positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
        brass = session.add_material("Brass", "conductor", uroughness=0.2, vroughness=0.2)
        brass["uroughness"] = np.float32(0.3)
        paint = session.add_material("Paint", "diffuse", reflectance=np.array([0.1, 0.2, 0.3]))
        paint["reflectance"] = np.array([0.3, 0.2, 0.1], np.float32)
        paint["reflectance"] = (0.3, 0.2, 0.1)
        paint["reflectance"] = [0.3, 0.2, 0.1]
        paint["reflectance"] = session.add_texture(np.zeros((4, 4, 3), np.float32), name="Picture")
        sheet = session.add_mesh(positions, [[0, 1, 2]], name="Sheet", material=paint, uvs=positions[:, :2], transform=np.eye(4))
        corners: np.ndarray = sheet.vertices @ np.eye(3)
        assert corners.shape == (3, 3)
        sheet.move(np.array([0.0, 1.0, 0.0]))
        sheet.move((0, 1, 0))
        sheet.move_to([0, 1, 0])
        sheet.rotate(30, axis=np.array([0, 1, 0]), center=(0, 0, 0))
        sheet.scale(2)
        sheet.scale(np.array([1, 2, 1]))
        sheet.transform = np.eye(4)
        sheet.transform_by(np.diag([2, 2, 2, 1]))
        sheet.emission = np.array([1, 1, 1])
        sheet.emission = None
        sheet.material = brass
        copy = sheet.duplicate(by=np.array([1, 0, 0]))
        copy.mirror("x", at=1)
        row: restage.Selection = copy.array(3, by=(1, 0, 0))
        row.array_around(2, np.zeros(3), degrees=90, turn=False).remove()
        sheet.project_texture(0.5, axes="world")
        row.array_along([(1, 0, 0), np.ones(3)], spacing=0.5, smooth=False).remove()
        group = session.add_group([sheet, copy], "Pair")
        found: restage.Group | restage.Object = session.find("Pair")
        session.select(found, sheet).hidden = True
        session.select(group).hidden = False
        strewn: restage.ActionResult = session.run_action("scatter", [copy, sheet], count=3, seed=2)
        strewn.objects.remove()
        actions: list[str] = [action.label for action in session.actions()]
        assert "Scatter" in actions

        camera = session.add_camera(np.array([3, 2, 3]), (0, 0, 0), fov=30, name="Corner")
        camera.projection = "orthographic"
        camera.screen_window = (-1, 1, -1, 1)
        camera.screen_window = None
        camera.position = np.array([3, 2, 4])
        camera.look_at(np.zeros(3), up=(0, 1, 0))
        camera.transform = camera.transform @ np.eye(4)
        session.camera = camera
        camera.projection = "spherical"
        camera.projection = "perspective"
        session.add_light("point", np.array([1, 2, 3])).position = np.array([0, 3, 0])
        session.set_sky(color=np.array([1, 1, 1]), strength=0.5)
        session.set_sky(image=np.ones((8, 16, 3), np.float32), rotation=90, hidden_from_camera=True)
        session.size = (16, 12)
        session.crop = (0, 1, 0, 1)
        session.exposure = 2

        with session.step("Restyle"):
            brass.update(uroughness=0.5)
        seen: list[float] = []

        def watch(progress: restage.Progress) -> bool:
            seen.append(progress.fraction)
            return True

        picture = session.render(size=(16, 12), samples=2, progress=watch, denoise="fast")
        mean: float = float(picture.color.mean())
        array: np.ndarray = np.asarray(picture)
        assert mean >= 0 and array.shape == (12, 16, 3)
        mask: np.ndarray = picture.mask(group) & (picture.depth > 0)
        picture.color[mask] *= 0.5
        if picture.denoised is not None:
            assert picture.denoised.dtype == np.float32
        thing: restage.Object = session.objects.by_id(int(picture.object_id.max()) or sheet.id)
        assert thing.exists
        picture.save(folder / "picture.png", exposure=1)
        restage.merge([picture]).save(str(folder / "picture.exr"), aovs="none")
        report: restage.Report = session.export(folder / "out.pbrt", version="v4")
        print(report.kept, [entry.note for entry in report.entries])
        names: list[str] = [item.name for item in session.materials] + session.objects.names
        assert "Paint" in session.materials and session.materials["Paint"] == paint and names

    glass = restage.Bsdf("dielectric")
    sample = glass.sample(np.array([0, 0, 1.0]), np.random.default_rng(1).random((4, 3)), {"uroughness": 0.1, "vroughness": 0.1})
    assert glass.eval((0, 0, 1), sample.wi).shape == (4, 3)
