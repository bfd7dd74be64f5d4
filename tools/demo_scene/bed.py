# SPDX-License-Identifier: Apache-2.0
"""The bed of scenes/parts: oak frame, padded headboard, mattress, duvet, throw and pillows; its foot towards -y."""

import numpy as np

from .mesh import box_between, merge, rotate, rounded_box, sheet, translate, tube
from .palette import oak, weave

WIDTH, LENGTH = 1.60, 2.00  # of the mattress [m]
HEAD = LENGTH / 2  # y where the headboard begins
RAIL, TOP = 0.30, 0.47  # heights of the side rails and of the mattress


def draped(distance, half, radius):
    """How cloth lies at a distance from the middle of a bed: (how far out, how far below the top, outward share 0..1)."""
    flat = half - radius
    angle = np.clip((distance - flat) / radius, 0, np.pi / 2)
    hang = np.maximum(distance - flat - radius * np.pi / 2, 0)
    return np.minimum(distance, flat) + radius * np.sin(angle), radius * (1 - np.cos(angle)) + hang, np.sin(angle)


def cover(y0, y1, drop, thickness, rows, columns, folds=1.0, radius=0.075):
    """Cloth over the bed's sides from y0 to y1 (y0 the foot): hangs `drop` metres down, hems rolled to a thickness.

    Heights are those above the mattress; folds scales the wrinkles on top and the pleats of the sides.
    """
    half = WIDTH / 2 + 0.012 + thickness
    reach = half - radius + radius * np.pi / 2 + drop
    roll = np.pi * thickness / 2  # each hem is half a turn of this length
    s = np.linspace(-1, 1, columns) * (reach + roll)
    t = np.linspace(0, 1, rows)
    ends = np.concatenate(
        [-roll * np.linspace(1, 0, 5)[:-1], t * (y1 - y0), (y1 - y0) + roll * np.linspace(0, 1, 5)[1:]]
    )
    s, y = np.meshgrid(s, ends)

    def hem(over):  # (along, inwards) of the half turn at an edge, for a length past its beginning
        a = np.clip(over / roll, 0, 1) * np.pi
        return thickness / 2 * np.sin(a), thickness / 2 * (1 - np.cos(a))

    side = np.abs(s)
    lower, inwards = hem(side - reach)
    out, down, turned = draped(np.minimum(side, reach), half, radius)
    beyond, under = hem(np.where(y < 0, -y, y - (y1 - y0)))
    along = np.clip(y, 0, y1 - y0)
    hanging = np.clip(down / 0.22, 0, 1)
    x0, place = np.sign(s) * out, y0 + along  # wrinkles belong to places of the bed: a throw follows the duvet below it
    # Long soft ridges on top, slanted and bent; pleats that deepen towards the hem at the sides.
    bend = 0.20 * np.sin(2.3 * x0 + 0.8) + 0.07 * np.sin(6.1 * place + 1.7 * x0)
    ridges = (
        0.0090 * np.sin(9.0 * (place + bend) + 2.2 * x0)
        + 0.0055 * np.sin(17.0 * (0.8 * place - 0.45 * x0 + 0.5 * bend) + 1.0)
        + 0.0035 * np.sin(29.0 * (0.5 * place + 0.75 * x0 + 0.3 * bend) + 2.0)
    )
    quiet = np.clip(np.minimum(along, y1 - y0 - along) / 0.12, 0, 1)  # none at the hems
    puff = thickness + folds * (0.45 + 0.55 * quiet) * ridges
    pleats = folds * hanging * (0.016 * np.sin(11.0 * place + 3.0 * np.sign(s)) + 0.007 * np.sin(23.0 * place + 1.0))
    push = (puff - thickness) * (1 - turned) - under * (1 - turned)
    z = TOP + thickness + push - down - lower
    x = np.sign(s) * (out + turned * (pleats + 0.012 * hanging - inwards - under))
    wander = folds * 0.012 * np.sin(3.1 * x0 + 0.6) * np.where(y < (y1 - y0) / 2, 1, -1)
    y = y0 + along + np.where(y < 0, -beyond, beyond) * (1 if folds else 0) + wander * (1 - quiet)
    return sheet(np.stack([x, y, z], -1), np.stack([s, ends[:, None] + 0 * s], -1)).flipped()


def pillow(width, height, thickness, seed):
    """Lies in the plane z = 0 about the origin; corners a little drawn out, a seam around."""
    rows, columns = 17, 23
    q, p = np.meshgrid(np.linspace(-1, 1, rows) * np.pi / 2, np.linspace(-1, 1, columns) * np.pi / 2, indexing="ij")
    u, v = np.sin(p), np.sin(q)
    x = width / 2 * u * (1 - 0.055 * (1 - v * v))
    y = height / 2 * v * (1 - 0.075 * (1 - u * u))
    dome = np.cos(p) * np.cos(q) * (1 + 0.16 * (u * u + v * v))
    crumple = 1 + 0.05 * np.sin(5 * u + 2.4 * v + seed) + 0.04 * np.sin(7 * v - 4 * u + 2 * seed)
    z = thickness / 2 * dome * crumple
    uv = np.stack([x, y], -1)
    top = sheet(np.stack([x, y, z], -1), uv)
    bottom = sheet(np.stack([x, y, -z], -1), uv)
    top, bottom = (m if (m.n[:, 2].mean() > 0) == up else m.flipped() for m, up in ((top, True), (bottom, False)))
    rim = np.concatenate(
        [
            np.stack([x, y], -1)[e]
            for e in ((0, slice(None)), (slice(1, None), -1), (-1, slice(-2, None, -1)), (slice(-2, 0, -1), 0))
        ]
    )
    rim = np.concatenate([rim, rim[:2]])
    seam = tube(np.column_stack([rim, np.zeros(len(rim))]), 0.0032, 6, up=(0, 0, 1))
    return merge(top, bottom, seam)


