# SPDX-License-Identifier: Apache-2.0
"""Furniture of the demo scene: round table, chair, sideboard, pendant lamp, books."""

import numpy as np

from .mesh import (
    Mesh,
    above,
    box_between,
    fillet,
    grid_faces,
    lathe,
    merge,
    planar_uv,
    rotate,
    rounded_rectangle,
    scale,
    slab,
    smooth_curve,
    superellipse,
    sweep,
    translate,
    tube,
    z_to,
)

TABLE_HEIGHT = 0.74


def leg(bottom, top, r_bottom, r_top, segments=20):
    """A tapered round leg standing flat on z = bottom's z."""
    bottom, top = np.asarray(bottom, float), np.asarray(top, float)
    axis = top - bottom
    length = np.linalg.norm(axis)
    t = np.linspace(0, 1, 8)
    swell = r_bottom + (r_top - r_bottom) * (1 - (1 - t) ** 2)
    profile = np.concatenate([[(0, -0.01), (r_bottom, -0.01)], np.stack([swell, t * length], 1), [(0, length)]])
    m = lathe(profile, segments).moved(translate(*bottom) @ z_to(axis))
    m.v[:, 2] = np.maximum(m.v[:, 2], bottom[2])
    m.uv = np.stack([m.uv[:, 0] * 2 * np.pi * r_top, m.uv[:, 1]], 1)
    return m


def table(scene, centre, angle):
    scene.section("Table")
    scene.texture("walnut grain", "spectrum", "walnut.png", uscale=1.25, vscale=0.8)
    scene.texture("oak grain", "spectrum", "oak.png", uscale=3.0, vscale=1.5)
    scene.material("Walnut", "coateddiffuse", reflectance=("texture", "walnut grain"), roughness=0.22)
    scene.material("Oak", "coateddiffuse", reflectance=("texture", "oak grain"), roughness=0.3)
    radius, h = 0.60, TABLE_HEIGHT
    top = lathe(
        fillet(
            [(0, h - 0.030), (radius - 0.035, h - 0.030), (radius, h - 0.008), (radius, h), (0, h)],
            [0, 0.010, 0.008, 0.005, 0],
            4,
        ),
        128,
    )
    top = planar_uv(top, grain=1)
    parts = [top]
    apron = lathe(fillet([(0.40, h - 0.03), (0.40, h - 0.095), (0.42, h - 0.095), (0.42, h - 0.03)], 0.004, 3), 96)
    apron.uv = np.stack([apron.uv[:, 1], apron.uv[:, 0] * 2 * np.pi * 0.42], 1)
    parts.append(apron)
    for k in range(4):
        c, s = np.cos(np.pi / 4 + k * np.pi / 2), np.sin(np.pi / 4 + k * np.pi / 2)
        parts.append(
            leg((0.47 * c, 0.47 * s, 0), (0.36 * c, 0.36 * s, h - 0.03), 0.016, 0.029).with_uv(1, (0.21 * k, 0.1 * k))
        )
    scene.object("Table", ("Walnut", scene.mesh("table", merge(*parts)), "Table"))
    scene.place("Table", translate(*centre, 0) @ rotate((0, 0, 1), angle))


