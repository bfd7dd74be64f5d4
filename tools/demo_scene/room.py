# SPDX-License-Identifier: Apache-2.0
"""The room of the demo scene: plaster shell with two window openings, window, curtains, floor, rug, picture, mirror."""

import numpy as np

from .mesh import Mesh, box_between, fillet, lathe, merge, rotate, rounded_box, sheet, sweep, translate, tube, unit_uv

WIDTH, DEPTH, HEIGHT = 4.6, 5.6, 2.75  # x 0..WIDTH, y -DEPTH..0 (the back wall is y = 0), z 0..HEIGHT
WINDOW = (-2.62, -0.72, 0.42, 2.36)  # y0 y1 z0 z1 in the wall x = 0
FILL = (-5.45, -1.55, 0.10, 2.55)  # y0 y1 z0 z1 of the garden door next to the camera, in the wall x = WIDTH
REVEAL = 0.26  # thickness of the window walls


def quad(corner, a, b):
    """A flat parallelogram; its normal is a x b; uvs in metres."""
    corner, a, b = (np.asarray(x, float) for x in (corner, a, b))
    n = np.cross(a, b)
    la, lb = np.linalg.norm(a), np.linalg.norm(b)
    return Mesh(
        [corner, corner + a, corner + a + b, corner + b],
        np.tile(n / np.linalg.norm(n), (4, 1)),
        [[0, 0], [la, 0], [la, lb], [0, lb]],
        [[0, 1, 2], [0, 2, 3]],
    )


def wall_with_hole(length, height, hole, depth):
    """In the plane x = 0 facing +x, s along +y from 0 to length; the hole's reveals go back to x = -depth."""
    s0, s1, z0, z1 = hole
    parts = []
    ss, zs = (-0.1, s0, s1, length + 0.1), (-0.1, z0, z1, height + 0.1)
    for i in range(3):
        for j in range(3):
            if (i, j) != (1, 1):
                q = quad((0, ss[i], zs[j]), (0, ss[i + 1] - ss[i], 0), (0, 0, zs[j + 1] - zs[j]))
                parts.append(Mesh(q.v, q.n, q.v[:, 1:], q.f))
    parts += [
        quad((-depth, s0, z0), (depth, 0, 0), (0, s1 - s0, 0)),
        quad((-depth, s0, z1), (0, s1 - s0, 0), (depth, 0, 0)),
        quad((-depth, s0, z0), (0, 0, z1 - z0), (depth, 0, 0)),
        quad((-depth, s1, z0), (depth, 0, 0), (0, 0, z1 - z0)),
    ]
    return merge(*parts)


