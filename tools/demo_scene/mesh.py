# SPDX-License-Identifier: Apache-2.0
"""Triangle meshes for the bundled scenes: lathes, rounded boxes, sweeps, sheets, and a binary PLY writer.

Lengths in metres, z up, right-handed; normals point out of the solid, and triangles wind counter-clockwise about them.
The last bits of sine, power and matrix product differ from processor to processor. No choice may depend on them: all
choices (a vertex kept, an axis, a side) use `above` or `first_largest`.
"""

import numpy as np

SLACK = 1e-9  # relative: a million times the rounding error here, and far below visibility


def above(values, limit):
    """values > limit; refuses a shape for which this depends on rounding, so that its author changes it."""
    if np.any(np.abs(np.asarray(values) - limit) <= SLACK * abs(limit)):
        raise ValueError(f"a value practically equals the limit {limit}")
    return np.asarray(values) > limit


def first_largest(values):
    """The first index (along the last axis) of the values that equal the largest up to rounding."""
    top = np.max(values, axis=-1, keepdims=True)
    if np.any((values < top * (1 - SLACK)) & (values > top * (1 - 2 * SLACK))):
        raise ValueError("a value is neither the largest nor clearly smaller")
    return np.argmax(values >= top * (1 - SLACK), axis=-1)


class Mesh:
    """positions (n,3), normals (n,3), uvs (n,2), triangles (m,3)."""

    def __init__(self, v, n, uv, f):
        self.v = np.asarray(v, float).reshape(-1, 3)
        self.n = np.asarray(n, float).reshape(-1, 3)
        self.uv = np.asarray(uv, float).reshape(-1, 2)
        self.f = np.asarray(f, int).reshape(-1, 3)

    def moved(self, matrix):
        """A copy transformed by a 4x4 matrix (column vectors)."""
        m = np.asarray(matrix, float)
        linear = m[:3, :3]
        n = self.n @ np.linalg.inv(linear)
        n /= np.linalg.norm(n, axis=1, keepdims=True)
        f = self.f if np.linalg.det(linear) > 0 else self.f[:, ::-1]
        return Mesh(self.v @ linear.T + m[:3, 3], n, self.uv, f)

    def flipped(self):
        """A copy with flipped normals."""
        return Mesh(self.v, -self.n, self.uv, self.f[:, ::-1])

    def with_uv(self, scale=1.0, offset=(0.0, 0.0)):
        return Mesh(self.v, self.n, self.uv * scale + np.asarray(offset), self.f)


def merge(*meshes):
    base = np.cumsum([0] + [len(m.v) for m in meshes])
    return Mesh(
        np.concatenate([m.v for m in meshes]),
        np.concatenate([m.n for m in meshes]),
        np.concatenate([m.uv for m in meshes]),
        np.concatenate([m.f + b for m, b in zip(meshes, base)]),
    )


def translate(x, y, z):
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


def rotate(axis, degrees):
    """Right-handed rotation about an axis through the origin (Rodrigues)."""
    a = np.asarray(axis, float) / np.linalg.norm(axis)
    t = np.radians(degrees)
    k = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    m = np.eye(4)
    m[:3, :3] += np.sin(t) * k + (1 - np.cos(t)) * (k @ k)
    return m


def scale(x, y=None, z=None):
    return np.diag([x, x if y is None else y, x if z is None else z, 1.0])


def z_to(direction):
    """A rotation that takes +z to a direction."""
    d = np.asarray(direction, float) / np.linalg.norm(direction)
    side = np.cross([1.0, 0, 0] if above(abs(d[1]), 0.9) else [0, 1.0, 0], d)
    side /= np.linalg.norm(side)
    m = np.eye(4)
    m[:3, 0], m[:3, 1], m[:3, 2] = side, np.cross(d, side), d
    return m


def _normalised(x):
    return x / np.maximum(np.linalg.norm(x, axis=-1, keepdims=True), 1e-20)