def frame():
    """Rails, legs and slats' edge in oak."""
    w, foot = WIDTH / 2 + 0.035, -LENGTH / 2 - 0.035
    parts = [
        box_between((sx * w - 0.014, foot + 0.02, 0.13), (sx * w + 0.014, HEAD, RAIL), 0.006, 2, grain=1)
        for sx in (-1, 1)
    ]
    parts.append(box_between((-w - 0.014, foot, 0.13), (w + 0.014, foot + 0.028, RAIL), 0.006, 3, grain=0))
    parts.append(box_between((-w, foot + 0.01, 0.20), (w, HEAD, 0.222), 0.002, grain=0))
    for sx in (-1, 1):
        for y in (foot + 0.12, HEAD - 0.10):
            parts.append(
                box_between(
                    (sx * (w - 0.06) - 0.028, y - 0.028, 0),
                    (sx * (w - 0.06) + 0.028, y + 0.028, 0.15),
                    0.008,
                    3,
                    grain=2,
                )
            )
    return merge(*parts)


def headboard():
    """Upright padded channels."""
    count, low, high = 8, 0.16, 1.08
    whole = WIDTH + 0.11
    wide = whole / count
    channel = rounded_box((wide - 0.002, 0.085, high - low), 0.040, 3, grain=2)
    return merge(
        *(
            channel.moved(translate(-whole / 2 + wide * (k + 0.5), HEAD + 0.0435, (low + high) / 2))
            for k in range(count)
        )
    )


def bed(scene):
    scene.section("Bed")
    oak(scene)
    linen = weave(scene)
    knit = weave(scene, "knit height", 0.0025, 5)
    scene.material("Headboard wool", "diffuse", reflectance=(0.42, 0.37, 0.30), **linen)
    scene.material("Mattress cloth", "diffuse", reflectance=(0.74, 0.72, 0.67))
    scene.material("Duvet linen", "diffuse", reflectance=(0.80, 0.775, 0.72), **linen)
    scene.material("Pillow linen", "diffuse", reflectance=(0.82, 0.80, 0.755), **linen)
    scene.material("Cushion velvet", "diffuse", reflectance=(0.115, 0.175, 0.165), **linen)
    scene.material("Throw wool", "diffuse", reflectance=(0.50, 0.235, 0.115), **knit)
    half = WIDTH / 2, LENGTH / 2
    mattress = box_between((-half[0], -half[1], 0.222), (half[0], half[1], TOP - 0.002), 0.05, 5)
    duvet = cover(-half[1] + 0.04, 0.42, 0.105, 0.045, 56, 66)
    turned = cover(0.30, 0.58, 0.110, 0.066, 14, 66)
    throw = cover(-0.80, -0.28, 0.115, 0.064, 24, 66)
    pillows, cushions = [], []
    for sx in (-1, 1):  # two lean at the headboard, two lie against them
        pillows.append(
            pillow(0.74, 0.50, 0.17, 1.0 + sx).moved(
                translate(sx * 0.39, HEAD - 0.145, TOP + 0.255) @ rotate((0, 0, 1), 2 * sx) @ rotate((1, 0, 0), 68)
            )
        )
        pillows.append(
            pillow(0.70, 0.46, 0.17, 4.0 + sx).moved(
                translate(sx * 0.37, HEAD - 0.330, TOP + 0.205) @ rotate((0, 0, 1), -3 * sx) @ rotate((1, 0, 0), 52)
            )
        )
    cushions.append(
        pillow(0.50, 0.32, 0.14, 2.5).moved(
            translate(0.03, HEAD - 0.475, TOP + 0.175) @ rotate((0, 0, 1), 5) @ rotate((1, 0, 0), 55)
        )
    )
    scene.shape("Bed frame", "Oak", scene.mesh("bed-frame", frame()))
    scene.shape("Headboard", "Headboard wool", scene.mesh("bed-headboard", headboard()))
    scene.shape("Mattress", "Mattress cloth", scene.mesh("bed-mattress", mattress))
    scene.shape("Duvet", "Duvet linen", scene.mesh("bed-duvet", duvet))
    scene.shape("Sheet", "Pillow linen", scene.mesh("bed-sheet", turned))
    scene.shape("Throw", "Throw wool", scene.mesh("bed-throw", throw))
    scene.shape("Pillows", "Pillow linen", scene.mesh("bed-pillows", merge(*pillows)))
    scene.shape("Cushion", "Cushion velvet", scene.mesh("bed-cushion", merge(*cushions)))
