# SPDX-License-Identifier: Apache-2.0
"""Log-log charts of error, one column a scene: above over all pixels, below without the worst thousandth of them."""
import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams["svg.hashsalt"] = "restage" # the same figures give the same file
import matplotlib.pyplot as plt # noqa: E402

import fit # noqa: E402

STYLE = {"mis": ("C0", "-"), "mis, denoised": ("C0", ":"), "mis, no roulette": ("C2", "--"), "light": ("C1", "-"), "bsdf": ("C3", "-")}
ROWS = [("rel_mse", "reference_noise", "relMSE to pbrt-v4"), ("trimmed", "reference_noise_trimmed", "without the worst 0.1 % of pixels")]


def panel_of(panel, scene, axis, measure, noise):
    for config, points in fit.curves(scene, measure).items():
        color, line = STYLE.get(config, ("grey", "-"))
        x = [p[axis] for p in points]
        label = f"{config}: p = {fit.power_law(points)[0]:.2f}" if axis == "samples" else config
        panel.loglog(x, [p["error"] for p in points], color=color, linestyle=line, marker="o", markersize=3, label=label)
        panel.fill_between(x, [min(p["seeds"]) for p in points], [max(p["seeds"]) for p in points], color=color, alpha=0.15)
    panel.axhline(noise, color="grey", linewidth=0.8)
    panel.annotate("noise of the reference", (0.02, noise), xycoords=("axes fraction", "data"), fontsize=7, color="grey", va="bottom")
    panel.grid(True, which="major", alpha=0.3)
    panel.legend(fontsize=7)


def error_charts(scenes, folder):
    for axis, label in (("samples", "samples a pixel"), ("cpu", "CPU seconds")):
        figure, panels = plt.subplots(2, len(scenes), figsize=(4.6 * len(scenes), 8.4), squeeze=False)
        for column, (name, scene) in enumerate(scenes.items()):
            for row, (measure, noise, _) in enumerate(ROWS):
                panel_of(panels[row][column], scene, axis, measure, scene[noise])
            panels[0][column].set_title(f"{name}, {scene['width']}x{scene['height']}", fontsize=10)
            panels[1][column].set_xlabel(label)
        for row, (_, _, what) in enumerate(ROWS):
            panels[row][0].set_ylabel(what)
        figure.tight_layout()
        figure.savefig(folder / f"error_{'samples' if axis == 'samples' else 'time'}.svg", metadata={"Date": None})
        plt.close(figure)