def grid_faces(rows, columns):
    """Two triangles per cell of a rows x columns vertex grid; +row x +column is the normal's side."""
    i = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)[None, :]).ravel()
    return np.concatenate([np.stack([i, i + columns, i + columns + 1], 1), np.stack([i, i + columns + 1, i + 1], 1)])


def without_slivers(mesh):
    """Drop triangles without area (the poles of a lathe) and unused vertices."""
    a, b, c = (mesh.v[mesh.f[:, k]] for k in range(3))
    f = mesh.f[above(np.linalg.norm(np.cross(b - a, c - a), axis=1), 1e-14)]
    used, f = np.unique(f, return_inverse=True)
    return Mesh(mesh.v[used], mesh.n[used], mesh.uv[used], f.reshape(-1, 3))


def sheet(points, uv):
    """A smooth surface through a (rows, columns, 3) grid of points; normals from central differences."""
    p = np.asarray(points, float)
    n = _normalised(np.cross(np.gradient(p, axis=0), np.gradient(p, axis=1)))
    return Mesh(p, n, np.asarray(uv, float), grid_faces(*p.shape[:2]))


def unit_uv(rows, columns, du=1.0, dv=1.0):
    v, u = np.meshgrid(np.linspace(0, dv, rows), np.linspace(0, du, columns), indexing="ij")
    return np.stack([u, v], -1)


def fillet(points, radii, steps=5):
    """A 2D polyline with corners rounded: each inner point becomes an arc of its radius (0 keeps it sharp)."""
    p = np.asarray(points, float)
    radii = np.broadcast_to(radii, len(p))
    out = [p[0]]
    for k in range(1, len(p) - 1):
        a, b = _normalised(p[k - 1] - p[k]), _normalised(p[k + 1] - p[k])
        half = 0.5 * np.arccos(np.clip(a @ b, -1, 1))
        if radii[k] <= 0 or not above(abs(np.pi / 2 - half), 1e-3):
            out.append(p[k])
            continue
        reach = radii[k] / np.tan(half)
        limit = 0.499 * min(np.linalg.norm(p[k - 1] - p[k]), np.linalg.norm(p[k + 1] - p[k]))
        r, reach = (radii[k], reach) if reach < limit else (limit * np.tan(half), limit)
        centre = p[k] + _normalised(a + b) * r / np.sin(half)
        u, w = p[k] + a * reach - centre, p[k] + b * reach - centre
        total = np.arccos(np.clip(u @ w / (r * r), -1, 1))
        for s in np.linspace(0, 1, steps + 1):
            out.append(centre + (u * np.sin((1 - s) * total) + w * np.sin(s * total)) / np.sin(total))
    out.append(p[-1])
    return np.array(out)


def smooth_curve(points, steps=6):
    """Catmull-Rom through the points."""
    p = np.asarray(points, float)
    q = np.concatenate([[2 * p[0] - p[1]], p, [2 * p[-1] - p[-2]]])
    out = []
    for k in range(1, len(q) - 2):
        for t in np.arange(steps) / steps:
            a, b, c, d = q[k - 1 : k + 3]
            out.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * (b - c) + d - a) * t**3))
    return np.array(out + [p[-1]])


def essential(points, tolerance):
    """The points of a polyline that define its shape (Douglas and Peucker 1973)."""
    keep = np.zeros(len(points), bool)
    keep[[0, -1]] = True
    todo = [(0, len(points) - 1)]
    while todo:
        a, b = todo.pop()
        d = points[b] - points[a]
        rel = points[a + 1 : b] - points[a]
        length = np.linalg.norm(d)
        away = np.abs(d[0] * rel[:, 1] - d[1] * rel[:, 0]) / length if above(length, 1e-9) else np.linalg.norm(rel, axis=1)
        if len(away) and above(away.max(), tolerance):
            m = a + 1 + int(first_largest(away))
            keep[m] = True
            todo += [(a, m), (m, b)]
    return keep


