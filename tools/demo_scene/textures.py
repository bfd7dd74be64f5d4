# SPDX-License-Identifier: Apache-2.0
"""The painted images of the bundled demo scene: wood, rug, cloth, plaster, paper and one picture. Values are sRGB."""

import numpy as np

from .images import colour, mix, noise, smoothstep, write_png


def wood_value(shape, seed, rings=9.0, warp=0.9, fibre=0.16):
    """0 (early wood) .. 1 (late wood), grain along the rows' axis, tileable."""
    x = np.arange(shape[1])[None, :] / shape[1]
    bend = noise(shape, seed, 2.0, (7, 1))
    phase = rings * x + warp * bend
    saw = phase - np.floor(phase)  # late wood darkens slowly and ends sharply
    ring = smoothstep(0.0, 0.85, saw) * smoothstep(1.0, 0.88, saw)
    depth = 0.55 + 0.25 * noise(shape, seed + 1, 1.6, (9, 1))
    fibres = noise(shape, seed + 2, 0.55, (26, 1), low=6)
    pores = smoothstep(1.5, 2.6, noise(shape, seed + 3, 0.25, (14, 1), low=20))
    return np.clip(0.18 + 0.62 * ring * depth + fibre * fibres + 0.35 * pores, 0, 1)


def wood(shape, seed, light, mid, dark, **options):
    value = wood_value(shape, seed, **options)
    return mix(mix(colour(light), colour(mid), smoothstep(0, 0.5, value)), colour(dark), smoothstep(0.45, 1, value))


def floor_planks(size, rows=14):
    """Oak planks along the vertical axis, two boards per row; returns colour and height (1 = the plank's face)."""
    rng = np.random.default_rng(5)
    base = wood_value((size, size), 21, rings=26.0, warp=1.3)
    edges = np.rint(np.arange(rows + 1) / rows * size).astype(int)
    image, height = np.zeros((size, size, 3)), np.ones((size, size))
    gap = size / 640
    for k in range(rows):
        a, b = edges[k], edges[k + 1]
        first = int(rng.random() * size)
        second = first + size // 2 + int((rng.random() - 0.5) * size * 0.3)
        for start, stop in ((first, second), (second, first + size)):
            where = np.arange(start, stop) % size
            shift = rng.integers(0, size, 2)
            v = base[np.ix_((where + shift[0]) % size, (np.arange(a, b) + shift[1]) % size)]
            tone = np.clip(rng.normal(0, 1), -1.6, 1.4)
            c = mix(
                mix(colour("#d8b283"), colour("#c0925f"), smoothstep(0, 0.55, v)),
                colour("#93683f"),
                smoothstep(0.45, 1.0, v),
            )
            image[np.ix_(where, np.arange(a, b))] = c * (1 + 0.075 * tone) + np.array([0.01, 0, -0.012]) * rng.normal()
            height[np.ix_(where[: max(1, int(gap))], np.arange(a, b))] = 0
    x = np.arange(size)
    to_edge = np.min(np.abs(x[None, :] - edges[:, None]), axis=0)
    seam = smoothstep(0.2, gap + 0.8, to_edge)[None, :] * np.ones((size, 1))
    height = np.minimum(height, seam)
    return image * (0.42 + 0.58 * height[..., None]), height


def weave(size, threads):
    """Plain weave as a height field: over and under threads."""
    t = (np.arange(size) + 0.5) / size * threads
    round_ = np.sin(np.pi * (t - np.floor(t)))
    over = (np.floor(t)[:, None] + np.floor(t)[None, :]) % 2
    return np.where(
        over == 0, round_[None, :] * (0.6 + 0.4 * round_[:, None]), round_[:, None] * (0.6 + 0.4 * round_[None, :])
    )


