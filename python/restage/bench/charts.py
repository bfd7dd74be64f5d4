# SPDX-License-Identifier: Apache-2.0
"""Log-log charts as SVG text. Colours are CSS variables, which are set for light and dark at the end of each file, so that a chart
is legible in a page and by itself."""
import html
import math

WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 560, 380, 62, 30, 44
STYLE = """<style>
.restage-chart{--ink:#1b1f24;--grid:#d8dde3;--paper:#fff;--c0:#0969da;--c1:#cf4a02;--c2:#1a7f37;--c3:#8250df;--c4:#bf3989;--c5:#9a6700;--c6:#57606a;--c7:#0b7f8a;
font:12px system-ui,sans-serif;background:var(--paper)}
@media (prefers-color-scheme:dark){.restage-chart{--ink:#e6edf3;--grid:#30363d;--paper:#0d1117;--c0:#58a6ff;--c1:#ff8f4c;--c2:#3fb950;--c3:#bc8cff;--c4:#f778ba;--c5:#e3b341;--c6:#9da7b3;--c7:#39c5cf}}
.restage-chart text{fill:var(--ink)}
</style>"""
COLOURS = 8
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def ticks(low, high):
    """Powers of ten within [low, high]; with fewer than two, also 2 and 5 times them."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for digits in ((1,), (1, 2, 5), range(1, 10)):
        found = [d * 10.0 ** p for p in powers for d in digits if low <= d * 10.0 ** p * (1 + 1e-9) and d * 10.0 ** p <= high * (1 + 1e-9)]
        if len(found) >= 2:
            return found
    return [low, high]


def label(value):
    """1000 as 1000, 0.001 as 0.001, others in powers of ten."""
    if 1e-3 <= value < 1e4:
        return f"{value:.4g}"
    mantissa, power = f"{value:.0e}".split("e")
    raised = "10" + str(int(power)).translate(SUPERSCRIPTS)
    return raised if mantissa == "1" else f"{mantissa}·{raised}"


def chart(title, x_label, y_label, lines, line_at=None):
    """lines: [(name, [{x, y, low, high}])], low and high may be missing; of points with y <= 0 nothing is drawn. line_at: (y, name)
    of a horizontal line. Returns a whole <svg>, with names and values in it."""
    shown = [(name, [p for p in points if p["x"] > 0 and p["y"] > 0]) for name, points in lines]
    xs = [p["x"] for _, points in shown for p in points]
    ys = [v for _, points in shown for p in points for v in (p["y"], p.get("low", p["y"]), p.get("high", p["y"])) if v > 0]
    rows = len(shown) + (1 if line_at else 0)
    height = HEIGHT + 18 * ((rows + 1) // 2) + 6
    out = [f'<svg class="restage-chart" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img">',
           f"<title>{html.escape(title)}</title>", STYLE, f'<rect width="{WIDTH}" height="{height}" fill="var(--paper)"/>',
           f'<text x="{LEFT}" y="18" font-weight="600">{html.escape(title)}</text>']
    if not xs:
        return "\n".join([*out, f'<text x="{LEFT}" y="60">nothing above zero was measured</text></svg>'])
    if line_at and line_at[0] > 0:
        ys.append(line_at[0])

    def axis(values, start, end):
        low, high = min(values), max(values)
        low, high = (low / 1.5, high * 1.5) if high / low < 2 else (low / 1.15, high * 1.15)
        span = math.log(high / low)
        return low, high, lambda v: start + (end - start) * math.log(min(max(v, low), high) / low) / span

    x_low, x_high, x = axis(xs, LEFT, WIDTH - 14)
    y_low, y_high, y = axis(ys, HEIGHT - BOTTOM, TOP)
    for v in ticks(x_low, x_high):
        out += [f'<path d="M{x(v):.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="var(--grid)"/>',
                f'<text x="{x(v):.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{label(v)}</text>']
    for v in ticks(y_low, y_high):
        out += [f'<path d="M{LEFT} {y(v):.1f}H{WIDTH - 14}" stroke="var(--grid)"/>',
                f'<text x="{LEFT - 6}" y="{y(v) + 4:.1f}" text-anchor="end">{label(v)}</text>']
    out += [f'<text x="{(LEFT + WIDTH) / 2:.0f}" y="{HEIGHT - 8}" text-anchor="middle">{html.escape(x_label)}</text>',
            f'<text transform="translate(13 {(TOP + HEIGHT - BOTTOM) / 2:.0f}) rotate(-90)" text-anchor="middle">{html.escape(y_label)}</text>']
    if line_at and line_at[0] > 0:
        out.append(f'<path d="M{LEFT} {y(line_at[0]):.1f}H{WIDTH - 14}" stroke="var(--ink)" stroke-dasharray="2 3"/>')
    for i, (name, points) in enumerate(shown):
        colour, dash = f"var(--c{i % COLOURS})", ' stroke-dasharray="6 3"' if i >= COLOURS else ""
        band = [p for p in points if p.get("low", 0) > 0]
        if len(band) > 1:
            edge = [f"{x(p['x']):.1f} {y(p['low']):.1f}" for p in band] + [f"{x(p['x']):.1f} {y(p['high']):.1f}" for p in reversed(band)]
            outline = "L".join(edge)
            out.append(f'<path d="M{outline}Z" fill="{colour}" opacity="0.18"/>')
        if points:
            path = "L".join(f"{x(p['x']):.1f} {y(p['y']):.1f}" for p in points)
            out.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>')
        for p in points:
            out.append(f'<circle cx="{x(p["x"]):.1f}" cy="{y(p["y"]):.1f}" r="3.2" fill="{colour}"><title>{html.escape(name)}: {p["x"]:.4g}, {p["y"]:.4g}</title></circle>')
        at_x, at_y = LEFT + (i % 2) * (WIDTH - LEFT) / 2, HEIGHT + 12 + 18 * (i // 2)
        out += [f'<path d="M{at_x:.0f} {at_y - 4}h18" stroke="{colour}" stroke-width="3"{dash}/>',
                f'<text x="{at_x + 24:.0f}" y="{at_y}">{html.escape(name)}</text>']
    if line_at:
        i = len(shown)
        at_x, at_y = LEFT + (i % 2) * (WIDTH - LEFT) / 2, HEIGHT + 12 + 18 * (i // 2)
        out += [f'<path d="M{at_x:.0f} {at_y - 4}h18" stroke="var(--ink)" stroke-dasharray="2 3"/>',
                f'<text x="{at_x + 24:.0f}" y="{at_y}">{html.escape(line_at[1])}</text>']
    return "\n".join([*out, "</svg>"])
