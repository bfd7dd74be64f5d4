# SPDX-License-Identifier: Apache-2.0
"""The machine of the measurements."""
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
    }


def commit():
    """The commit of the checkout, with "+" if tracked files differ from it; earlier measurements do not count as changes."""
    git = ["git", "-C", str(pathlib.Path(__file__).parents[2])]
    changed = output(*git, "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/bench").strip()
    return first(output(*git, "rev-parse", "--short", "HEAD"), r"(\S+)") + ("+" if changed else "")


class Watch:
    """The load of the machine by other processes: [with] Watch() as w: ...; then w.load_before and w.others_cpu, the share of all
    cores that went to processes which are not our children."""

    def __enter__(self):
        self.load_before = round(os.getloadavg()[0], 1)
        self.start = self.now()
        return self

    def __exit__(self, *_):
        wall, busy, ours = (b - a for a, b in zip(self.start, self.now()))
        self.others_cpu = round(max(0, (busy - ours) / max(wall, 1e-6)), 3)

    @staticmethod
    def now():
        """Seconds of all cores together: passed, busy (stolen by the host as well), used by this process and its children."""
        jiffies = [int(x) for x in pathlib.Path("/proc/stat").read_text().split("\n")[0].split()[1:9]]
        tick, times = os.sysconf("SC_CLK_TCK"), os.times()
        idle = jiffies[3] + jiffies[4]
        return sum(jiffies) / tick, (sum(jiffies) - idle) / tick, sum(times[:4])
