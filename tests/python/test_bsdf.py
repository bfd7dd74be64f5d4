# SPDX-License-Identifier: Apache-2.0
"""restage.Bsdf: shapes, broadcasting, and that its four functions agree, for all loaded materials."""
import numpy as np
import pytest

import restage


def sphere(n, seed, upper=True):
    rng = np.random.default_rng(seed)
    v = rng.normal(size=(n, 3))
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    if upper:
        v[:, 2] = np.abs(v[:, 2])
    return v.astype(np.float32)


def test_diffuse_is_lambert():
    diffuse = restage.Bsdf("diffuse")
    wo, wi = sphere(100, 1), sphere(100, 2)
    f = diffuse.eval(wo, wi, {"reflectance": (0.2, 0.4, 0.8)})
    assert f.shape == (100, 3) and f.dtype == np.float32
    assert np.allclose(f, np.array((0.2, 0.4, 0.8)) / np.pi * wi[:, 2:], rtol=1e-5)
    assert np.allclose(diffuse.pdf(wo, wi), wi[:, 2] / np.pi, rtol=1e-5)
    assert np.allclose(diffuse.albedo((0, 0, 1), {"reflectance": 0.25}), 0.25)
    below = wi * (1, 1, -1)
    assert (diffuse.eval(wo, below) == 0).all()


def test_directions_and_parameters_broadcast():
    diffuse = restage.Bsdf("diffuse")
    sets = [{"reflectance": r} for r in (0.1, 0.2, 0.4)]
    f = diffuse.eval((0, 0, 1), (0, 0, 1), sets)
    assert np.allclose(f[:, 0] * np.pi, (0.1, 0.2, 0.4))
    assert diffuse.eval((0, 0, 1), sphere(5, 3)).shape == (5, 3)
    with pytest.raises(ValueError, match="2 parameter sets for 5"):
        diffuse.eval(sphere(5, 1), sphere(5, 2), sets[:2])
    with pytest.raises(ValueError, match="directions are arrays"):
        diffuse.eval(sphere(5, 1), sphere(4, 2))
    with pytest.raises(restage.Error, match='"colour" does not exist in a diffuse'):
        diffuse.eval((0, 0, 1), (0, 0, 1), {"colour": 1})
    with pytest.raises(restage.Error, match="no material type"):
        restage.Bsdf("unobtainium")


@pytest.mark.parametrize("type", sorted(restage.material_types()))
def test_samples_are_finite_and_weights_are_eval_over_pdf(type):
    """A smoke test of the binding; `restage check` tests the plugins."""
    if type in ("mix", "interface"):
        pytest.skip("no BSDF")
    bsdf = restage.Bsdf(type)
    n = 4000
    wo, u = sphere(n, 4), np.random.default_rng(5).random((n, 3), np.float32)
    s = bsdf.sample(wo, u)
    assert s.wi.shape == s.weight.shape == (n, 3) and s.pdf.shape == s.flags.shape == s.eta.shape == (n,)
    lit = s.flags != 0
    assert lit.any() and np.isfinite(s.weight[lit]).all() and (s.pdf[lit] > 0).all()
    assert np.allclose(np.linalg.norm(s.wi[lit], axis=1), 1, atol=1e-3)
    assert np.isfinite(bsdf.albedo(wo)).all()
    rough = lit & (s.flags & 4 == 0)
    if rough.any() and "coated" not in type:  # of layered ones eval is random
        rows = np.flatnonzero(rough)[:500]
        f = bsdf.eval(wo[rows], s.wi[rows])
        assert np.allclose(f / s.pdf[rows, None], s.weight[rows], rtol=2e-2, atol=1e-3)
