# SPDX-License-Identifier: Apache-2.0
"""Against Mitsuba 3 (scalar_rgb, single precision), where the models are the same. Not part of tools/setup: install
`mitsuba` with the package to run it. docs/references.md has the measurements.

diffuse, conductor, dielectric (smooth) are compared directly. Mitsuba's rough models take the uncorrelated Smith term
G1 G1 (ours: height-correlated), so they are compared with bsdf_references.py in that form, and test_bsdf_references.py
compares the GPU with the same functions in ours: distribution, Fresnel, Jacobians and scaling by eta are checked end to end.
Not comparable: plastic and roughplastic (a base with interior scattering; ours is pbrt-v3's sum), principled (Disney's;
ours is glTF's)."""
import numpy as np
import pytest

mi = pytest.importorskip("mitsuba", reason="mitsuba is not installed: pip install mitsuba, to compare with it")
mi.set_variant("scalar_rgb")

import bsdf_references as ref
import restage

N = 2000


def sphere(rng, n, upper=False):
    w = rng.normal(size=(n, 3))
    w /= np.linalg.norm(w, axis=1, keepdims=True)
    if upper:
        w[:, 2] = np.abs(w[:, 2])
    return w.astype(np.float32).astype(np.float64)


def interaction(wo):
    si = mi.SurfaceInteraction3f()
    si.wi = mi.Vector3f(wo)
    si.sh_frame = mi.Frame3f(mi.Vector3f(0, 0, 1))
    return si


def mitsuba_eval(bsdf, wo, wi):
    context = mi.BSDFContext()
    return np.array([bsdf.eval(context, interaction(o), mi.Vector3f(i)) for o, i in zip(wo, wi)], np.float64)


def worst(got, want, most):
    """Relative to the value, and to a thousandth of the largest: Mitsuba too computes in single precision."""
    error = np.abs(got - want) / (np.abs(want) + 1e-3 * np.abs(want).max())
    assert error.max() < most, f"worst {error.max():.1e}, 99 % {np.quantile(error, 0.99):.1e}"
    return error.max()


def test_diffuse():
    rng = np.random.default_rng(1)
    wo, wi = sphere(rng, N, True), sphere(rng, N, True)
    theirs = mitsuba_eval(mi.load_dict({"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.2, 0.5, 0.8]}}), wo, wi)
    ours = restage.Bsdf("diffuse").eval(wo, wi, {"reflectance": (0.2, 0.5, 0.8)})
    print("diffuse", worst(ours, theirs, 1e-5))


@pytest.mark.parametrize("kind, most", [("ggx", 1e-5), ("beckmann", 8e-3)])  # Mitsuba fits G1 within 0.4 %
@pytest.mark.parametrize("ax, ay", [(0.1, 0.1), (0.5, 0.2), (0.9, 0.9)])
def test_roughconductor(kind, most, ax, ay):
    rng = np.random.default_rng(2)
    wo, wi = sphere(rng, N, True), sphere(rng, N, True)
    bsdf = mi.load_dict({"type": "roughconductor", "distribution": kind, "alpha_u": ax, "alpha_v": ay, "eta": 0.2, "k": 3.9})
    mine = ref.conductor(wo, wi, np.full((N, 3), 0.2), np.full((N, 3), 3.9), np.full(N, ax), np.full(N, ay),
                         kind == "beckmann", correlated=False)
    print("roughconductor", kind, ax, ay, worst(mine, mitsuba_eval(bsdf, wo, wi), most))


@pytest.mark.parametrize("kind, most", [("ggx", 5e-4), ("beckmann", 8e-3)])
@pytest.mark.parametrize("alpha", [0.15, 0.6])
def test_roughdielectric_reflects_and_transmits(kind, most, alpha):
    rng = np.random.default_rng(3)
    wo, wi = sphere(rng, N), sphere(rng, N)
    bsdf = mi.load_dict({"type": "roughdielectric", "distribution": kind, "alpha": alpha, "int_ior": 1.5, "ext_ior": 1.0})
    mine = ref.dielectric(wo, wi, np.full(N, 1.5), np.full(N, alpha), np.full(N, alpha), kind == "beckmann", correlated=False)
    theirs = mitsuba_eval(bsdf, wo, wi)
    both = (wo[:, 2] * wi[:, 2] > 0)
    assert (theirs[both] > 0).any() and (theirs[~both] > 0).any()
    print("roughdielectric", kind, alpha, worst(mine, theirs, most))


def test_smooth_conductor_and_dielectric():
    rng = np.random.default_rng(4)
    wo, u = sphere(rng, N), rng.random((N, 3), np.float32)
    context = mi.BSDFContext()
    upper = np.concatenate([wo[:, :2], np.abs(wo[:, 2:])], 1)
    metal = mi.load_dict({"type": "conductor", "eta": 0.2, "k": 3.9})
    theirs = np.array([metal.sample(context, interaction(o), 0.5, mi.Point2f(0.5, 0.5))[1] for o in upper])
    ours = restage.Bsdf("conductor").sample(upper, u, {"eta": (0.2,) * 3, "k": (3.9,) * 3})
    print("conductor", worst(ours.weight, theirs, 1e-4))

    glass = mi.load_dict({"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0})
    ours = restage.Bsdf("dielectric").sample(wo, u, {"eta": 1.5})
    for row in range(0, N, 4):
        sample, weight = glass.sample(context, interaction(wo[row]), float(u[row, 2]), mi.Point2f(0.5, 0.5))
        share = sample.pdf  # of the lobe that was picked
        if abs(u[row, 2] - (share if sample.wo[2] * wo[row, 2] > 0 else 1 - share)) < 1e-4:
            continue  # on the border between the lobes
        assert np.allclose(ours.wi[row], np.array(sample.wo), atol=1e-5), row
        assert np.isclose(ours.pdf[row], share, rtol=1e-3, atol=1e-5) and np.allclose(ours.weight[row], weight, rtol=1e-4), row