def shell(scene):
    scene.section("The room")
    scene.texture(
        "plaster height", "float", "plaster-height.png", encoding="linear", scale=0.006, uscale=0.8, vscale=0.8
    )
    scene.texture("floor planks", "spectrum", "floor-planks.png", uscale=0.5, vscale=0.5)
    scene.texture("floor height", "float", "floor-height.png", encoding="linear", scale=0.0012, uscale=0.5, vscale=0.5)
    scene.material("Plaster", "diffuse", reflectance=(0.80, 0.775, 0.73), displacement=("texture", "plaster height"))
    scene.material("Wall paint", "diffuse", reflectance=(0.55, 0.61, 0.55), displacement=("texture", "plaster height"))
    scene.material("Ceiling paint", "diffuse", reflectance=(0.82, 0.81, 0.78))
    scene.material(
        "Oak floor",
        "coateddiffuse",
        reflectance=("texture", "floor planks"),
        roughness=0.28,
        displacement=("texture", "floor height"),
    )
    scene.material("White paint", "coateddiffuse", reflectance=(0.78, 0.77, 0.73), roughness=0.25)
    w, d, h = WIDTH, DEPTH, HEIGHT
    window_wall = wall_with_hole(d, h, (WINDOW[0] + d, WINDOW[1] + d, *WINDOW[2:]), REVEAL).moved(translate(0, -d, 0))
    right = wall_with_hole(d, h, (-FILL[1], -FILL[0], *FILL[2:]), REVEAL)
    right = right.moved(translate(w, 0, 0) @ rotate((0, 0, 1), 180))
    rear = quad((w + 0.1, -d, -0.1), (-w - 0.2, 0, 0), (0, 0, h + 0.2))
    scene.object("Walls", ("Plaster", scene.mesh("walls", merge(window_wall, rear, right)), "Walls"))
    back = quad((-0.1, 0, -0.1), (w + 0.2, 0, 0), (0, 0, h + 0.2))
    scene.object("Back wall", ("Wall paint", scene.mesh("back-wall", back), "Back wall"))
    ceiling = quad((-0.1, -d - 0.1, h), (0, d + 0.2, 0), (w + 0.2, 0, 0))
    scene.object("Ceiling", ("Ceiling paint", scene.mesh("ceiling", ceiling), "Ceiling"))
    floor = quad((-0.1, -d - 0.1, 0), (w + 0.2, 0, 0), (0, d + 0.2, 0))
    scene.object("Floor", ("Oak floor", scene.mesh("floor", floor), "Floor"))
    profile = fillet([(0, 0), (0.016, 0), (0.016, 0.075), (0.010, 0.092), (0, 0.092)], 0.004, 3)
    along_back = sweep([(0, 0, 0), (w, 0, 0)], profile)
    along_left = sweep([(0, -d, 0), (0, 0, 0)], profile)
    scene.object(
        "Skirting board", ("White paint", scene.mesh("skirting", merge(along_back, along_left)), "Skirting board")
    )
    for label in ("Walls", "Back wall", "Ceiling", "Floor", "Skirting board"):
        scene.place(label)


def window(scene):
    scene.section("The window")
    y0, y1, z0, z1 = WINDOW
    x0, x1 = -0.19, -0.12
    parts = [
        box_between((x0, y0, z0), (x1, y0 + 0.06, z1), 0.006),
        box_between((x0, y1 - 0.06, z0), (x1, y1, z1), 0.006),
        box_between((x0, y0, z0), (x1, y1, z0 + 0.07), 0.006),
        box_between((x0, y0, z1 - 0.06), (x1, y1, z1), 0.006),
    ]
    third = (y1 - y0) / 3
    for k in (1, 2):
        y = y0 + k * third
        parts.append(box_between((x0 - 0.005, y - 0.032, z0 + 0.02), (x1 + 0.008, y + 0.032, z1 - 0.02), 0.006))
    for k in range(3):
        for z in (z0 + 0.68, z0 + 1.29):
            lo, hi = y0 + k * third + 0.02, y0 + (k + 1) * third - 0.02
            parts.append(box_between((x0 + 0.02, lo, z - 0.013), (x1 - 0.015, hi, z + 0.013), 0.005))
    scene.object("Window frame", ("White paint", scene.mesh("window-frame", merge(*parts)), "Window frame"))
    scene.place("Window frame")
    sill = box_between((-0.12, y0 - 0.06, z0 - 0.012), (0.075, y1 + 0.06, z0 + 0.018), 0.008, 3)
    scene.object("Window sill", ("White paint", scene.mesh("window-sill", sill), "Window sill"))
    scene.place("Window sill")


def curtain(width, pitch, seed, columns, rows=18, height=2.44):
    """A gathered sheer in the plane x = 0: y from 0 to width, z from 0.02 to height; folds loosen downwards."""
    s, t = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))  # t: 0 bottom, 1 top
    y = s * width + (1 - t) * 0.03 * np.sin(2 * np.pi * s * 1.3 + seed)
    phase = (
        2 * np.pi * (s * width / pitch)
        + 1.1 * np.sin(2 * np.pi * s * 1.7 + seed)
        + (1 - t) * 0.9 * np.sin(5 * s + seed)
    )
    depth = (0.026 + 0.018 * (1 - t)) * (0.85 + 0.25 * np.sin(9 * s + 2 * seed))
    x = depth * (np.sin(phase) + 0.22 * np.sin(2 * phase + 0.7))
    z = 0.02 + t * (height - 0.02)
    uv = unit_uv(rows, columns, width * 1.6, height)
    return sheet(np.stack([x, y, z], -1), uv)


