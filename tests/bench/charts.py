# SPDX-License-Identifier: Apache-2.0
"""Log-log charts of error, one panel a scene."""
import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams["svg.hashsalt"] = "restage" # the same figures give the same file
import matplotlib.pyplot as plt # noqa: E402

import fit # noqa: E402

STYLE = {"mis": ("C0", "-"), "mis, denoised": ("C0", ":"), "mis, no roulette": ("C2", "--"), "light": ("C1", "-"), "bsdf": ("C3", "-")}


def error_charts(scenes, folder):
    for axis, label in (("samples", "samples a pixel"), ("cpu", "CPU seconds")):
        figure, panels = plt.subplots(1, len(scenes), figsize=(4.6 * len(scenes), 4.4), squeeze=False)
        for panel, (name, scene) in zip(panels[0], scenes.items()):
            for config, points in fit.curves(scene).items():
                color, line = STYLE.get(config, ("grey", "-"))
                x = [p[axis] for p in points]
                slope = f"{config}: p = {fit.power_law(points)[0]:.2f}" if axis == "samples" else config
                panel.loglog(x, [p["error"] for p in points], color=color, linestyle=line, marker="o", markersize=3, label=slope)
                panel.fill_between(x, [min(p["seeds"]) for p in points], [max(p["seeds"]) for p in points], color=color, alpha=0.15)
            panel.axhline(scene["reference_noise"], color="grey", linewidth=0.8)
            panel.annotate("noise of the reference", (0.02, scene["reference_noise"]), xycoords=("axes fraction", "data"),
                           fontsize=7, color="grey", va="bottom")
            panel.set_title(f"{name}, {scene['width']}x{scene['height']}", fontsize=10)
            panel.set_xlabel(label)
            panel.grid(True, which="major", alpha=0.3)
            panel.legend(fontsize=7)
        panels[0][0].set_ylabel("relMSE to pbrt-v4")
        figure.tight_layout()
        figure.savefig(folder / f"error_{'samples' if axis == 'samples' else 'time'}.svg", metadata={"Date": None})
        plt.close(figure)
