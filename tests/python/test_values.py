# SPDX-License-Identifier: Apache-2.0
"""Values that cannot be rendered are refused with a message by every setter, and the session continues."""
import math
import os
import subprocess
import sys
import textwrap

import pytest

import restage

NAN, INF = math.nan, math.inf


def setters():
    yield "fov", [NAN, INF, 0, -30, 180, 400], lambda s, x: setattr(s.camera, "fov", x)
    yield "lens_radius", [NAN, INF, -1], lambda s, x: setattr(s.camera, "lens_radius", x)
    yield "focal_distance", [NAN, INF, 0, -1], lambda s, x: setattr(s.camera, "focal_distance", x)
    yield "position", [NAN, INF, 1e300], lambda s, x: setattr(s.camera, "position", (0, x, 0))
    yield "look_at", [NAN, INF], lambda s, x: s.camera.look_at((0, x, 0))
    yield "exposure", [NAN, INF, 0, -1], lambda s, x: setattr(s, "exposure", x)
    yield "size", [0, 70000], lambda s, x: setattr(s, "size", (x, 10))
    yield "emission", [NAN, INF, -1, 1e300], lambda s, x: setattr(s.objects[0], "emission", (1, x, 1))
    yield "object position", [NAN, INF, 1e300], lambda s, x: s.objects[0].move((x, 0, 0))
    yield "scale", [NAN, INF, 0, 1e300], lambda s, x: s.objects[0].scale(x)
    yield "rotate", [NAN, INF], lambda s, x: s.objects[0].rotate(x)
    yield "duplicate", [NAN, INF], lambda s, x: s.objects[0].duplicate(by=(x, 0, 0))
    yield "mirror", [NAN, INF], lambda s, x: s.objects[0].mirror("x", at=x)
    yield "array", [NAN, INF], lambda s, x: s.objects[0].array(3, by=(x, 0, 0))
    yield "array_around", [NAN, INF], lambda s, x: s.objects[0].array_around(3, center=(0, 0, 0), degrees=x)
    yield "transform", [NAN, INF], lambda s, x: setattr(s.objects[0], "transform", [[x, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    yield "light", [NAN, INF, -1], lambda s, x: s.add_light("point", (x, 1, 1))
    yield "sky", [NAN, INF, -1], lambda s, x: s.set_sky(color=(1, 1, x))
    yield "sky strength", [NAN, INF, -1], lambda s, x: s.set_sky(color=(1, 1, 1), strength=x)
    yield "sky rotation", [NAN, INF], lambda s, x: s.set_sky(color=(1, 1, 1), rotation=x)
    yield "parameter", [NAN, INF, -1, 2], lambda s, x: s.materials[0].__setitem__("reflectance", (x, 0.5, 0.5))


def test_unrenderable_values_are_refused(cornell):
    light = cornell.add_light("spot", name="spot")
    before = cornell.render(size=(16, 16), samples=1).color.copy()
    steps = cornell.history
    for name, bad, set_it in setters():
        for x in bad:
            with pytest.raises(restage.Error) as refused:
                set_it(cornell, x)
            assert len(str(refused.value)) > 15, name
            assert cornell.history == steps, f"{name} = {x}: nothing changed"
    for x in (NAN, INF, -1, 0, 200):
        with pytest.raises(restage.Error):
            light.cone_angle = x
    with pytest.raises(restage.Error, match="field of view of nan degrees; it must be between 0 and 180"):
        cornell.camera.fov = NAN
    with pytest.raises(restage.Error, match="exposure"):
        cornell.render(size=(8, 8), samples=1).save(os.devnull + ".png", exposure=NAN)
    assert (cornell.render(size=(16, 16), samples=1).color == before).all()


def test_absurd_but_finite_scenes_render(cornell):
    """Lengths from 1e-12 to 1e12: no Embree assertion is reached, and the picture is valid."""
    import numpy as np

    for change in (lambda: cornell.objects[0].scale(1e-12), lambda: cornell.objects[1].scale(1e12),
                   lambda: cornell.objects[0].move((1e16, 0, 0)), lambda: setattr(cornell.camera, "position", (0, 1e16, 0)),
                   lambda: setattr(cornell.camera, "lens_radius", 1e16), lambda: setattr(cornell.camera, "fov", 179.99),
                   lambda: setattr(cornell.camera, "fov", 1e-30),
                   lambda: cornell.objects[2].scale((1, 1e-9, 1)),
                   lambda: setattr(cornell.objects[0], "emission", (1e17, 1e17, 1e17))):
        change()
        assert np.isfinite(cornell.render(size=(16, 16), samples=2).color).all()
        cornell.undo()


FORKED = """
    import os, sys
    sys.path.insert(0, {packages!r})
    import restage
    session = restage.open({scene!r})
    picture = session.render(size=(16, 16), samples=1)
    {extra}
    child = os.fork()
    if child == 0:
        try:
            {work}
        except restage.Error as error:
            print(error, flush=True)
            session.close()
            sys.exit(7)
        sys.exit(1)
    _, status = os.waitpid(child, 0)
    picture.denoise("fast")
    session.render(size=(16, 16), samples=1)
    sys.exit(os.waitstatus_to_exitcode(status))
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork() here")
@pytest.mark.parametrize("extra, work", [
    ("picture.denoise('fast')", "picture.denoise('fast')"),
    ("picture.denoise('fast')", "session.render(size=(16, 16), samples=1)"),
    ("lab = restage.Bsdf('diffuse')", "lab.pdf((0, 0, 1), (0, 0, 1))"),
])
def test_a_fork_of_a_process_that_rendered_is_refused(extra, work, scenes):
    script = textwrap.dedent(FORKED).format(packages=str(restage.__path__[0].rsplit("/", 1)[0]), extra=extra, work=work,
                                            scene=str(scenes / "cornell/cornell.pbrt"))
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=300)
    assert done.returncode == 7, done.stdout + done.stderr
    assert "fork()" in done.stdout and "spawn" in done.stdout


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork() here")
def test_a_fork_before_the_first_render_works(scenes):
    script = textwrap.dedent(f"""
        import os, sys
        sys.path.insert(0, {str(restage.__path__[0].rsplit("/", 1)[0])!r})
        import restage
        session = restage.open({str(scenes / "cornell/cornell.pbrt")!r})
        child = os.fork()
        picture = session.render(size=(8, 8), samples=1)
        if child == 0:
            sys.exit(5 if picture.finished else 1)
        sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    """)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=300)
    assert done.returncode == 5, done.stdout + done.stderr
