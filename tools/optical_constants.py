#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Numbers for material presets from a page of the refractiveindex.info database (public domain, CC0).

    tools/optical_constants.py PAGE.yml...

Metals: eta and k for linear sRGB primaries, as in plugins/materials/conductor/inspector.c: each colour of the
reflectance at normal incidence under D65 is that of the spectrum; eta is the spectrum's colour, k follows.
Others: the index of refraction at the sodium line, 589.3 nm.
"""
import math
import pathlib
import re
import sys

SODIUM = 0.5893  # [um]


def curves():
    """CIE 1931 observer and D65, 360 to 830 nm in steps of 5 nm, from the renderer's own table."""
    text = (pathlib.Path(__file__).parents[1] / "engine/render/cie.cpp").read_text()
    found = {}
    for name, body in re.findall(r"const Curve (\w+) = \{(.*?)\};", text, re.DOTALL):
        found[name] = [float(x.rstrip("f")) for x in re.findall(r"[-\d.e]+f?", body)]
    return found["x_bar"], found["y_bar"], found["z_bar"], found["d65"]


def linear_srgb(spectrum):
    """Of what reflects spectrum(wavelength [um]) under D65: 1 is white."""
    xyz, white = [0.0] * 3, 0.0
    x, y, z, light = curves()
    for i, power in enumerate(light):
        value = spectrum((360 + 5 * i) / 1000) * power
        for axis, bar in enumerate((x, y, z)):
            xyz[axis] += value * bar[i]
        white += power * y[i]
    xyz = [v / white for v in xyz]
    matrix = ((3.2404542, -1.5371385, -0.4985314), (-0.969266, 1.8760108, 0.041556), (0.0556434, -0.2040259, 1.0572252))
    return [sum(m * v for m, v in zip(row, xyz)) for row in matrix]


def interpolated(rows, column):
    def at(um):
        if um <= rows[0][0]:
            return rows[0][column]
        for a, b in zip(rows, rows[1:]):
            if um <= b[0]:
                return a[column] + (b[column] - a[column]) * (um - a[0]) / (b[0] - a[0])
        return rows[-1][column]

    return at


def dispersion(number, c):
    """The database's formulas: https://refractiveindex.info/database/doc/Dispersion formulas.pdf"""
    c = c + [0.0] * (17 - len(c))
    pairs = range(1, 16, 2)
    if number == 1:
        return lambda um: math.sqrt(1 + c[0] + sum(c[i] * um**2 / (um**2 - c[i + 1] ** 2) for i in pairs))
    if number == 2:
        return lambda um: math.sqrt(1 + c[0] + sum(c[i] * um**2 / (um**2 - c[i + 1]) for i in pairs))
    if number == 3:
        return lambda um: math.sqrt(c[0] + sum(c[i] * um ** c[i + 1] for i in pairs if c[i]))
    if number == 5:
        return lambda um: c[0] + sum(c[i] * um ** c[i + 1] for i in pairs if c[i])
    raise SystemExit(f"formula {number} of the database is not read here")


def read(text):
    """n(um) and k(um) of a page; k is None where it has none."""
    n = k = None
    for kind, body in re.findall(r"- type: ([\w ]+)\n(.*?)(?=\n  - type|\Z|\n\w)", text, re.DOTALL):
        if kind.startswith("tabulated"):
            rows = [[float(x) for x in line.split()] for line in body.split("|", 1)[1].splitlines() if line.strip()]
            what = kind.split()[1]
            if what in ("n", "nk"):
                n = interpolated(rows, 1)
            if what in ("k", "nk"):
                k = interpolated(rows, len(rows[0]) - 1)
        elif re.fullmatch(r"formula \d", kind):
            n = dispersion(int(kind.split()[1]), [float(x) for x in re.search(r"coefficients: (.*)", body)[1].split()])
    return n, k


def metal(n, k):
    def reflectance(um):
        return ((n(um) - 1) ** 2 + k(um) ** 2) / ((n(um) + 1) ** 2 + k(um) ** 2)

    etas = [max(e, 0.01) for e in linear_srgb(n)]
    shares = [min(max(r, 0.0), 0.999) for r in linear_srgb(reflectance)]
    ks = [math.sqrt(max(0, (r * (e + 1) ** 2 - (e - 1) ** 2) / (1 - r))) for e, r in zip(etas, shares)]
    return etas, ks


if __name__ == "__main__":
    for page in sys.argv[1:]:
        n, k = read(pathlib.Path(page).read_text())
        if k and k(SODIUM) > 0.1:
            print(page, *("[" + ", ".join(f"{x:.4f}" for x in v) + "]" for v in metal(n, k)))
        else:
            print(page, f"{n(SODIUM):.4f}")
