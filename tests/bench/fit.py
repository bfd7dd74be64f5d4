# SPDX-License-Identifier: Apache-2.0
"""Curves of error against samples: medians over seeds, and the power law that fits them."""
import statistics

import numpy as np


def curves(scene):
    """{"mis": [{samples, error, cpu}], ..., "mis, denoised": [...]}"""
    groups = {}
    for row in scene["rows"]:
        groups.setdefault(row["config"], {}).setdefault(row["samples"], []).append(row)
        if "rel_mse_denoised" in row:
            groups.setdefault(row["config"] + ", denoised", {}).setdefault(row["samples"], []).append(
                {"cpu": row["cpu"] + row["denoise_cpu"], "rel_mse": row["rel_mse_denoised"]})
    return {config: [{"samples": n, "error": statistics.median(r["rel_mse"] for r in rows), "seeds": [r["rel_mse"] for r in rows],
                      "cpu": statistics.median(r["cpu"] for r in rows)} for n, rows in sorted(by_n.items())]
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