def lathe(profile, segments=64, uv_scale=(1.0, 1.0)):
    """Revolve a profile of (radius, z), walked so that the outside is on its right (up the outer wall), about z."""
    p = np.asarray(profile, float)
    d = np.diff(p, axis=0)
    length = np.linalg.norm(d, axis=1)
    edge = np.stack([d[:, 1], -d[:, 0]], 1) / np.maximum(length, 1e-12)[:, None]
    # Long flats keep their normal next to a fillet: weight the two edges of a vertex by their length.
    n = np.zeros_like(p)
    n[:-1] += edge * length[:, None]
    n[1:] += edge * length[:, None]
    for k in (0, -1):
        if not above(p[k, 0], 1e-9):  # on the axis the surface is flat
            n[k] = 0, np.sign(n[k, 1]) or 1
    n = _normalised(n)
    along = np.concatenate([[0], np.cumsum(length)])
    keep = essential(p, 0.00008)
    p, n, along = p[keep], n[keep], along[keep]
    t = np.linspace(0, 2 * np.pi, segments + 1)
    c, s = np.cos(t), np.sin(t)
    v = np.stack([p[:, :1] * c, p[:, :1] * s, np.repeat(p[:, 1:], len(t), 1)], -1)
    normals = np.stack([n[:, :1] * c, n[:, :1] * s, np.repeat(n[:, 1:], len(t), 1)], -1)
    uv = np.stack(np.broadcast_arrays((t / (2 * np.pi))[None, :] * uv_scale[0], along[:, None] * uv_scale[1]), -1)
    f = grid_faces(len(p), len(t))[:, ::-1]
    return without_slivers(Mesh(v, normals, uv, f))


def planar_uv(mesh, scale_=1.0, grain=1):
    """Box-projected uvs in metres: v runs along the grain axis (0 x, 1 y, 2 z), u along the other of each face."""
    axis = first_largest(np.abs(mesh.n))
    uv = np.zeros((len(mesh.v), 2))
    for a in range(3):
        others = [k for k in range(3) if k != a]
        along = grain if grain in others else others[1]
        across = [k for k in others if k != along][0]
        pick = axis == a
        uv[pick] = mesh.v[pick][:, [across, along]]
        uv[pick, 0] += mesh.v[pick][:, a]
    return Mesh(mesh.v, mesh.n, uv * scale_, mesh.f)


def rounded_box(size, radius, steps=3, grain=None, cuts=0):
    """A box centred at the origin with rounded edges and corners, its faces cut `cuts` times; uvs in metres."""
    h = np.asarray(size, float) / 2
    r = min(radius, *h)
    angle = np.linspace(-np.pi / 4, 0, steps + 1)
    parts = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for sign in (1, -1):
            ticks = []
            for k in (a, b):
                bend, flat = r + r * np.tan(angle), np.linspace(r - h[k], h[k] - r, cuts + 2)[1:-1]
                ticks.append(np.concatenate([-h[k] + bend, flat, h[k] - bend[::-1]]))
            q = np.zeros((len(ticks[0]), len(ticks[1]), 3))
            q[..., a], q[..., b], q[..., axis] = ticks[0][:, None], ticks[1][None, :], sign * h[axis]
            inner = np.clip(q, -(h - r), h - r)
            n = _normalised(q - inner)
            f = grid_faces(len(ticks[0]), len(ticks[1]))
            parts.append(Mesh(inner + r * n, n, np.zeros(n.shape[:2] + (2,)), f if sign > 0 else f[:, ::-1]))
    m = merge(*parts)
    return planar_uv(m, grain=int(first_largest(h)) if grain is None else grain)


