# SPDX-License-Identifier: Apache-2.0
"""check: runs `restage check` on a plugin, from Python. The program runs the plugin in a separate process, so
that a crash or hang does not affect the caller."""
from __future__ import annotations

import dataclasses
import json
import os
import subprocess

from . import _core


@dataclasses.dataclass(frozen=True)
class CheckStep:
    """One step of a check."""

    step: str
    "Its name: chi-square, energy, ..."
    of: str
    "The material, exporter, ... of the plugin; \"\" = the plugin itself."
    verdict: str
    "pass, fail or skipped."
    text: str
    "What is wrong and where, or why it was skipped."
    cause: str
    "For a failure: its usual cause."
    figures: dict[str, float | None]
    "What was measured."
    seconds: float
    "How long it took."


@dataclasses.dataclass(frozen=True)
class CheckReport:
    """The result of a check; true if everything passed."""

    id: str
    kind: str
    version: str
    folder: str
    passed: bool
    seed: int
    "Replays it: check(plugin, seed=report.seed)."
    seconds: float
    steps: list[CheckStep]

    @property
    def failures(self) -> list[CheckStep]:
        """The steps that failed."""
        return [s for s in self.steps if s.verdict == "fail"]

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        lines = [f"{self.id}: {'passed' if self.passed else 'FAILED'} (seed {self.seed}, {self.seconds:.1f} s)"]
        lines += [f"  {s.verdict:8} {s.step}: {s.text}" for s in self.steps]
        return "\n".join(lines)


def check(plugin: str | os.PathLike | _core.Plugin, *, quick: bool = False, only: str | None = None,
          seed: int | None = None, time_limit: float | None = None) -> CheckReport:
    """Tests whether a plugin meets its contract. plugin: a folder with a plugin.json, an id, something a plugin provides
    ("dielectric"), or one of plugins(). quick: seconds instead of up to a minute. only: one step. time_limit: longest time
    without a response from the plugin [s]. Raises Error if there is nothing to check."""
    from . import _program

    if not isinstance(plugin, (_core.Plugin, str, os.PathLike)):
        raise TypeError(f'check(): "plugin" must be a path, an id or a Plugin, not {plugin!r}')
    name = str(plugin.folder) if isinstance(plugin, _core.Plugin) else os.fspath(plugin)
    command = [str(_program()), "check", name, "--json", "-"]
    command += ["--quick"] if quick else []
    for option, value in (("--only", only), ("--seed", seed), ("--time-limit", time_limit)):
        command += [option, str(value)] if value is not None else []
    done = subprocess.run(command, capture_output=True, text=True)
    try:
        reports = json.loads(done.stdout)
    except json.JSONDecodeError:
        reports = []
    if not reports:
        message = done.stderr.strip().removeprefix("restage: ").removeprefix("error: ")
        raise _core.Error(message or f"restage check ended with code {done.returncode} and no message")
    r = reports[0]
    steps = [CheckStep(s["step"], s["of"], s["verdict"], s["text"], s["cause"],
                       {f["name"]: f["value"] for f in s["figures"]}, s["seconds"]) for s in r["steps"]]
    return CheckReport(r["id"], r["kind"], r["version"], r["folder"], r["verdict"] == "pass", r["seed"], r["seconds"],
                       steps)
