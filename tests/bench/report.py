# SPDX-License-Identifier: Apache-2.0
"""bench.json as a page: docs/bench/README.md, with charts beside it."""
import statistics

import needs as needs_script


def spread(values, form="{:.2f}"):
    """Median and range."""
    low, high, middle = (form.format(f(values)) for f in (min, max, statistics.median))
    return middle if low == high else f"{middle} ({low}–{high})"


def column(runs, key):
    return [r[key] for r in runs]


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(c) for c in line) + " |" for line in lines) + "\n"


def rays(f):
    runs = f["runs"]

    def samples(who):
        return f"{(runs[0][who + 'rays'] + runs[0][who + 'shadow_rays']) / (512 * 512 * f['samples']):.3f}"

    rows = [
        ["M rays / s, wall (target 2.0)", spread(column(runs, "mrays_wall"))],
        ["M rays / CPU-s", spread(column(runs, "mrays_cpu"))],
        ["plain Embree loop, same rays: M rays / CPU-s", spread(column(runs, "plain_mrays_cpu"))],
        ["whole frame / plain Embree loop, CPU time", spread(column(runs, "frame_over_plain"))],
        ["plain C++ path tracer on Embree: M rays / CPU-s", spread(column(runs, "cpp_mrays_cpu"))],
        ["whole frame / plain C++ path tracer, CPU time for equal samples", spread(column(runs, "frame_over_cpp"))],
        ["share of wall time in kernels (shading)", spread(column(runs, "share_shading"))],
        ["share of wall time in the CPU pass (tracing)", spread(column(runs, "share_tracing"))],
    ]
    return ("## Rays a second\n\nA closed room with 20 instances of a mesh of 199,692 triangles (diffuse, GGX conductor, glass), "
            f"5 bounces, 512x512, {f['samples']} samples a pixel, {f['threads']} threads; closest-hit and shadow rays are counted. "
            f"The plain loop traces the {f['rays_recorded']:,} rays of one sample a pixel, as the engine sent them to Embree, "
            "again with `rtcIntersect1` and `rtcOccluded1` and nothing else: the frame's ratio to it is what everything but "
            "Embree costs. The plain path tracer (plain_tracer.cpp) is the same estimator written straight in C++ for these three "
            "materials, without queues, textures, guide images, film or plugins: "
            f"{samples('cpp_')} rays a sample against our {samples('')}, mean luminance "
            f"{statistics.median(column(runs, 'cpp_mean_luminance')):.4f} against {statistics.median(column(runs, 'mean_luminance')):.4f}.\n\n" + table(["", "median (min–max)"], rows))


def edits(f):
    rows = []
    for e in f["edits"]:
        r = e["runs"]
        rows.append([e["edit"], spread([1000 * x for x in column(r, "wall")], "{:.1f}"),
                     spread([1000 * x for x in column(r, "cpu")], "{:.1f}"), spread(column(r, "uploaded_bytes"), "{:.0f}"),
                     max(column(r, "pipelines")), max(column(r, "mesh_structures_built"))])
    return (f"## Edits\n\nOne of {f['instances']} instances of a mesh of 20,172 triangles is edited: from the edit until the next sample "
            "can start. Target: 20 ms.\n\n" + table(["edit", "ms, wall", "ms, CPU", "bytes uploaded", "pipelines made", "mesh BVHs built"], rows))


def copies(f):
    names = {"copy": "copy of the scene", "set_and_copy": "an object moved, and a copy", "each": "walk over all objects",
             "find": "all objects by id", "frame": "frame of a drag: moved, copied, renderer's scene brought up to date"}
    scenes = f["scenes"]
    rows = [[name, *(c for s in scenes for c in (f"{1e6 * s[key]['seconds']:.1f}", s[key]["allocations"]))] for key, name in names.items()]
    head = [c for s in scenes for c in (f"{s['instances']:,} objects, us", "allocations")]
    return "## Copies of a scene\n\nThe live picture follows a copy of the scene.\n\n" + table(["", *head], rows)


def actions(f):
    names = {"run": "run, on a worker", "apply": "taken into the document", "undo": "undo", "redo": "redo",
             "sync": "renderer's scene brought up to date", "sync_undo": "the same after undo"}
    head = [f"{r['copies']:,} copies, ms" for r in f["rows"]]
    rows = [[name, *(spread([1000 * x for x in column(r["runs"], key)], "{:.1f}") for r in f["rows"])] for key, name in names.items()]
    rows += [[name, *(spread([x / 2**20 for x in column(r["runs"], key)], "{:.1f}") for r in f["rows"])]
             for key, name in {"peak_bytes": "memory at most, MiB", "history_bytes": "in the history, MiB"}.items()]
    return (f"## Actions\n\nScatter puts copies of a sphere over hills of {f['triangles']:,} triangles. Targets for 10,000: run "
            f"{f['target_run']:.0f} s, undo {1000 * f['target_undo']:.0f} ms.\n\n" + table(["", *head], rows))


