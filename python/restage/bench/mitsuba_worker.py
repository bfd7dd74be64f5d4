# SPDX-License-Identifier: Apache-2.0
"""Renders a Mitsuba scene with several sample counts and seeds in one process; run by the Python that has mitsuba, without
Restage. Prints one JSON line a picture."""
import argparse
import json
import pathlib
import resource
import time
import xml.etree.ElementTree as ET

import numpy as np
import mitsuba as mi


def cpu():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--jobs", nargs="+", help="SAMPLES:SEED")
    parser.add_argument("--sampler", default="independent")
    parser.add_argument("--variant", help="default: llvm_ad_rgb if LLVM is found, else scalar_rgb")
    args = parser.parse_args()
    try:
        mi.set_variant(args.variant or "llvm_ad_rgb")
    except Exception:  # no LLVM; which exception it is depends on the version
        if args.variant:
            raise
        mi.set_variant("scalar_rgb")
    mi.set_log_level(mi.LogLevel.Error)  # a warning's colours would begin the line of a result
    tree = ET.parse(args.scene)
    tree.getroot().find("sensor/sampler").set("type", args.sampler)
    changed = args.scene.with_name("bench.xml")
    tree.write(changed)
    scene = mi.load_file(str(changed))
    np.array(mi.render(scene, spp=4, seed=12345))  # compiles
    for job in args.jobs:
        samples, seed = map(int, job.split(":"))
        start, used = time.monotonic(), cpu()
        image = np.array(mi.render(scene, spp=samples, seed=seed), np.float32)[..., :3]
        used, wall = cpu() - used, time.monotonic() - start
        file = args.folder / f"{samples}-{seed}.pfm"
        file.write_bytes(f"PF\n{image.shape[1]} {image.shape[0]}\n-1\n".encode() + image[::-1].astype("<f4").tobytes())
        print(json.dumps({"samples": samples, "seed": seed, "cpu": used, "wall": wall, "file": str(file), "variant": mi.variant(),
                          "version": mi.__version__}), flush=True)


if __name__ == "__main__":
    main()
