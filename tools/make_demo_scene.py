#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes scenes/demo (pbrt-v4), a breakfast corner at late morning, and the sky of scenes/spheres. Needs numpy."""

from demo_scene import daylight, furniture, images, room, sky, tableware, textures
from demo_scene.mesh import rotate, scale, translate
from demo_scene.writer import Scene

EYE, TARGET, FOV = (3.72, -4.50, 1.48), (1.56, -0.90, 0.93), 36.0
TABLE = (1.95, -1.62)


def furnish(scene):
    room.shell(scene)
    room.window(scene)
    room.curtains(scene)
    furniture.table(scene, TABLE, 38)
    room.rug(scene, (TABLE[0] + 0.05, TABLE[1] - 0.1), 4)
    furniture.chair(scene)
    for x, y, turn in ((0.60, -0.52, 50), (0.10, 0.82, 172), (-0.80, -0.30, -66)):
        scene.place("Chair", translate(TABLE[0] + x, TABLE[1] + y, 0.013) @ rotate((0, 0, 1), turn))
    top = furniture.sideboard(scene, 2.45)
    furniture.pendant(scene, (TABLE[0], TABLE[1]), 1.62, room.HEIGHT)
    furniture.books(scene)
    room.picture(scene, 2.28, 1.52)
    room.mirror(scene, 3.02, 1.50)
    scene.place("Picture", translate(1.66, 0.002 - room.DEPTH, 1.52) @ rotate((0, 0, 1), 180))
    lay_table(scene)
    tableware.vase(scene)
    scene.place("Vase", translate(1.90, -0.21, top) @ scale(1.12))
    furniture.stack_books(
        scene,
        (2.42, -0.21, top),
        ("Blue", "Ochre", "Cream"),
        ((0.21, 0.28, 0.034), (0.19, 0.26, 0.026), (0.16, 0.22, 0.03)),
        (88, 97, 84),
    )
    furniture.upright_books(
        scene,
        (2.70, -0.31, top),
        ("Green", "Red", "Cream", "Blue", "Ochre", "Red"),
        (
            (0.16, 0.235, 0.030),
            (0.15, 0.215, 0.024),
            (0.17, 0.245, 0.036),
            (0.15, 0.205, 0.020),
            (0.16, 0.228, 0.028),
            (0.15, 0.20, 0.022),
        ),
    )
    tableware.plant(scene, (0.47, -0.40))


def lay_table(scene):
    z = furniture.TABLE_HEIGHT
    x, y = TABLE
    tableware.glassware(scene)
    scene.place("Tray", translate(x + 0.19, y + 0.16, z))
    scene.place("Carafe", translate(x + 0.16, y + 0.21, z + 0.0023))
    scene.place("Glass", translate(x + 0.265, y + 0.145, z + 0.0023))
    scene.place("Glass", translate(x + 0.175, y + 0.095, z + 0.0023))
    tableware.bowl(scene)
    bx, by = x - 0.21, y - 0.10
    scene.place("Bowl", translate(bx, by, z))
    fruit = (
        ("Orange", 0.052, 0.014, 0.063, 20, 40),
        ("Orange", -0.050, 0.030, 0.062, 70, 10),
        ("Orange", 0.000, -0.056, 0.061, 130, 70),
        ("Orange", 0.004, 0.004, 0.118, 35, 190),
        ("Lemon", 0.036, 0.078, 0.078, 85, 30),
        ("Lemon", -0.062, -0.042, 0.072, 80, 120),
    )
    for name, dx, dy, dz, tilt, turn in fruit:
        scene.place(
            name,
            translate(bx + dx, by + dy, z + dz) @ rotate((0, 0, 1), turn) @ rotate((1, 0, 0), tilt),
        )
    scene.place("Pear", translate(bx + 0.20, by - 0.09, z + 0.0435) @ rotate((0, 0, 1), 30) @ scale(1))
    scene.place("Pear", translate(bx + 0.275, by - 0.045, z + 0.0365) @ rotate((0, 0, 1), 160) @ rotate((1, 0, 0), 96))


def write(scene):
    head = daylight.head("A breakfast corner", "demo", EYE, TARGET, FOV)
    scene.write("demo.pbrt", head, daylight.lights(Scene.textures))


def main(scenes):
    folder = scenes / "demo"
    scene = Scene(folder)
    textures.write_all(folder / "textures")
    images.write_exr(folder / "textures" / "sky.exr", sky.sky_image(512, daylight.sun_from()))
    (scenes / "spheres").mkdir(exist_ok=True)
    images.write_exr(scenes / "spheres" / "sky.exr", sky.sky_image(64, daylight.sun_from()))
    furnish(scene)
    write(scene)
    size = sum(p.stat().st_size for p in folder.rglob("*") if p.is_file())
    print(
        f"{folder}: {scene.triangles} triangles in {len(list((folder / 'geometry').iterdir()))} meshes, "
        f"{len(scene.placings)} placed, {size / 1e6:.2f} MB"
    )


if __name__ == "__main__":
    main(daylight.scenes_folder())
