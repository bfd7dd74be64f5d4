# SPDX-License-Identifier: Apache-2.0
"""What the figures were measured on."""
import os
import pathlib
import platform
import re
import subprocess


def first(text, pattern, default="unknown"):
    found = re.search(pattern, text, re.MULTILINE)
    return found.group(1).strip() if found else default


def output(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True).stdout
    except OSError:
        return ""


def describe(restage):
    cpuinfo = pathlib.Path("/proc/cpuinfo").read_text()
    widest = next((f for f in ("avx512f", "avx2", "avx", "sse4_2") if re.search(rf"\b{f}\b", cpuinfo)), "unknown")
    release = pathlib.Path("/etc/os-release")
    return {
        "cpu": first(cpuinfo, r"^model name\s*:\s*(.*)"),
        "vector": widest,
        "cores": len(os.sched_getaffinity(0)),
        "system": first(release.read_text(), r'^PRETTY_NAME="?([^"\n]*)') if release.exists() else platform.platform(),
        "mesa": first(output("dpkg-query", "-W", "-f", "${Version}", "mesa-vulkan-drivers"), r"(\S+)"),
        "embree": first(output("sh", "-c", "dpkg-query -W -f '${Version}\\n' 'libembree*' 2>/dev/null"), r"(\S+)"),
        "restage": first(output(str(restage), "--version"), r"restage (\S+)"),
        "commit": first(output("git", "-C", str(pathlib.Path(__file__).parent), "rev-parse", "--short", "HEAD"), r"(\S+)"),
    }
