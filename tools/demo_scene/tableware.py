# SPDX-License-Identifier: Apache-2.0
"""On table and sideboard: tray, carafe, glasses, fruit bowl, vase with a branch; and the plant in the corner."""

import numpy as np

from .mesh import fillet, lathe, merge, rotate, scale, sheet, smooth_curve, translate, tube, unit_uv, z_to

WATER, GLASS = 1.333, 1.5


def vessel(scene, name, outer, inner, level):
    """Glass with water in it, as three interfaces: air-glass, glass-water, water-air; outlines run bottom to top.

    Each surface's normal points to its thinner side, so that its eta is (behind the normal) / (in front of it).
    """
    inner = np.asarray(inner, float)
    k = int(np.searchsorted(inner[:, 1], level))
    t = (level - inner[k - 1, 1]) / (inner[k, 1] - inner[k - 1, 1])
    shore = inner[k - 1] + t * (inner[k] - inner[k - 1])
    rim_r = 0.5 * (outer[-1][0] + inner[-1][0])
    half = 0.5 * (outer[-1][0] - inner[-1][0])
    a = np.linspace(0, np.pi, 7)[1:-1]
    rim = np.stack([rim_r + half * np.cos(a), outer[-1][1] + half * np.sin(a)], 1)
    dry = lathe(np.concatenate([outer, rim, inner[: k - 1 : -1], [shore]]), 64)
    wet = lathe(np.concatenate([[shore], inner[:k][::-1]]), 64)
    surface = lathe([shore, (0, level)], 64)
    slug = name.lower()
    return (
        ("Clear glass", scene.mesh(f"{slug}-glass", dry), f"{name} glass"),
        ("Glass to water", scene.mesh(f"{slug}-wet", wet), f"{name} glass under water"),
        ("Water", scene.mesh(f"{slug}-water", surface), f"{name} water"),
    )


def glassware(scene):
    scene.section("Tray, carafe and glasses")
    scene.material("Clear glass", "dielectric", eta=GLASS)
    scene.material("Glass to water", "dielectric", eta=round(GLASS / WATER, 5))
    scene.material("Water", "dielectric", eta=WATER)
    body = smooth_curve(
        [
            (0.040, 0.003),
            (0.052, 0.016),
            (0.058, 0.045),
            (0.056, 0.080),
            (0.045, 0.115),
            (0.030, 0.145),
            (0.0235, 0.172),
            (0.0245, 0.205),
            (0.031, 0.235),
        ],
        5,
    )
    outer = np.concatenate([fillet([(0, 0), (0.036, 0), (0.040, 0.003)], 0.003, 3)[:-1], body])
    wall = smooth_curve(
        [
            (0.0375, 0.0085),
            (0.0490, 0.0185),
            (0.0552, 0.045),
            (0.0533, 0.080),
            (0.0425, 0.114),
            (0.0276, 0.1445),
            (0.0211, 0.172),
            (0.0222, 0.205),
            (0.0288, 0.235),
        ],
        5,
    )
    inner = np.concatenate([[(0, 0.007)], [(0.02, 0.0072)], wall])
    scene.object("Carafe", *vessel(scene, "Carafe", outer, inner, 0.098))
    outer = fillet([(0, 0), (0.029, 0), (0.036, 0.085)], [0, 0.005, 0], 5)
    outer = np.concatenate([outer[:-1], np.linspace(outer[-2], outer[-1], 6)[1:]])
    inner = fillet([(0, 0.008), (0.0268, 0.008), (0.0340, 0.085)], [0, 0.006, 0], 5)
    inner = np.concatenate([inner[:-1], np.linspace(inner[-2], inner[-1], 12)[1:]])
    scene.object("Glass", *vessel(scene, "Glass", outer, inner, 0.052))
    tray = fillet(
        [(0, 0), (0.150, 0), (0.168, 0.016), (0.1705, 0.0155), (0.1535, 0.0022), (0, 0.0022)],
        [0, 0.012, 0.0008, 0.0008, 0.012, 0],
        6,
    )
    scene.object("Tray", ("Brass", scene.mesh("tray", lathe(tray, 80)), "Tray"))


