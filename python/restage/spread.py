# SPDX-License-Identifier: Apache-2.0
"""Renders spread over the workers of Ray (`pip install restage[ray]`): parts of one picture, or many pictures.

    picture = restage.spread.render("room.pbrt", samples=1024, parts=16, size=(640, 360))
    for index, result in restage.spread.each(make_frame, range(500)): ...

A task whose worker is lost (by a crash or a lost machine) is repeated by another. Call ray.init() first to configure
the workers; by default they are this machine's cores.
"""
from __future__ import annotations

import collections.abc
import os
import typing

from . import _core

T = typing.TypeVar("T")


def _ray():
    try:
        import ray
    except ImportError:
        raise _core.Error("Ray is not installed: pip install 'restage[ray]', or pip install ray") from None
    if not ray.is_initialized():
        # Workers import restage from the same place as this process.
        package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        paths = os.environ.get("PYTHONPATH", "")
        if package not in paths.split(os.pathsep):
            os.environ["PYTHONPATH"] = package + (os.pathsep + paths if paths else "")
        ray.init(include_dashboard=False, log_to_driver=False)
    return ray


def split(samples: int, parts: int) -> list[tuple[int, int]]:
    """(first sample, count) of each part; counts differ by at most one."""
    parts = max(1, min(parts, samples))
    bounds = [samples * i // parts for i in range(parts + 1)]
    return [(a, b - a) for a, b in zip(bounds, bounds[1:])]


def _part(scene, edit, options, first, count):
    from . import open

    with open(scene) as session:
        if edit is not None:
            edit(session)
        return session.render(samples=count, first_sample=first, **options)


def render(scene: str | os.PathLike, *, samples: int, parts: int, edit: collections.abc.Callable | None = None,
           threads: int = 1, retries: int = 3, **options) -> _core.Picture:
    """One picture, its samples split into `parts` tasks; equal to Session.render with that seed up to rounding.
    edit(session): called in each task before rendering. threads: per task; options: those of Session.render;
    denoise applies to the returned picture."""
    ray = _ray()
    task = ray.remote(num_cpus=threads, max_retries=retries)(_part)
    options["threads"] = threads
    path = os.path.abspath(scene)
    return _core.merge(ray.get([task.remote(path, edit, options, *part) for part in split(samples, parts)]))


def each(function: collections.abc.Callable[[typing.Any], T], items: collections.abc.Iterable, *, threads: int = 1,
         retries: int = 3) -> collections.abc.Iterator[tuple[typing.Any, T]]:
    """Yields (item, function(item)) for every item as it completes. An exception in the function ends it; a lost worker
    does not. The function itself must limit its rendering to `threads` threads."""
    ray = _ray()
    task = ray.remote(num_cpus=threads, max_retries=retries)(function)
    waiting = {task.remote(item): item for item in items}
    while waiting:
        (done,), _ = ray.wait(list(waiting), num_returns=1)
        yield waiting.pop(done), ray.get(done)
