# SPDX-License-Identifier: Apache-2.0
"""Small pbrt-v4 scenes as text, their pictures, and closed forms to hold them against.

Unless a test says otherwise the camera is above the origin and looks down on a few thousandths of a degree, so that one number
describes the picture.
"""
import dataclasses
import math
import pathlib

import numpy as np

import restage



def numbers(values):
    return "[ " + " ".join(repr(float(v)) for v in np.ravel(values)) + " ]"


def rgb(name, value):
    return f'"rgb {name}" {numbers([value] * 3 if np.isscalar(value) else value)}'


def diffuse(reflectance):
    return f'Material "diffuse" {rgb("reflectance", reflectance)}\n'


def glass(eta, **values):
    return " ".join(['Material "dielectric"', f'"float eta" {float(eta)!r}', *(f'"float {k}" {float(v)!r}' for k, v in values.items())]) + "\n"


def mesh(points, triangles, normals=None, extra=""):
    indices = " ".join(str(int(i)) for i in np.ravel(triangles))
    n = f' "normal N" {numbers(normals)}' if normals is not None else ""
    return f'Shape "trianglemesh" "point3 P" {numbers(points)} "integer indices" [ {indices} ]{n} {extra}\n'


def rectangle(x0, x1, y0, y1, z, up=True, extra=""):
    """Parallel to the xy plane; its normal, and its side that emits, is +z, or -z if not `up`."""
    corners = [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
    return mesh(corners if up else corners[::-1], [0, 1, 2, 0, 2, 3], extra=extra)


def square(half, z=0.0, up=True, extra=""):
    return rectangle(-half, half, -half, half, z, up, extra)


def lamp(radiance, shape, two_sided=False):
    both = ' "bool twosided" true' if two_sided else ""
    return f'AttributeBegin\n{diffuse(0)}AreaLightSource "diffuse" {rgb("L", radiance)}{both}\n{shape}AttributeEnd\n'


def within(transform, body):
    return f"AttributeBegin\n{transform}\n{body}AttributeEnd\n"


def distant(irradiance, toward):
    """Parallel light: `irradiance` on a surface that faces it. toward: direction from the surface to the light."""
    return f'LightSource "distant" {rgb("L", irradiance)} "point3 from" {numbers(toward)} "point3 to" [ 0 0 0 ]\n'


def point(intensity, at):
    return f'LightSource "point" {rgb("I", intensity)} "point3 from" {numbers(at)}\n'


def sky(radiance):
    return f'LightSource "infinite" {rgb("L", radiance)}\n'


def room(half=1.0, wall=None, place=tuple):
    """Six walls, facing inwards, around the cube of half the width `half`; each extends to `wall` (default: as far). place: of a point."""
    wall = half if wall is None else wall
    text = ""
    for axis in range(3):
        for side in (-1, 1):
            p = np.empty((4, 3))
            p[:, axis] = side * half
            p[:, (axis + 1) % 3] = (-wall, wall, wall, -wall)
            p[:, (axis + 2) % 3] = (-wall, -wall, wall, wall)
            p = [place(q) for q in (p if side < 0 else p[::-1])]
            text += mesh(p, [0, 1, 2, 0, 2, 3])
    return text


@dataclasses.dataclass(frozen=True)
class Measured:
    """The mean of a grey picture, and the standard error of that mean by the film's own account."""
    value: float
    sigma: float
    picture: object
    report: list

    @property
    def pixels(self):
        return self.picture.color[..., 1].astype(np.float64)

    def is_mean(self, expected, relative=0.0, sharp=0.02):
        """Within four standard errors and `relative` of the closed form; `sharp`: the relative error that it must not exceed."""
        self.is_clean()
        assert self.sigma <= sharp * expected, f"too noisy to tell: {self.sigma} of {expected}"
        off = abs(self.value - expected)
        assert off <= 4 * self.sigma + relative * expected, f"{self.value} +- {self.sigma} instead of {expected}"

    def is_everywhere(self, expected, relative=1e-5, absolute=0.0):
        """Without noise: each pixel."""
        self.is_clean()
        off = np.abs(self.pixels - expected)
        worst = np.unravel_index(np.argmax(off), off.shape)
        assert off.max() <= relative * expected + absolute, f"{self.pixels[worst]} at {worst} instead of {expected}"

    def is_clean(self):
        assert self.picture.finished and np.isfinite(self.picture.color).all() and np.isfinite(self.picture.std_error).all()
        assert self.picture.not_finite == {}


class Stage:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def scene(self, body, eye=(0, 0, 1), at=(0, 0, 0), up=(0, 1, 0), fov=0.01, size=(8, 8), depth=1, transform="", film="",
              camera="perspective"):
        """A file of the scene. transform: of the world and the camera alike. depth: bounces after the first hit."""
        lens = f' "float fov" {fov!r}' if camera == "perspective" else ""
        path = self.folder / "scene.pbrt"
        view = np.array(eye), np.array(at), np.array(up)
        path.write_text(
            f"LookAt {numbers(np.concatenate(view))[2:-2]}\n"
            f'Camera "{camera}"{lens}\nPixelFilter "box"\nSampler "sobol"\nIntegrator "volpath" "integer maxdepth" {depth}\n'
            f'Film "rgb" "integer xresolution" {size[0]} "integer yresolution" {size[1]} {film}\nWorldBegin\n{transform}\n{body}')
        return path

    def render(self, body, samples=1, seed=1, threads=0, first_sample=0, **view):
        with restage.open(self.scene(body, **view)) as session:
            session.exposure = 1
            picture = session.render(samples=samples, seed=seed, threads=threads, first_sample=first_sample)
            report = [str(e) for e in session.report.entries if e.fate != "kept"]
        value = picture.color[..., 1].astype(np.float64)
        error = picture.std_error[..., 1].astype(np.float64)
        return Measured(value.mean(), math.sqrt((error ** 2).mean() / error.size), picture, report)


# ---- closed forms ----

def rectangle_form(x0, x1, y0, y1, z):
    """Form factor from a point at the origin, facing +z, to a rectangle parallel to it (Howell, C-3 and C-4)."""
    def corner(x, y):
        a, b = x / z, y / z
        ra, rb = math.sqrt(1 + a * a), math.sqrt(1 + b * b)
        return (a / ra * math.atan(b / ra) + b / rb * math.atan(a / rb)) / (2 * math.pi)
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)