def curtains(scene):
    scene.section("Curtains and their rod")
    scene.texture("cloth height", "float", "weave-height.png", encoding="linear", scale=0.0006, uscale=14, vscale=14)
    scene.material(
        "Sheer linen", "diffusetransmission", reflectance=(0.40, 0.385, 0.35), transmittance=(0.47, 0.445, 0.395)
    )
    scene.material("Brass", "conductor", eta="metal-CuZn-eta", k="metal-CuZn-k", roughness=0.14)
    far, near = curtain(0.58, 0.088, 1.0, 120), curtain(0.52, 0.088, 2.6, 108)
    scene.object("Curtain, far", ("Sheer linen", scene.mesh("curtain-far", far), "Curtain, far"))
    scene.object("Curtain, near", ("Sheer linen", scene.mesh("curtain-near", near), "Curtain, near"))
    scene.place("Curtain, far", translate(0.15, -1.02, 0))
    scene.place("Curtain, near", translate(0.15, -2.96, 0))
    ball = lathe(
        fillet([(0, -0.028), (0.006, -0.028), (0.026, -0.012), (0.026, 0.012), (0.012, 0.030), (0, 0.034)], 0.012), 24
    )
    rod = merge(
        tube([(0.15, -3.06, 2.475), (0.15, -1.7, 2.475), (0.15, -0.34, 2.475)], 0.011, 20),
        ball.moved(translate(0.15, -0.325, 2.475) @ rotate((1, 0, 0), -90)),
        ball.moved(translate(0.15, -3.075, 2.475) @ rotate((1, 0, 0), 90)),
        tube([(0, -0.38, 2.475), (0.075, -0.38, 2.475), (0.15, -0.38, 2.475)], 0.007, 12),
    )
    scene.object("Curtain rod", ("Brass", scene.mesh("curtain-rod", rod), "Curtain rod"))
    scene.place("Curtain rod")
    t = np.linspace(0, 2 * np.pi, 25)
    ring = lathe(np.stack([0.021 + 0.0028 * np.cos(t), 0.0028 * np.sin(t)], 1), 32)
    scene.object("Curtain ring", ("Brass", scene.mesh("curtain-ring", ring), "Curtain ring"))
    for start, count in ((-1.00, 7), (-2.94, 6)):
        for k in range(count):
            m = translate(0.15, start + 0.088 * k, 2.464) @ rotate((0, 0, 1), 7 * np.sin(3 * k)) @ rotate((1, 0, 0), 90)
            scene.place("Curtain ring", m)


def rug(scene, centre, angle):
    scene.section("Rug")
    scene.texture("rug pattern", "spectrum", "rug.png")
    scene.texture("rug height", "float", "weave-height.png", encoding="linear", scale=0.0016, uscale=16, vscale=11)
    scene.material(
        "Woven wool", "diffuse", reflectance=("texture", "rug pattern"), displacement=("texture", "rug height")
    )
    scene.material("Wool fringe", "diffuse", reflectance=(0.66, 0.56, 0.40))
    length, width = 2.5, 1.7
    body = rounded_box((length, width, 0.012), 0.005, 2)
    body.uv = body.v[:, :2] / [length, width] + 0.5
    body = body.moved(translate(0, 0, 0.0065))
    rng = np.random.default_rng(7)
    threads = []
    for end in (-1, 1):
        for y in np.arange(-width / 2 + 0.012, width / 2 - 0.01, 0.024):
            a, b = rng.normal(0, 0.010, 2)
            path = [
                (end * (length / 2 - 0.004), y, 0.007),
                (end * (length / 2 + 0.025), y + 0.4 * a, 0.0045),
                (end * (length / 2 + 0.058 + 0.5 * b), y + a, 0.003),
            ]
            threads.append(tube(path, [0.0034, 0.0031, 0.0040], 4))
    scene.object(
        "Rug",
        ("Woven wool", scene.mesh("rug", body), "Rug"),
        ("Wool fringe", scene.mesh("rug-fringe", merge(*threads)), "Rug fringe"),
    )
    scene.place("Rug", translate(*centre, 0) @ rotate((0, 0, 1), angle))