def chair(scene):
    """Stands at the origin; a person sitting on it looks along +y."""
    scene.section("Chairs")
    scene.material(
        "Cushion wool", "diffuse", reflectance=(0.072, 0.125, 0.175), displacement=("texture", "cloth height")
    )
    seat_z = 0.445
    parts = [planar_uv(slab(superellipse(0.45, 0.43, 3.6, 72), seat_z - 0.024, seat_z, 0.008), grain=1)]
    for sx in (-1, 1):
        parts.append(
            leg((sx * 0.215, 0.205, 0), (sx * 0.165, 0.155, seat_z - 0.018), 0.011, 0.018).with_uv(1, (0.3 + sx, 0))
        )
        parts.append(
            leg((sx * 0.205, -0.225, 0), (sx * 0.155, -0.155, seat_z - 0.018), 0.011, 0.018).with_uv(1, (0.6 + sx, 0))
        )
        parts.append(tube([(sx * 0.198, 0.187, 0.16), (sx * 0.194, 0.0, 0.16), (sx * 0.188, -0.201, 0.16)], 0.0085, 12))
        post = smooth_curve(
            [
                (sx * 0.178, -0.165, seat_z - 0.02),
                (sx * 0.190, -0.187, 0.56),
                (sx * 0.198, -0.215, 0.68),
                (sx * 0.200, -0.245, 0.775),
            ],
            6,
        )
        parts.append(tube(post, np.linspace(0.0125, 0.0100, len(post)), 14))
    parts.append(tube([(-0.191, 0.0, 0.16), (0, 0.0, 0.16), (0.191, 0.0, 0.16)], 0.0085, 12))
    x = np.linspace(-0.232, 0.232, 25)
    bow = -0.243 - 0.055 * (1 - (x / 0.232) ** 2)
    rail = np.stack([x, bow, np.full_like(x, 0.775)], 1)
    parts.append(sweep(rail, rounded_rectangle(0.020, 0.088, 0.009, 4), scales=1 - 0.25 * np.abs(x / 0.232) ** 6))
    for k in range(6):
        f = -0.125 + 0.05 * k
        spindle = smooth_curve(
            [
                (0.86 * f, -0.185, seat_z - 0.01),
                (0.95 * f, -0.215 - 0.02 * (1 - (f / 0.2) ** 2), 0.60),
                (f * 1.04, -0.243 - 0.055 * (1 - (f / 0.232) ** 2), 0.76),
            ],
            5,
        )
        parts.append(tube(spindle, 0.0058, 9))
    cushion = slab(
        superellipse(0.415, 0.395, 3.2, 72), seat_z - 0.002, seat_z + 0.030, 0.0155, 6, crown=0.012, crown_rings=6
    )
    seam = superellipse(0.413, 0.393, 3.2, 72)
    path = np.column_stack([np.concatenate([seam, seam[:2]]), np.full(74, seat_z + 0.014)])
    cushion = merge(cushion, tube(path, 0.0028, 6, up=(0, 0, 1)))
    scene.object(
        "Chair",
        ("Oak", scene.mesh("chair-frame", merge(*parts)), "Chair frame"),
        ("Cushion wool", scene.mesh("chair-cushion", cushion), "Chair cushion"),
    )


def sideboard(scene, x, width=1.5):
    """Stands against the back wall; front towards -y."""
    scene.section("Sideboard")
    depth, z0, z1, front = 0.40, 0.16, 0.74, -0.41
    parts = [
        box_between((-width / 2, front, z1 - 0.024), (width / 2, front + depth, z1), 0.004),
        box_between((-width / 2, front, z0), (width / 2, front + depth, z0 + 0.024), 0.004),
        box_between((-width / 2, front, z0 + 0.01), (-width / 2 + 0.024, front + depth, z1 - 0.01), 0.004, grain=2),
        box_between((width / 2 - 0.024, front, z0 + 0.01), (width / 2, front + depth, z1 - 0.01), 0.004, grain=2),
        box_between(
            (-width / 2 + 0.01, front + depth - 0.02, z0 + 0.01),
            (width / 2 - 0.01, front + depth - 0.01, z1 - 0.01),
            0.002,
        ),
    ]
    rng = np.random.default_rng(9)
    slats = []
    span = width - 0.056
    count = 52
    for k in range(count):  # tambour doors
        xa = -span / 2 + span * k / count
        m = box_between(
            (xa + 0.0015, front + 0.008, z0 + 0.026),
            (xa + span / count - 0.0015, front + 0.022, z1 - 0.026),
            0.005,
            1,
            grain=2,
        )
        slats.append(m.with_uv(1, rng.random(2)))
    parts.append(box_between((-span / 2, front + 0.02, z0 + 0.02), (span / 2, front + 0.03, z1 - 0.02), 0.002))
    for sx in (-1, 1):
        for y in (front + 0.06, front + depth - 0.06):
            parts.append(leg((sx * (width / 2 - 0.10), y, 0), (sx * (width / 2 - 0.14), y, z0 + 0.005), 0.012, 0.020))
    scene.object(
        "Sideboard",
        ("Walnut", scene.mesh("sideboard", merge(*parts)), "Sideboard"),
        ("Walnut", scene.mesh("sideboard-slats", merge(*slats)), "Sideboard doors"),
    )
    scene.place("Sideboard", translate(x, 0, 0))
    return z1


