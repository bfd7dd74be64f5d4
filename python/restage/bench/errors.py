# SPDX-License-Identifier: Apache-2.0
"""Errors of pictures, and curves of them: medians and bands over seeds, slopes, the time to a given error."""
import math
import pathlib
import re
import statistics

import numpy as np

EPSILON = 0.01  # of relMSE, as in engine/io/image_compare.hpp
TRIMMED = 0.001  # the share of pixels that the trimmed error leaves out


def read_pfm(path):
    """float32 (H, W, 3), row 0 at the top."""
    data = pathlib.Path(path).read_bytes()
    head = re.match(rb"(P[Ff])\s+(\d+)\s+(\d+)\s+(-?[\d.]+)\s", data)
    if not head:
        raise ValueError(f"{path}: not a PFM picture")
    channels, width, height = 3 if head[1] == b"PF" else 1, int(head[2]), int(head[3])
    order = "<f4" if float(head[4]) < 0 else ">f4"
    pixels = np.frombuffer(data, order, width * height * channels, head.end()).reshape(height, width, channels)[::-1]
    return np.ascontiguousarray(np.broadcast_to(pixels, (height, width, 3)), np.float32)


class Reference:
    """The mean of independent pictures; with two or more, its own noise is known and taken off the errors.

    E[(x - r)^2] is the error of x plus the variance of r. The latter is estimated by the spread of the parts over their
    number; so what is left is unbiased, but may be negative when it is much smaller than the reference's noise."""

    def __init__(self, parts):
        stack = np.stack([np.asarray(p, np.float64) for p in parts])
        self.mean = stack.mean(0)
        self.variance = stack.var(0, ddof=1) / len(parts) if len(parts) > 1 else np.zeros_like(self.mean)
        self.weight = 1 / (self.mean ** 2 + EPSILON)

    def noise(self):
        """relMSE of the reference itself; 0 = unknown."""
        return float((self.variance * self.weight).mean())

    def errors(self, picture):
        """(relMSE, trimmed relMSE): the latter without the thousandth of the pixels that differ most."""
        if picture.shape != self.mean.shape:
            raise ValueError(f"the picture is {picture.shape[1]}x{picture.shape[0]}, the reference {self.mean.shape[1]}x{self.mean.shape[0]}")
        squared = (np.asarray(picture, np.float64) - self.mean) ** 2 * self.weight
        unbiased = (squared - self.variance * self.weight).mean(-1).ravel()
        kept = np.argsort(squared.mean(-1).ravel(), kind="stable")[:max(1, len(unbiased) - int(len(unbiased) * TRIMMED))]
        return float(unbiased.mean()), float(unbiased[kept].mean())


def curve(runs, measure):
    """[{samples, cpu, error, low, high}] by samples: medians over the seeds; the band is their range."""
    by_samples = {}
    for run in runs:
        by_samples.setdefault(run["samples"], []).append(run)
    return [{"samples": n, "cpu": statistics.median(r["cpu"] for r in same), "error": statistics.median(r[measure] for r in same),
             "low": min(r[measure] for r in same), "high": max(r[measure] for r in same)} for n, same in sorted(by_samples.items())]


def slope(x, y):
    """(p, its standard error) of y = a x^p, by least squares of the logarithms; (nan, nan) with fewer than two positive points,
    and no standard error with two."""
    pairs = [(math.log(a), math.log(b)) for a, b in zip(x, y) if a > 0 and b > 0]
    if len(pairs) < 2:
        return math.nan, math.nan
    a, b = np.array(pairs).T
    centred = a - a.mean()
    p = float((centred * b).sum() / (centred ** 2).sum())
    left = b - b.mean() - p * centred
    return p, float(math.sqrt((left ** 2).sum() / (len(a) - 2) / (centred ** 2).sum())) if len(a) > 2 else math.nan


def time_to(points, target):
    """(CPU seconds to that error, whether measured): between two points of a curve, or else along the fit of all. None without
    a fit."""
    good = [p for p in points if p["error"] > 0]
    for before, after in zip(good, good[1:]):
        if before["error"] >= target >= after["error"] and before["error"] > after["error"]:
            share = math.log(before["error"] / target) / math.log(before["error"] / after["error"])
            return before["cpu"] * (after["cpu"] / before["cpu"]) ** share, True
    p, _ = slope([q["cpu"] for q in good], [q["error"] for q in good])
    if not p < 0:
        return None
    last = good[-1]
    return last["cpu"] * (target / last["error"]) ** (1 / p), False