def frame(width, height, bar, depth):
    """Four bars about an opening in the plane y = 0 (the picture looks along -y), mitred corners left square."""
    outline = fillet([(0, 0), (bar, 0), (bar, depth * 0.7), (bar * 0.45, depth), (0, depth * 0.9), (0, 0)], 0.004, 3)[
        :-1
    ]
    w, h = width / 2, height / 2
    corners = [(-w, -h), (w, -h), (w, h), (-w, h)]
    parts = []
    for k in range(4):
        (ax, az), (bx, bz) = corners[k], corners[(k + 1) % 4]
        along = np.array([bx - ax, bz - az]) / np.hypot(bx - ax, bz - az)
        out = np.array([along[1], -along[0]])
        rings = []
        for end, sign in (((ax, az), -1), ((bx, bz), 1)):
            rings.append(
                [
                    (end[0] + out[0] * o + sign * along[0] * o, -q, end[1] + out[1] * o + sign * along[1] * o)
                    for o, q in np.concatenate([outline, outline[:1]])
                ]
            )
        p = np.array(rings)
        d = np.roll(outline, -1, 0) - np.roll(outline, 1, 0)
        n2 = np.stack([d[:, 1], -d[:, 0]], 1) / np.linalg.norm(d, axis=1, keepdims=True)
        n2 = np.concatenate([n2, n2[:1]])
        n = np.stack([out[0] * n2[:, 0], -n2[:, 1], out[1] * n2[:, 0]], -1)
        count = len(n2)
        i = np.arange(count - 1)
        f = np.concatenate([np.stack([i, i + 1, i + 1 + count], 1), np.stack([i, i + 1 + count, i + count], 1)])
        m = Mesh(p, np.stack([n, n]), unit_uv(2, count, 0.1, np.hypot(bx - ax, bz - az)), f)
        a, b, c = (m.v[m.f[:, j]] for j in range(3))
        if np.einsum("ij,ij->i", np.cross(b - a, c - a), m.n[m.f[:, 0]]).sum() < 0:
            m.f = m.f[:, ::-1]
        parts.append(m)
    return merge(*parts)


def picture(scene, x, z):
    scene.section("Picture and mirror")
    scene.texture("print", "spectrum", "picture.png")
    scene.material("Print", "coateddiffuse", reflectance=("texture", "print"), roughness=0.35)
    scene.material("Mount board", "diffuse", reflectance=(0.78, 0.75, 0.68))
    w, h, mount = 0.60, 0.80, 0.075
    art = quad((-w / 2 + mount, -0.008, -h / 2 + mount), (w - 2 * mount, 0, 0), (0, 0, h - 2 * mount))
    art.uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    board = quad((-w / 2, -0.006, -h / 2), (w, 0, 0), (0, 0, h))
    scene.object(
        "Picture",
        ("Walnut", scene.mesh("picture-frame", frame(w, h, 0.028, 0.026)), "Picture frame"),
        ("Mount board", scene.mesh("picture-mount", board), "Picture mount"),
        ("Print", scene.mesh("picture-print", art), "Picture print"),
    )
    scene.place("Picture", translate(x, -0.002, z))


def mirror(scene, x, z, radius=0.24):
    scene.material("Silver mirror", "conductor", eta="metal-Ag-eta", k="metal-Ag-k", roughness=0.0)
    rim = lathe(
        fillet(
            [
                (radius - 0.004, 0),
                (radius + 0.014, 0),
                (radius + 0.014, 0.022),
                (radius - 0.004, 0.022),
                (radius - 0.004, 0),
            ],
            0.004,
            3,
        ),
        72,
    )
    glass = lathe([(radius, 0.012), (0, 0.012)], 72)
    scene.object(
        "Mirror",
        ("Brass", scene.mesh("mirror-rim", rim), "Mirror rim"),
        ("Silver mirror", scene.mesh("mirror-glass", glass), "Mirror glass"),
    )
    scene.place("Mirror", translate(x, -0.002, z) @ rotate((1, 0, 0), 90))