def pendant(scene, centre, z, ceiling):
    """A spun dome that hangs from the ceiling on a cloth cable; the lamp is off, its bulb is opal glass."""
    scene.section("Pendant lamp")
    scene.material("Copper", "conductor", eta="metal-Cu-eta", k="metal-Cu-k", roughness=0.12)
    scene.material("Opal glass", "coateddiffuse", reflectance=(0.80, 0.78, 0.74), roughness=0.05)
    scene.material("Lamp white", "diffuse", reflectance=(0.80, 0.79, 0.76))
    scene.material("Black cable", "diffuse", reflectance=(0.025, 0.023, 0.022))
    outer = smooth_curve(
        [
            (0.200, 0.000),
            (0.196, 0.022),
            (0.180, 0.070),
            (0.148, 0.118),
            (0.098, 0.156),
            (0.050, 0.176),
            (0.030, 0.188),
        ],
        6,
    )
    neck = fillet([(0.030, 0.188), (0.030, 0.232), (0.012, 0.245), (0.006, 0.262), (0, 0.262)], 0.004, 3)
    rim = [(0.1965, -0.0015), (0.1990, -0.0012)]
    shade = lathe(np.concatenate([rim, outer[:-1], neck]), 80)
    inside = lathe(np.concatenate([[(0, 0.176)], (outer - [0.0026, 0.002])[::-1][2:], [(0.1965, -0.0015)]]), 64)
    cable = tube([(0, 0, 0.255), (0, 0, (ceiling - z) / 2), (0, 0, ceiling - z - 0.02)], 0.0034, 10)
    rose = lathe(
        fillet(
            [(0.0, ceiling - z - 0.028), (0.046, ceiling - z - 0.022), (0.050, ceiling - z), (0, ceiling - z)], 0.008
        ),
        40,
    )
    bulb = 'Shape "sphere"\n        "float radius" [ 0.042 ]'
    scene.object(
        "Pendant lamp",
        ("Copper", scene.mesh("lamp-shade", merge(shade, rose)), "Lamp shade"),
        ("Lamp white", scene.mesh("lamp-inside", inside), "Lamp inside"),
        ("Black cable", scene.mesh("lamp-cable", cable), "Lamp cable"),
    )
    scene.object("Bulb", ("Opal glass", bulb, "Bulb"))
    at = translate(*centre, z)
    scene.place("Pendant lamp", at)
    scene.place("Bulb", at @ translate(0, 0, 0.075))