def bowl(scene):
    scene.section("Bowl and fruit")
    scene.material("Glazed stoneware", "coateddiffuse", reflectance=(0.70, 0.69, 0.65), roughness=0.08)
    scene.texture("peel height", "float", "orange-height.png", encoding="linear", scale=0.0035, uscale=3, vscale=2)
    scene.material(
        "Orange peel",
        "coateddiffuse",
        reflectance=(0.83, 0.30, 0.025),
        roughness=0.33,
        displacement=("texture", "peel height"),
    )
    scene.material(
        "Lemon peel",
        "coateddiffuse",
        reflectance=(0.85, 0.62, 0.05),
        roughness=0.3,
        displacement=("texture", "peel height"),
    )
    scene.material("Pear skin", "coateddiffuse", reflectance=(0.42, 0.46, 0.09), roughness=0.28)
    scene.material("Bark", "diffuse", reflectance=(0.13, 0.085, 0.05))
    outside = smooth_curve([(0.052, 0.002), (0.060, 0.012), (0.088, 0.034), (0.122, 0.062), (0.142, 0.086)], 6)
    inside = smooth_curve(
        [(0.1375, 0.0865), (0.117, 0.065), (0.084, 0.039), (0.050, 0.022), (0.018, 0.015), (0, 0.0145)], 6
    )
    profile = np.concatenate(
        [
            [(0, 0.003), (0.040, 0.003)],
            fillet([(0.043, 0), (0.050, 0), (0.052, 0.002)], 0.001, 2),
            outside[1:],
            [(0.1412, 0.0880), (0.1392, 0.0882)],
            inside,
        ]
    )
    scene.object("Bowl", ("Glazed stoneware", scene.mesh("bowl", lathe(profile, 72)), "Bowl"))
    t = np.linspace(-np.pi / 2, np.pi / 2, 37)
    dimple = 1 - 0.10 * np.exp(-(((np.pi / 2 - t) / 0.20) ** 2)) - 0.05 * np.exp(-(((t + np.pi / 2) / 0.16) ** 2))
    orange = np.stack([np.cos(t), 0.94 * np.sin(t) * dimple], 1) * 0.0385
    orange[[0, -1], 0] = 0
    scene.object("Orange", ("Orange peel", scene.mesh("orange", unit_lathe(orange)), "Orange"))
    lemon = np.stack([0.029 * np.cos(t) ** 0.9, 0.0335 * np.sin(t) + 0.010 * np.sin(t) ** 9], 1)
    lemon[[0, -1], 0] = 0
    scene.object("Lemon", ("Lemon peel", scene.mesh("lemon", unit_lathe(lemon)), "Lemon"))
    pear = smooth_curve(
        [
            (0, -0.041),
            (0.014, -0.044),
            (0.030, -0.036),
            (0.038, -0.016),
            (0.035, 0.006),
            (0.024, 0.026),
            (0.0165, 0.044),
            (0.011, 0.054),
            (0.0, 0.055),
        ],
        5,
    )
    stalk = tube(smooth_curve([(0, 0, 0.052), (0.001, 0, 0.062), (0.006, 0.001, 0.074)], 4), 0.0016, 7)
    scene.object(
        "Pear",
        ("Pear skin", scene.mesh("pear", unit_lathe(pear)), "Pear"),
        ("Bark", scene.mesh("pear-stalk", stalk), "Pear stalk"),
    )


def unit_lathe(profile, segments=56):
    m = lathe(profile, segments)
    m.uv = m.uv / np.maximum(m.uv.max(0), 1e-9)
    return m


def leaf_mesh(length, width, fold=0.22, droop=0.30, rows=13, columns=7):
    """A leaf from the origin along +y, upper side +z; uv (0..1) across and along."""
    t = np.linspace(0, 1, rows)[:, None]
    s = np.linspace(-1, 1, columns)[None, :]
    half = 0.5 * width * np.sin(np.pi * t**0.82) ** 0.75 * (1 - 0.28 * t) + 0.001
    x = half * s + 0 * t
    wave = 0.03 * width * np.sin(9 * t + 1.5) * s**2
    z = fold * np.abs(x) * (1 - 0.5 * t) - droop * length * t**2 * 0.5 + 0.12 * length * t + wave
    y = length * (t - 0.06 * t**2) + 0 * s
    uv = unit_uv(rows, columns)
    return sheet(np.stack([x, y, z], -1), uv).flipped()


def leaves_up(mesh):
    return mesh if mesh.n[:, 2].mean() > 0 else mesh.flipped()


