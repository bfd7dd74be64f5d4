# SPDX-License-Identifier: Apache-2.0
"""Bsdf: a material's shipped GPU code over numpy arrays of directions."""
from __future__ import annotations

import typing

from . import _core

if typing.TYPE_CHECKING:
    import numpy
    from numpy.typing import ArrayLike, NDArray

    Params = dict[str, object] | list[dict[str, object]] | None


class BsdfSample(typing.NamedTuple):
    """Sampled directions. Rows whose `flags` is 0 have no sample; the rest of such a row is undefined."""

    wi: NDArray[numpy.float32]
    "(n, 3): towards the light."
    weight: NDArray[numpy.float32]
    "(n, 3): f |cos| / pdf."
    pdf: NDArray[numpy.float32]
    "(n,): solid-angle density [1/sr]; for a delta lobe the probability of choosing it."
    flags: NDArray[numpy.uint32]
    "(n,): sum of 1 reflected, 2 transmitted, 4 delta."
    eta: NDArray[numpy.float32]
    "(n,): for a transmission, refractive index of the far side over that of the near side; else 1."


class Bsdf:
    """The BSDF of a material type, computed by its plugin's GLSL on the GPU (or lavapipe), in single precision.

        glass = restage.Bsdf("dielectric")
        s = glass.sample(wo, u, {"uroughness": 0.1, "vroughness": 0.1})
        f = glass.eval(wo, s.wi, {"uroughness": 0.1, "vroughness": 0.1})

    Directions are unit vectors in the local frame, n = +z, both pointing away from the surface: wo to the viewer, wi to
    the light; arrays (n, 3), or (3,) for all rows. `params`: a dict for all rows, or a list of n dicts; unnamed
    parameters have their defaults. Textures are not supported.
    """

    def __init__(self, type: str):
        if not isinstance(type, str):
            raise TypeError(f"Bsdf(): \"type\" must be a str, not {type!r}")
        self.type = type
        self._lab = _core.BsdfLab(type)

    def __repr__(self) -> str:
        return f'<restage.Bsdf "{self.type}">'

    def _run(self, wo, wi, u, params, seed, repeats=1):
        import numpy as np

        wo, wi, u = (np.atleast_2d(np.asarray(a, np.float32)) for a in (wo, wi, u))
        n = max(len(wo), len(wi), len(u), len(params) if isinstance(params, list) else 1)
        if any(a.ndim != 2 or a.shape[1] != 3 or len(a) not in (1, n) for a in (wo, wi, u)):
            raise ValueError(f"directions are arrays (n, 3) or (3,); got {wo.shape}, {wi.shape} and {u.shape}")
        wo, wi, u = (np.ascontiguousarray(np.broadcast_to(a, (n, 3))) for a in (wo, wi, u))
        if isinstance(params, list):
            if len(params) != n:
                raise ValueError(f"{len(params)} parameter sets for {n} directions")
            sets, config = params, np.arange(n, dtype=np.uint32)
        else:
            sets, config = [params or {}], np.zeros(n, np.uint32)
        record = np.dtype({
            "names": ["eval", "pdf", "wi", "weight", "sample_pdf", "flags", "eta", "albedo"],
            "formats": ["3f4", "f4", "3f4", "3f4", "f4", "u4", "f4", "3f4"],
            "offsets": [0, 40, 48, 60, 72, 76, 80, 84],
            "itemsize": 96})
        return np.frombuffer(self._lab.run(wo, wi, u, config, sets, seed, repeats), record)

    def eval(self, wo: ArrayLike, wi: ArrayLike, params: Params = None, *, repeats: int = 1,
             seed: int = 0) -> NDArray[numpy.float32]:
        """f(wo, wi) |cos wi|, (n, 3) [1/sr]; 0 for delta lobes. For stochastic materials: an unbiased
        estimate, the mean of `repeats` evaluations."""
        return self._run(wo, wi, (0.5, 0.5, 0.5), params, seed, repeats)["eval"].copy()

    def pdf(self, wo: ArrayLike, wi: ArrayLike, params: Params = None) -> NDArray[numpy.float32]:
        """Solid-angle density of sampling wi, (n,) [1/sr]; 0 for delta lobes."""
        return self._run(wo, wi, (0.5, 0.5, 0.5), params, 0)["pdf"].copy()

    def sample(self, wo: ArrayLike, u: ArrayLike, params: Params = None, *, seed: int = 0) -> BsdfSample:
        """Directions for the random numbers u, (n, 3) in [0, 1)."""
        a = self._run(wo, (0, 0, 1), u, params, seed)
        return BsdfSample(a["wi"].copy(), a["weight"].copy(), a["sample_pdf"].copy(), a["flags"].copy(), a["eta"].copy())

    def albedo(self, wo: ArrayLike, params: Params = None) -> NDArray[numpy.float32]:
        """Albedo as used by the denoiser and the light budget, (n, 3): about the fraction of light that is scattered."""
        return self._run(wo, (0, 0, 1), (0.5, 0.5, 0.5), params, 0)["albedo"].copy()
