# SPDX-License-Identifier: Apache-2.0
"""The measurement as one HTML page that needs no other file: charts, tables, pictures as PNG inside, the figures as JSON."""
import base64
import html
import json
import math
import struct
import zlib

import numpy as np

from . import charts, errors

STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;background:#fff;color:#1b1f24;color-scheme:light dark}
h1{font-size:1.5em}h2{margin-top:2em;border-bottom:1px solid #8886}.charts{display:flex;flex-wrap:wrap;gap:1em}.charts svg{flex:1 1 480px;max-width:600px}
table{border-collapse:collapse;margin:1em 0}th,td{padding:.25em .7em;text-align:right;border-bottom:1px solid #8884}th:first-child,td:first-child{text-align:left}
.compare{position:relative;display:inline-block;line-height:0}.compare img{width:min(90vw,640px);image-rendering:pixelated}.compare img.over{position:absolute;left:0;top:0}
.tools{margin:.4em 0}.tools input{width:min(90vw,640px);display:block}small{color:#6a737d}
@media (prefers-color-scheme:dark){body{background:#0d1117;color:#e6edf3}small{color:#9da7b3}}"""
SCRIPT = """for(const box of document.querySelectorAll('.pictures')){const images=box.querySelectorAll('.compare img'),lists=box.querySelectorAll('select'),
slide=box.querySelector('input');lists[1].innerHTML=lists[0].innerHTML;lists[1].selectedIndex=Math.min(1,lists[1].length-1);const show=()=>{images.forEach((image,i)=>{image.src=lists[i].value});
images[1].style.clipPath='inset(0 0 0 '+slide.value+'%)'};lists.forEach(l=>l.onchange=show);slide.oninput=show;show()}"""


def png(picture, exposure=1.0):
    """An sRGB PNG of a linear picture (H, W, 3)."""
    linear = np.clip(np.nan_to_num(picture) * exposure, 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    rows = np.pad((srgb * 255 + 0.5).astype(np.uint8).reshape(len(picture), -1), ((0, 0), (1, 0)))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", picture.shape[1], picture.shape[0], 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + chunk(b"IEND", b""))


def data_uri(picture, exposure):
    return "data:image/png;base64," + base64.b64encode(png(picture, exposure)).decode()


def figure(value, digits=3):
    return "–" if value is None or math.isnan(value) else f"{value:.{digits}g}"


def table(head, rows):
    def line(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(c))}</{tag}>" for c in cells) + "</tr>"
    return "<table>" + line(head, "th") + "".join(line(r, "td") for r in rows) + "</table>"


def scene_charts(name, scene):
    """{file stem: svg}"""
    result = {}
    for measure, key, what in (("rel_mse", "curve", "relMSE"), ("trimmed", "curve_trimmed", "relMSE without the worst 0.1 % of pixels")):
        curves = [(c["name"], c[key]) for c in scene["configurations"]]
        for axis, label in (("cpu", "CPU seconds, all threads"), ("samples", "samples a pixel")):
            lines = [(n, [{"x": p[axis], "y": p["error"], "low": p["low"], "high": p["high"]} for p in points]) for n, points in curves]
            noise = (scene["reference_noise"], "noise of the reference") if scene["reference_noise"] > 0 else None
            result[f"{name}-{measure}-{axis}"] = charts.chart(f"{name}: {what}", label, what, lines, noise)
    return result


def scene_table(scene):
    target = scene["target_error"]
    rows = []
    for c in scene["configurations"]:
        points, trimmed = c["curve"], c["curve_trimmed"]
        last = points[-1]
        p, se = errors.slope([q["samples"] for q in points], [q["error"] for q in points])
        q, _ = errors.slope([r["cpu"] for r in points], [r["error"] for r in points])
        time = errors.time_to(points, target)
        rows.append([c["name"], last["samples"], figure(last["cpu"]), f"{figure(last['error'])} ({figure(last['low'])}–{figure(last['high'])})",
                     figure(trimmed[-1]["error"]), figure(last["error"] * last["cpu"]),
                     f"{figure(p)}" + ("" if math.isnan(se) else f" ± {figure(se, 2)}"), figure(q),
                     "–" if time is None else figure(time[0]) + ("" if time[1] else " *"), figure(c.get("bias"))])
    return table(["", "samples", "CPU-s", "relMSE (range of seeds)", "trimmed", "relMSE × CPU-s", "slope, samples", "slope, CPU-s",
                  f"CPU-s to {figure(target)}", "against Restage"], rows)


def growth_charts(growth):
    titles = {"rays_per_cpu_second": "rays a CPU second", "memory": "peak memory, bytes", "setup": "CPU seconds before rendering"}
    return {f"growth-{kind}-{key}": charts.chart(f"{what} against {kind}", kind, what, [("Restage", [{"x": p["size"], "y": p[key]} for p in points if key in p])])
            for kind, points in growth.items() for key, what in titles.items()}


def write(data, pictures, folder):
    """data: what bench.json has; pictures: {scene: {name: (H, W, 3)}}. Writes bench.json, charts and index.html."""
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps(data, indent=1)
    (folder / "bench.json").write_text(text + "\n")
    m = data["machine"]
    body = [f"<h1>Error against time</h1><p>{html.escape(m['cpu'])}, {m['cores']} cores; {html.escape(m['system'])}; Restage {html.escape(m['restage'])}; "
            f"{html.escape(data['date'])}.</p><p><small>relMSE: squared error over the square of the reference + {errors.EPSILON}, mean over pixels and "
            "channels; the reference's own noise is taken off. Each renderer is measured against its own reference, made of other seeds, or all "
            "against the given one; <i>against Restage</i> is the relMSE between the two references, noise taken off: how much the renderers differ "
            "by their models. Lines are medians over seeds, bands their range. CPU time counts all threads, and leaves out loading and "
            "compiling. A star: beyond the measured points, along the fitted slope.</small></p>"]
    svgs = {}
    for name, scene in data["scenes"].items():
        made = scene_charts(name, scene)
        svgs |= made
        body += [f"<h2>{html.escape(name)}</h2><p>{scene['width']}×{scene['height']}, {scene['seeds']} seeds; reference of {scene['reference']}.</p>",
                 '<div class="charts">', *made.values(), "</div>", scene_table(scene)]
        for note in scene["notes"]:
            body.append(f"<p><small>{html.escape(note)}</small></p>")
        images = pictures.get(name, {})
        if images:
            bright = float(np.mean(next(iter(images.values()))))
            uris = {n: data_uri(p, 0.25 / max(bright, 1e-6)) for n, p in images.items()}
            options = "".join(f'<option value="{uri}">{html.escape(n)}</option>' for n, uri in uris.items())
            body.append(f'<div class="pictures"><div class="tools">left <select>{options}</select> right <select></select>'
                        '<input type="range" min="0" max="100" value="50" aria-label="border between the pictures"></div>'
                        '<div class="compare"><img alt="left picture"><img class="over" alt="right picture"></div></div>')
    if data.get("growth"):
        made = growth_charts(data["growth"])
        svgs |= made
        body += ["<h2>Growth</h2>", '<div class="charts">', *made.values(), "</div>"]
        for kind, points in data["growth"].items():
            body += [f"<p><small>{p['size']:,} {kind}: {html.escape(p['failed'])}</small></p>" for p in points if "failed" in p]
    for stem, svg in svgs.items():
        (folder / f"{stem}.svg").write_text(svg + "\n")
    embedded = text.replace("<", "\\u003c")
    (folder / "index.html").write_text(
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Restage: error against time</title>'
        f"<style>{STYLE}</style></head><body>\n" + "\n".join(body) +
        f'\n<script type="application/json" id="figures">{embedded}</script>\n<script>{SCRIPT}</script></body></html>\n')