def fresnel(cos_i, eta):
    """Unpolarized reflectance of a dielectric of relative index eta."""
    sin2 = (1 - cos_i * cos_i) / eta ** 2
    if sin2 >= 1:
        return 1.0
    cos_t = math.sqrt(1 - sin2)
    a, b = (eta * cos_i - cos_t) / (eta * cos_i + cos_t), (cos_i - eta * cos_t) / (cos_i + eta * cos_t)
    return 0.5 * (a * a + b * b)


def stack_transmittance(reflectances):
    """Of parallel interfaces with all reflections between them (Stokes 1862)."""
    return 1 / (1 + sum(r / (1 - r) for r in reflectances))


def furnace(emission, albedo, depth):
    """Radiance in a closed room whose walls emit and reflect, up to so many bounces."""
    return emission * sum(albedo ** k for k in range(depth + 1))


def write_pfm(path, pixels):
    """pixels: (H, W) or (H, W, 3), row 0 on top."""
    pixels = np.asarray(pixels, "<f4")
    kind = b"PF" if pixels.ndim == 3 else b"Pf"
    path.write_bytes(kind + b"\n%d %d\n-1.0\n" % (pixels.shape[1], pixels.shape[0]) + pixels[::-1].tobytes())


def write_ply(path, points, triangles):
    faces = np.empty(len(triangles), np.dtype([("n", "u1"), ("i", "<i4", 3)]))
    faces["n"], faces["i"] = 3, triangles
    path.write_bytes(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                     b"property float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n"
                     % (len(points), len(triangles)) + np.asarray(points, "<f4").tobytes() + faces.tobytes())