def cushion(size, radius, crown, steps=4, cuts=6):
    """A rounded box whose top and bottom bulge by `crown` metres in the middle."""
    m = rounded_box(size, radius, steps, cuts=cuts)
    hx, hy, hz = np.asarray(size, float) / 2
    x, y, z = m.v.T
    u, v = 1 - (x / hx) ** 2, 1 - (y / hy) ** 2
    grown = 1 + crown / hz * u * v
    slope = np.stack([-2 * x / hx**2 * v, -2 * y / hy**2 * u], 1) * (z * crown / hz / grown)[:, None]
    n = np.column_stack([m.n[:, :2] - m.n[:, 2:] * slope, m.n[:, 2] / grown])
    return Mesh(np.stack([x, y, z * grown], 1), _normalised(n), m.uv, m.f)


def box_between(lo, hi, radius=0.003, steps=2, grain=None):
    lo, hi = np.asarray(lo, float), np.asarray(hi, float)
    m = rounded_box(hi - lo, radius, steps, grain)
    return m.moved(translate(*((lo + hi) / 2)))


def superellipse(width, depth, power=4.0, count=64):
    """A closed outline between an ellipse (power 2) and a rectangle."""
    t = np.linspace(0, 2 * np.pi, count, endpoint=False)
    c, s = (np.round(x, 14) for x in (np.cos(t), np.sin(t)))  # a power would turn a rounding error of 1e-17 into 1e-9
    return np.stack(
        [width / 2 * np.sign(c) * np.abs(c) ** (2 / power), depth / 2 * np.sign(s) * np.abs(s) ** (2 / power)], 1
    )


def slab(outline, z0, z1, bevel, steps=4, crown=0.0, crown_rings=0):
    """An extruded convex outline (counter-clockwise) with bevelled rims, crowned by `crown` metres on top."""
    o = np.asarray(outline, float)
    tangent = np.roll(o, -1, 0) - np.roll(o, 1, 0)
    side = _normalised(np.stack([tangent[:, 1], -tangent[:, 0]], 1))
    rings = []
    for t in np.linspace(-np.pi / 2, 0, steps + 1):
        rings.append((o - side * bevel * (1 - np.cos(t)), z0 + bevel * (1 + np.sin(t)), np.cos(t), np.sin(t)))
    for t in np.linspace(0, np.pi / 2, steps + 1):
        rings.append((o - side * bevel * (1 - np.cos(t)), z1 - bevel * (1 - np.sin(t)), np.cos(t), np.sin(t)))
    centre = o.mean(0)
    edge = rings[-1][0]
    for k in range(1, crown_rings + 1):
        t = k / (crown_rings + 1)
        rings.append((edge + (centre - edge) * t, z1 + crown * (1 - (1 - t) ** 2), 0, 1))
    n_out = len(o)
    v, n = [], []
    for ring, z, horizontal, up in rings:
        v.append(np.column_stack([ring, np.full(n_out, z)]))
        n.append(np.column_stack([side * horizontal, np.full(n_out, up)]))
    v, n = np.array(v), np.array(n)
    v, n = np.concatenate([v, v[:, :1]], 1), np.concatenate([n, n[:, :1]], 1)
    body = Mesh(v, n, v[..., :2], grid_faces(len(rings), n_out + 1)[:, ::-1])
    if crown_rings:  # the crowned part has no closed-form normal here
        top = slice(2 * steps + 1, None)
        smooth = np.cross(np.gradient(v, axis=1), np.gradient(v, axis=0))[top]
        smooth[:, 0] = smooth[:, -1] = smooth[:, 0] + smooth[:, -1]
        body.n.reshape(v.shape)[top] = _normalised(smooth)
    caps = []
    for ring, z, up in ((v[0], z0, -1.0), (v[-1], v[-1][0, 2] + (crown - (v[-1][0, 2] - z1)), 1.0)):
        p = np.concatenate([ring[:-1], [[*centre, z]]])
        k = np.arange(n_out)
        f = np.stack([k, (k + 1) % n_out, np.full(n_out, n_out)], 1)
        caps.append(Mesh(p, np.tile([0, 0, up], (n_out + 1, 1)), p[:, :2], f if up > 0 else f[:, ::-1]))
    return merge(body, *caps)