def features(f):
    base = statistics.median(column(f["alone"]["seconds_a_sample"], "cpu"))
    names = {"alone": "Cornell box alone", "types": "and every material type, where no ray goes",
             "features": "and every feature: environment, lens, medium, filter table, texture and bump", "all": "both"}
    rows = []
    for key, name in names.items():
        v = f[key]
        cpu = column(v["seconds_a_sample"], "cpu")
        rows.append([name, v["types"], spread([1000 * x for x in cpu], "{:.0f}"), f"{statistics.median(cpu) / base:.2f}",
                     f"{v['spirv_bytes'] / 1024:.0f}", f"{v['machine_code_cache_bytes'] / 1024:.0f}",
                     f"{v['first_sample_cpu_cold']:.1f}", f"{v['first_sample_cpu']:.1f}"])
    return ("## A scene pays only for what it uses\n\nCornell box, diffuse, 512x512, 5 bounces. The additions hardly change the "
            "picture: what they cost is what the scene would pay for things it does not need.\n\n" +
            table(["scene", "material types", "CPU ms a sample a pixel", "ratio", "SPIR-V KiB", "Mesa's cache KiB",
                   "first sample, cold, CPU-s", "warm, CPU-s"], rows))


def needs(f):
    return ("## No more than a scene needs\n\nEach scene as usual / with shaders that keep all features which scenes can have (textures, bump, environment, lens, "
            "media, quadrics, lamps of each kind ...), in turns, 64x64, 64 samples. By needs.py, which says what the columns are.\n\n" + needs_script.table(f) + "\n")


def multiscatter(f):
    rows = []
    for name, v in f.items():
        without, on = column(v["without"], "cpu"), column(v["with"], "cpu")
        rows.append([name, spread([1000 * x for x in without], "{:.0f}"), spread([1000 * x for x in on], "{:.0f}"),
                     f"{statistics.median(on) / statistics.median(without):.2f}"])
    return ("## What energy compensation costs\n\nThe two boxes of the Cornell box (512x512, 5 bounces) in the material, alpha 0.5, without "
            "and with `multiscatter`.\n\n" + table(["material", "CPU ms a sample a pixel, without", "with", "ratio"], rows))


def first_image(f):
    rows = [["warm caches (target 5 s)", spread(column(f["warm"], "wall")), spread(column(f["warm"], "cpu"))],
            ["cold caches", spread(column(f["cold"], "wall")), spread(column(f["cold"], "cpu"))]]
    stages = [[k, f"{v['wall']:.2f}", f"{v['cpu']:.2f}"] for k, v in f["stages_warm"].items() if isinstance(v, dict)]
    return ("## First image of the kitchen\n\nFrom process start to the written file, 1 sample a pixel, 640x360.\n\n" +
            table(["", "s, wall", "CPU-s"], rows) + "\nWhere it goes (warm, one run):\n\n" + table(["stage", "s, wall", "CPU-s"], stages))


# Renderer, then for cornell and room: M samples / CPU-s, relMSE x CPU-s at 16 spp.
PEERS = [("Mitsuba 3.9.1, llvm_ad_rgb, independent sampler", "1.25", "0.051", "0.14", "3.17"),
         ("Mitsuba 3.9.1, llvm_ad_rgb, multijitter", "1.24", "0.031", "0.136", "3.14"),
         ("Mitsuba 3.9.1, scalar_rgb", "0.41", "", "0.087", ""),
         ("Cycles (bpy 5.0.1), light tree off", "", "0.195", "", "4.57"),
         ("Cycles (bpy 5.0.1), light tree on", "0.23", "0.238", "0.07", "5.37"),
         ("pbrt-v4, independent sampler", "0.18", "0.65-0.85", "0.045", "15-16"),
         ("LuxCore 2.11.2", "0.13", "", "0.077", "")]
PEERS_TEXT = """
cornell and room by other renderers, for orientation. These were **not measured in this run**: once, at another time, on a machine of
the same kind (2 shared cores, AVX-512), medians of 3-4 runs that differ by +-30 % among themselves; their error is to a reference of
their own. Read a factor of two as a difference, not 20 %. relMSE is defined alike. pbrt-v4 is spectral and does more for a sample.

"""


def standard(f):
    rows = []
    for name, v in f.items():
        r = v["runs"]
        rows.append([name, spread(column(r, "msamples_cpu")), spread(column(r, "mrays_cpu")), spread(column(r, "rel_mse"), "{:.4f}"),
                     spread(column(r, "rel_mse_cpu_seconds"), "{:.3f}"), v["reference_samples"], f"{v['reference_noise']:.1e}"])
    return ("## Standard scenes\n\n512x512 at 16 samples a pixel, box filter; cornell (diffuse, 32 triangles) with 6 path edges, room (20 "
            "instances of 199,692 triangles; diffuse, GGX conductor, glass) with 8, room-flat the same with each of them a mesh of its own. relMSE: the squared error of a pixel (mean over channels) "
            "over the mean square of its reference + 0.01; the reference is a picture of our own in two halves, whose noise is known and "
            "subtracted.\n\n" +
            table(["scene", "M samples / CPU-s", "M rays / CPU-s", "relMSE", "relMSE x CPU-s", "reference spp", "its noise"], rows) + PEERS_TEXT +
            table(["renderer", "cornell: M samples / CPU-s", "relMSE x CPU-s", "room: M samples / CPU-s", "relMSE x CPU-s"], PEERS))


