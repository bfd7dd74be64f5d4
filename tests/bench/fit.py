# SPDX-License-Identifier: Apache-2.0
"""Curves of error against samples: medians over seeds, and the power law that fits them."""
import statistics

import numpy as np


def curves(scene, measure):
    """{"mis": [{samples, error, cpu}], ..., "mis, denoised": [...]}; measure is "rel_mse" (all pixels) or "trimmed"."""
    groups = {}
    for row in scene["rows"]:
        groups.setdefault(row["config"], {}).setdefault(row["samples"], []).append((row["cpu"], row[measure]))
        if measure + "_denoised" in row:
            groups.setdefault(row["config"] + ", denoised", {}).setdefault(row["samples"], []).append(
                (row["cpu"] + row["denoise_cpu"], row[measure + "_denoised"]))
    return {config: [{"samples": n, "error": statistics.median(error for _, error in seeds), "seeds": [error for _, error in seeds],
                      "cpu": statistics.median(cpu for cpu, _ in seeds)} for n, seeds in sorted(by_n.items())]
            for config, by_n in groups.items()}


def power_law(points):
    """(p, floor) of error = a N^-p + floor, least squares of log(error); the floor is tried in steps."""
    n, e = (np.array([p[k] for p in points], float) for k in ("samples", "error"))
    best = None
    for floor in np.concatenate([[0], e.min() * np.linspace(0.02, 0.98, 49)]):
        slope, offset = np.polyfit(np.log(n), np.log(e - floor), 1)
        residual = np.sum((np.log(np.exp(offset) * n ** slope + floor) - np.log(e)) ** 2)
        if best is None or residual < best[0]:
            best = (residual, -slope, floor)
    return best[1], best[2]