def vase(scene):
    """A stoneware vase with a branch of small leaves."""
    scene.section("Vase with a branch")
    scene.material("Matt stoneware", "coateddiffuse", reflectance=(0.30, 0.155, 0.10), roughness=0.42)
    scene.material(
        "Young leaf", "diffusetransmission", reflectance=(0.17, 0.27, 0.10), transmittance=(0.13, 0.22, 0.05)
    )
    outer = smooth_curve(
        [
            (0.040, 0.003),
            (0.060, 0.030),
            (0.070, 0.075),
            (0.062, 0.125),
            (0.040, 0.165),
            (0.026, 0.190),
            (0.025, 0.215),
            (0.031, 0.235),
        ],
        6,
    )
    inner = [(0.0285, 0.2355), (0.0225, 0.215), (0.0235, 0.190), (0.037, 0.163), (0.055, 0.12), (0.05, 0.05), (0, 0.03)]
    profile = np.concatenate([[(0, 0.001), (0.030, 0.001), (0.036, 0.0)], outer, smooth_curve(inner, 4)])
    rng = np.random.default_rng(17)
    small = leaves_up(leaf_mesh(0.074, 0.036, rows=7, columns=5))
    stems, leaves = [], []
    for k, (dx, dy, top) in enumerate(
        ((0.21, 0.02, 0.60), (-0.17, 0.04, 0.66), (0.05, -0.12, 0.50), (-0.02, 0.09, 0.76), (0.12, -0.05, 0.70))
    ):
        path = smooth_curve(
            [
                (-dx * 0.15, -dy * 0.15, 0.04),
                (0.03 * dx, 0.03 * dy, 0.225),
                (0.35 * dx, 0.4 * dy, 0.36),
                (0.72 * dx, 0.7 * dy, 0.24 + 0.62 * (top - 0.24)),
                (dx, dy, top),
            ],
            8,
        )
        stems.append(tube(path, np.linspace(0.0030, 0.0012, len(path)), 7))
        for j, i in enumerate(range(14, len(path), 2)):
            along = path[min(i + 1, len(path) - 1)] - path[i - 1]
            for side in (0, 180):
                turn = 90 * (j % 2) + side + rng.normal(0, 18) + 40 * k
                size = 0.75 + 0.5 * rng.random() - 0.25 * i / len(path)
                m = (
                    translate(*path[i])
                    @ z_to(along)
                    @ rotate((0, 0, 1), turn)
                    @ rotate((1, 0, 0), 38 + rng.normal(0, 10))
                    @ scale(size)
                )
                leaves.append(small.moved(m))
    scene.object(
        "Vase",
        ("Matt stoneware", scene.mesh("vase", lathe(profile, 56)), "Vase"),
        ("Bark", scene.mesh("vase-stems", merge(*stems)), "Vase stems"),
        ("Young leaf", scene.mesh("vase-leaves", merge(*leaves)), "Vase leaves"),
    )


def plant(scene, where):
    """A rubber fig in a clay pot, its leaves instances of one."""
    scene.section("Plant")
    scene.texture("fig leaf", "spectrum", "leaf.png")
    scene.material("Fig leaf", "coateddiffuse", reflectance=("texture", "fig leaf"), roughness=0.2)
    scene.material("Terracotta", "diffuse", reflectance=(0.50, 0.235, 0.135))
    scene.material("Soil", "diffuse", reflectance=(0.035, 0.025, 0.018))
    pot = fillet(
        [
            (0, 0.0),
            (0.115, 0.0),
            (0.150, 0.255),
            (0.162, 0.255),
            (0.166, 0.305),
            (0.148, 0.305),
            (0.142, 0.24),
            (0.135, 0.2),
        ],
        [0, 0.012, 0.003, 0.004, 0.007, 0.006, 0.004, 0],
        4,
    )
    soil = lathe([(0.146, 0.268), (0.07, 0.275), (0, 0.278)], 48)
    saucer = fillet(
        [(0, 0), (0.16, 0), (0.185, 0.022), (0.18, 0.024), (0.155, 0.006), (0, 0.006)],
        [0, 0.008, 0.002, 0.002, 0.008, 0],
        4,
    )
    rng = np.random.default_rng(23)
    stems, spots = [], []
    for dx, dy, top, count in ((0.10, -0.06, 1.62, 13), (-0.09, -0.03, 1.32, 9), (0.05, 0.07, 1.05, 6)):
        path = smooth_curve(
            [
                (0.3 * dx, 0.3 * dy, 0.26),
                (0.7 * dx, 0.5 * dy, 0.26 + 0.35 * (top - 0.26)),
                (0.9 * dx, dy, 0.26 + 0.7 * (top - 0.26)),
                (1.3 * dx, 1.4 * dy, top),
            ],
            10,
        )
        stems.append(tube(path, np.linspace(0.013, 0.005, len(path)), 9))
        turn = rng.random() * 360
        for k in range(count):
            i = int(len(path) * (0.34 + 0.65 * k / (count - 1))) - 1
            turn += 137.5
            grown = 0.72 + 0.35 * np.sin(np.pi * min(1, 0.25 + k / count)) + rng.normal(0, 0.05)
            pitch = 24 + 34 * k / count + rng.normal(0, 8) - 20
            outward = rotate((0, 0, 1), turn)
            m = translate(*path[i]) @ outward @ rotate((1, 0, 0), pitch) @ rotate((0, 1, 0), rng.normal(0, 9))
            stems.append(tube([(0, 0, 0), (0, 0.02, 0.003), (0, 0.045, 0.004)], 0.0028, 6).moved(m))
            spots.append(m @ translate(0, 0.042, 0.004) @ scale(grown))
    scene.object(
        "Plant",
        ("Terracotta", scene.mesh("plant-pot", merge(lathe(pot, 56), lathe(saucer, 56))), "Plant pot"),
        ("Soil", scene.mesh("plant-soil", soil), "Plant soil"),
        ("Bark", scene.mesh("plant-stems", merge(*stems)), "Plant stems"),
    )
    scene.object(
        "Leaf", ("Fig leaf", scene.mesh("plant-leaf", leaves_up(leaf_mesh(0.27, 0.135, rows=19, columns=11))), "Leaf")
    )
    base = translate(*where, 0)
    scene.place("Plant", base)
    for m in spots:
        scene.place("Leaf", base @ m)