HOW = ("`restage bench SCENE... -o FOLDER` charts error against samples and CPU time: `index.html` needs no other file, `bench.json` has all figures. Rows of "
       "a file (`--rows`; the default is python/restage/bench/rows.txt) are configurations, NAME: OPTIONS of `restage render`. `--mitsuba PYTHON`, `--cycles "
       "PYTHON` (with the packages mitsuba or bpy) and `--pbrt BINARY` measure these renderers in the same run, on the same scene through our exporters. "
       "Same size and box filter for all; each renderer is measured against its own reference, whose noise is taken off, and the difference of "
       "the references is given; bands are ranges over at least 5 seeds. `--growth --budget SECONDS`: rays a second and memory against triangles, "
       "instances, lights, resolution and depth. `tools/bench --only chart` measures the bundled scenes, and those of RESTAGE_SCENES without pictures (`--mitsuba` and so on are passed on).\n\n")


def chart(f):
    scenes = "".join(f"![{name}: relMSE against CPU seconds](chart/{name}-rel_mse-cpu.svg)\n\n" for name in f["scenes"])
    rows = []
    for name, scene in f["scenes"].items():
        for c in scene["configurations"]:
            last, trimmed = c["curve"][-1], c["curve_trimmed"][-1]
            rows.append([f"{name}, {scene['width']}x{scene['height']}, {scene['seeds']} seeds", c["name"], last["samples"], f"{last['cpu']:.2f}", f"{last['error']:.2e} ({last['low']:.1e}–{last['high']:.1e})",
                         f"{trimmed['error']:.2e}", f"{trimmed['error'] * last['cpu']:.2e}"])
    return ("## Configurations and other renderers\n\n" + HOW + "The page: [chart/index.html](chart/index.html). "
            "*Trimmed* leaves out the thousandth of the pixels that differ most.\n\n" + scenes +
            table(["scene", "", "samples", "CPU-s", "relMSE", "trimmed", "trimmed x CPU-s"], rows))


def editor(f):
    rows = [[name, f"{r['median_ms']:.0f}", f"{r['p95_ms']:.0f}", len(r["pixels_ms"]), f"{r['denoised_s']:.2f}"] for name, r in f["rows"].items()]
    ui = f["ui_frame_ms"]
    return ("## The editor\n\nThe kitchen in a window of 1280x720, real mouse events under Xvfb, the window drawn by lavapipe too. From the "
            "start of the frame that handles an event to the picture of it on the screen, and from the last event to a denoised "
            "picture at half resolution or finer. Targets: 150 ms (median), 2 s.\n\n" +
            table(["while", "first changed pixel, ms, median", "95 %", "pictures", "denoised after, s"], rows) +
            f"\nFirst picture after process start: {f['first_image_s']:.1f} s; whole and denoised: {f['whole_denoised_s']:.1f} s. "
            f"Frames of the window while it renders: median {ui['median']:.0f} ms, 99 % {ui['p99']:.0f} ms (target 50 ms).\n")


SECTIONS = {"rays": rays, "edits": edits, "copies": copies, "actions": actions, "features": features, "needs": needs, "multiscatter": multiscatter, "first_image": first_image, "standard": standard, "chart": chart, "editor": editor}


def machine_line(m):
    return f"{m['cpu']}, {m['cores']} cores, {m['vector']}; {m['system']}; Mesa {m['mesa']}; Embree {m['embree']}; Restage {m['restage']}"


def measured_line(row, several_machines):
    """When a row was measured, of which commit, and how busy the machine was."""
    line = f"Measured {row['date']} at commit {row['commit']}; load average before it {row['load_before']:.1f}"
    if row["others_cpu"] is not None:
        line += f"; others used {100 * row['others_cpu']:.0f} % of the cores meanwhile"
    if several_machines:
        line += f"; on {machine_line(row['machine'])}"
    return line + ("; a quick run, not the full measurement.\n" if row["quick"] else ".\n")


def write(data, folder):
    machines = {machine_line(row["machine"]) for row in data["rows"].values()}
    text = ["# Measurements\n\nWritten by `make bench` (tests/bench/run.py) from bench.json; not by hand. Every figure is the median of its "
            "runs, with the smallest and largest; ratios are of runs in one process. CPU time counts all threads of the process, "
            "so it means something on a busy machine too. Each section says when and of which commit it was measured.\n\n" +
            (f"Machine: {next(iter(machines))}.\n" if len(machines) == 1 else "")]
    for name, section in SECTIONS.items():
        row = data["rows"].get(name)
        if row is None:
            text.append(f"## {name.replace('_', ' ')}\n\n{HOW if name == 'chart' else ''}Not measured in this file: `make bench` measures it (first image and editor need RESTAGE_SCENES).\n")
            continue
        text.append(section(row["figures"]) + "\n" + measured_line(row, len(machines) > 1))
    (folder / "README.md").write_text("\n".join(text))