def rug(width, height):
    """A flat-woven rug: cream field with stepped diamonds, terracotta and ink borders."""
    y, x = np.meshgrid((np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij")
    aspect = width / height
    px, py = x * aspect, y
    wobble = 0.004 * noise((height, width), 31, 1.4)
    cream, clay, ink, sand, moss = (colour(c) for c in ("#e2d3b6", "#ad5638", "#26384a", "#c99a5e", "#69714f"))
    step = 1 / 44  # the pattern follows the weave's stairs
    sx, sy = (np.floor(px / step) + 0.5) * step, (np.floor(py / step) + 0.5) * step
    border = np.minimum(np.minimum(px, aspect - px), np.minimum(py, 1 - py)) + wobble
    cell = 0.30
    dx = np.abs((sx - aspect / 2) / cell - np.rint((sx - aspect / 2) / cell))
    dy = np.abs((sy - 0.5) / cell - np.rint((sy - 0.5) / cell))
    d = dx + dy
    image = np.broadcast_to(cream, (height, width, 3)).copy()
    for low, high, c in ((0.0, 0.10, ink), (0.10, 0.20, sand), (0.28, 0.36, clay), (0.46, 0.54, moss)):
        image[(d >= low) & (d < high)] = c
    teeth = np.abs(sx / 0.075 - np.rint(sx / 0.075)) + np.abs(sy / 0.075 - np.rint(sy / 0.075))
    for low, high, c in (
        (0.125, 0.135, ink),
        (0.11, 0.125, cream),
        (0.045, 0.11, clay),
        (0.03, 0.045, cream),
        (0, 0.03, ink),
    ):
        image[(border >= low) & (border < high)] = c
    band = (border >= 0.045) & (border < 0.11) & (teeth < 0.3)
    image[band] = sand
    wool = noise((height, width), 32, 0.5)
    row = np.random.default_rng(33).normal(0, 1, (height, 1))  # dye lots
    return np.clip(image * (1 + 0.035 * wool[..., None] + 0.03 * row[..., None]), 0, 1)


def picture(width, height):
    """A print in flat colours: a low sun over hills and water."""
    y, x = np.meshgrid((np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij")
    px = (x - 0.5) * width / height
    paper = mix(colour("#efe2c8"), colour("#e6c9a0"), y)
    image = paper
    disc = np.hypot(px + 0.06, y - 0.36)
    image = mix(image, colour("#d9643a"), smoothstep(0.172, 0.168, disc))
    layers = (
        (0.46, 0.050, 3.1, 0.4, "#d8a070"),
        (0.545, 0.045, 4.3, 2.2, "#b5694e"),
        (0.63, 0.050, 3.7, 4.0, "#5d6b70"),
        (0.73, 0.040, 5.2, 1.0, "#2d4556"),
    )
    for level, swing, frequency, phase, c in layers:
        line = (
            level + swing * np.sin(frequency * px * 2 + phase) + 0.4 * swing * np.sin(2.7 * frequency * px + 2 * phase)
        )
        image = mix(image, colour(c), smoothstep(-0.002, 0.002, y - line))
    water = smoothstep(-0.002, 0.002, y - 0.83)
    image = mix(image, colour("#9db4b0"), water)
    stripe = (
        (np.sin(y * 260 + 1.5 * np.sin(px * 9)) > 0.45) & (np.abs(px + 0.06) < 0.17 - 0.4 * (y - 0.83)) & (y > 0.835)
    )
    image = mix(image, colour("#e28a58"), stripe * 0.85)
    grain = noise((height, width), 41, 0.45)
    return np.clip(image * (1 + 0.02 * grain[..., None]), 0, 1)


def orange_peel(size):
    return 0.5 + 0.16 * noise((size, size), 51, 0.6, low=9) * smoothstep(-2, 1, noise((size, size), 52, 1.2))


def plaster(size):
    broad, fine = noise((size, size), 61, 1.8, low=2), noise((size, size), 62, 1.0, low=16)
    return np.clip(0.5 + 0.11 * broad + 0.05 * fine, 0, 1)


def page_edges(size):
    rng = np.random.default_rng(71)
    lines = 0.86 + 0.08 * rng.standard_normal((size, 1))
    return np.clip(lines[..., None] * colour("#f1e6cf") + np.zeros((size, size, 1)), 0, 1)


def leaf(width, height):
    """A fig leaf: dark green with a pale rib and side veins; u across, v along."""
    y, x = np.meshgrid((np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij")
    side = np.abs(x - 0.5) * 2
    vein = np.abs(((y * 9 + side * 1.6) % 1) - 0.5) * 2
    t = np.maximum(smoothstep(0.08, 0.03, side), 0.5 * smoothstep(0.86, 0.97, vein) * smoothstep(1.0, 0.5, side))
    mottled = mix(colour("#3f6e35"), colour("#628f45"), np.clip(0.5 + 0.22 * noise((height, width), 81, 1.4), 0, 1))
    return mix(mottled, colour("#a9b86a"), t * 0.8)


GRAINY = {"floor-planks", "walnut", "oak", "rug", "picture"}


def write_all(folder):
    planks, gaps = floor_planks(896)
    table = wood((768, 384), 101, "#b98452", "#9a6538", "#5f3a1e", rings=7.0, warp=1.1)
    oak = wood((512, 256), 111, "#d2ab78", "#b98c58", "#8b6238", rings=8.0, warp=0.8)
    files = {
        "floor-planks": planks,
        "floor-height": gaps[::2, ::2],
        "walnut": table,
        "oak": oak,
        "rug": rug(616, 420),
        "weave-height": weave(128, 16),
        "picture": picture(384, 512),
        "orange-height": orange_peel(256),
        "plaster-height": plaster(256),
        "page-edges": page_edges(64),
        "leaf": leaf(64, 128),
    }
    for name, image in files.items():
        write_png(folder / f"{name}.png", image, 52 if name in GRAINY else 256)