def book_meshes(scene):
    """A unit book lying flat: x 0..1 (spine at x = 0), y 0..1, z 0..1; scaled when placed. Cover and page block."""
    t = np.linspace(np.pi / 2, 3 * np.pi / 2, 13)
    spine_out = np.stack([0.045 + 0.06 * np.cos(t), 0.5 + 0.5 * np.sin(t)], 1)  # (x, z): top to bottom
    spine_in = np.stack([0.045 + 0.035 * np.cos(t), 0.5 + 0.42 * np.sin(t)], 1)
    outside = np.concatenate([[(1.0, 1.0)], spine_out, [(1.0, 0.0)]])
    inside = np.concatenate([[(1.0, 0.92)], spine_in, [(1.0, 0.08)]])
    body = sweep([(0, -0.5, 0), (0, 0.5, 0)], np.concatenate([outside, inside[::-1]]), up=(0, 0, 1), caps=False)
    ends = []
    for y in (-0.5, 0.5):
        strip = np.stack([np.insert(outside, 1, y, 1), np.insert(inside, 1, y, 1)])
        cap = Mesh(
            strip,
            np.tile([0, np.sign(y), 0], (strip.shape[0] * strip.shape[1], 1)),
            strip[..., ::2],
            grid_faces(*strip.shape[:2]),
        )
        ends.append(cap if y > 0 else Mesh(cap.v, cap.n, cap.uv, cap.f[:, ::-1]))
    cover = crease(merge(body, *ends), 40)
    t2 = np.linspace(np.pi / 2, 3 * np.pi / 2, 9)
    fore = np.stack([0.975 + 0.035 * np.cos(t2), 0.5 - 0.42 * np.sin(t2)], 1)
    block = np.concatenate([spine_in, fore])
    pages = crease(sweep([(0, -0.482, 0), (0, 0.482, 0)], block, up=(0, 0, 1)), 40)
    pages.uv = np.stack([pages.v[:, 1], pages.v[:, 2]], 1)
    return scene.mesh("book-cover", cover), scene.mesh("book-pages", pages)


def crease(mesh, degrees):
    """Split vertices so that edges sharper than an angle keep flat shading on both sides."""
    v = mesh.v[mesh.f]
    face_n = np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0])
    area = np.linalg.norm(face_n, axis=1, keepdims=True)
    unit = face_n / np.maximum(area, 1e-20)
    key = np.unique(np.round(mesh.v[mesh.f.ravel()], 6), axis=0, return_inverse=True)[1].ravel()
    corners = {}
    for corner, k in enumerate(key):
        corners.setdefault(int(k), []).append(corner)
    normals = np.zeros((len(key), 3))
    limit = np.cos(np.radians(degrees))
    for group in corners.values():
        faces = np.array(group) // 3
        near = above(unit[faces] @ unit[faces].T, limit)
        total = near @ face_n[faces]
        normals[group] = total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-20)
    flat = mesh.f.ravel()
    return Mesh(mesh.v[flat], normals, mesh.uv[flat], np.arange(len(flat)))


BOOKS = {
    "Red": (0.36, 0.075, 0.055),
    "Ochre": (0.56, 0.34, 0.09),
    "Blue": (0.045, 0.075, 0.13),
    "Cream": (0.62, 0.56, 0.44),
    "Green": (0.07, 0.16, 0.115),
}


def books(scene):
    scene.section("Books")
    scene.texture("page edges", "spectrum", "page-edges.png", vscale=2)
    scene.material("Paper", "diffuse", reflectance=("texture", "page edges"))
    cover, pages = book_meshes(scene)
    for name, rgb in BOOKS.items():
        scene.material(f"{name} book cloth", "coateddiffuse", reflectance=rgb, roughness=0.45)
        scene.object(
            f"{name} book", (f"{name} book cloth", cover, f"{name} book cover"), ("Paper", pages, "Book pages")
        )


def stack_books(scene, where, names, sizes, angles):
    """A pile: sizes are (width, height, thickness) in metres."""
    z = where[2]
    for name, size, angle in zip(names, sizes, angles):
        m = translate(where[0], where[1], z) @ rotate((0, 0, 1), angle) @ translate(-size[0] / 2, 0, 0) @ scale(*size)
        scene.place(f"{name} book", m)
        z += size[2] + 0.0008


def upright_books(scene, where, names, sizes):
    """A row of standing books, spines towards -y, from left to right."""
    x = where[0]
    for name, size in zip(names, sizes):
        # lying (x width, y height, z thickness) to standing: spine (x = 0) to -y, height up, thickness along +x
        basis = np.eye(4)
        basis[:3, 0], basis[:3, 1], basis[:3, 2] = (0, 1, 0), (0, 0, 1), (1, 0, 0)
        m = translate(x, where[1], where[2]) @ basis @ scale(*size) @ translate(0, 0.5, 0)
        scene.place(f"{name} book", m)
        x += size[2] + 0.001