def sweep(path, outline, up=(0, 0, 1.0), scales=None, caps=True):
    """Carry a closed counter-clockwise 2D outline (side, up) along a path; flat end caps, fans about
    the outline's centre (leave them off where it is concave). v runs along the path [m]."""
    path, o = np.asarray(path, float), np.asarray(outline, float)
    t = _normalised(np.gradient(path, axis=0))
    side = _normalised(np.cross(t, np.asarray(up, float)))
    over = np.cross(side, t)
    scales = np.ones(len(path)) if scales is None else np.asarray(scales, float)
    closed = np.concatenate([o, o[:1]])
    d = np.roll(o, -1, 0) - np.roll(o, 1, 0)
    on = _normalised(np.stack([d[:, 1], -d[:, 0]], 1))
    on = np.concatenate([on, on[:1]])

    def place(q):
        return side[:, None, :] * q[None, :, :1] + over[:, None, :] * q[None, :, 1:]

    v = path[:, None, :] + place(closed) * scales[:, None, None]
    girth = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    uv = np.stack(np.broadcast_arrays(girth[None, :], along[:, None]), -1)
    # `side` x `over` = -t, so the outline runs clockwise seen along the path.
    body = Mesh(v, place(on), uv, grid_faces(len(path), len(closed)))
    if (
        np.einsum(
            "ij,ij->i", np.cross(*(body.v[body.f[:, k]] - body.v[body.f[:, 0]] for k in (1, 2))), body.n[body.f[:, 0]]
        ).sum()
        < 0
    ):
        body.f = body.f[:, ::-1]
    parts = [body]
    for end, sign in ((0, -1.0), (-1, 1.0)) if caps else ():
        p = np.concatenate([v[end][:-1], v[end][:-1].mean(0, keepdims=True)])
        k = np.arange(len(o))
        f = np.stack([k, (k + 1) % len(o), np.full(len(o), len(o))], 1)
        cap = Mesh(p, np.tile(sign * t[end], (len(p), 1)), np.concatenate([o, [[0, 0]]]), f)
        if np.cross(p[1] - p[0], p[-1] - p[0]) @ cap.n[0] < 0:
            cap.f = cap.f[:, ::-1]
        parts.append(cap)
    return merge(*parts)


def circle(radius, count=12):
    t = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.stack([radius * np.cos(t), radius * np.sin(t)], 1)


def rounded_rectangle(width, height, radius, steps=3):
    w, h, r = width / 2 - radius, height / 2 - radius, radius
    out = []
    for k, (cx, cy) in enumerate(((w, h), (-w, h), (-w, -h), (w, -h))):
        t = np.linspace(k * np.pi / 2, (k + 1) * np.pi / 2, steps + 1)
        out.append(np.stack([cx + r * np.cos(t), cy + r * np.sin(t)], 1))
    return np.concatenate(out)


def tube(path, radius, count=12, up=(0.31, 0.17, 0.93)):
    """A round rod along a path; radius may be one number or one per point."""
    radius = np.broadcast_to(np.asarray(radius, float), len(path))
    return sweep(path, circle(1.0, count), up, radius)


def write_ply(path, mesh):
    """Binary little-endian PLY with normals and uvs, as read by pbrt-v4's plymesh."""
    vertices = np.concatenate([mesh.v, mesh.n, mesh.uv], 1).astype("<f4")
    faces = np.zeros(len(mesh.f), dtype=[("count", "u1"), ("index", "<i4", 3)])
    faces["count"], faces["index"] = 3, mesh.f
    names = "".join(f"property float {k}\n" for k in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{names}"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_bytes(head.encode() + vertices.tobytes() + faces.tobytes())
