# SPDX-License-Identifier: Apache-2.0
"""`pip install .`: a wheel is built and works in a fresh environment outside the clone. No network: the build backend is
that of this Python's environment, and the objects of the build under test come from the compiler cache."""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]

SCRIPT = """
import pathlib, restage
here = pathlib.Path(restage.__file__).parent
assert "site-packages" in str(here), here
assert all(p.loaded and pathlib.Path(p.folder).is_relative_to(here) for p in restage.plugins()), restage.plugins()
with restage.open(restage.bundled_scene("cornell")) as session:
    p = session.render(size=(32, 32), samples=8, seed=5, denoise="fast")
print(len(restage.plugins()), float(p.color.mean()), p.denoised.shape)
"""


def run(*command, **kwargs):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, **kwargs)
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return done.stdout


@pytest.mark.skipif(importlib.util.find_spec("scikit_build_core") is None,
                    reason="scikit-build-core is not in this environment: pip install scikit-build-core")
@pytest.mark.skipif(shutil.which("ccache") is None, reason="without ccache this would recompile everything")
def test_a_wheel_works_in_a_fresh_environment(cornell, program, tmp_path):
    cache = (program.parents[1] / "CMakeCache.txt").read_text()
    def of_build(name):
        return re.search(rf"^{name}:\w+=(.*)$", cache, re.M).group(1)
    environment = {**os.environ, "CCACHE_BASEDIR": str(ROOT), "CCACHE_NOHASHDIR": "1", "CMAKE_BUILD_PARALLEL_LEVEL": "2",
                   "CC": of_build("CMAKE_C_COMPILER"), "CXX": of_build("CMAKE_CXX_COMPILER"),
                   "PATH": str(pathlib.Path(sys.executable).parent) + os.pathsep + os.environ["PATH"]}
    run(sys.executable, "-m", "pip", "--disable-pip-version-check", "wheel", ROOT, "--no-build-isolation", "--no-deps",
        "--wheel-dir", tmp_path,
        # The same objects as those of the build under test, so that they come from the cache.
        "--config-settings", f"build-dir={ROOT}/build/wheel", "--config-settings", f"cmake.build-type={of_build('CMAKE_BUILD_TYPE')}",
        "--config-settings", f"cmake.define.RESTAGE_WERROR={of_build('RESTAGE_WERROR')}", env=environment)
    wheel, = tmp_path.glob("restage-*.whl")

    run(sys.executable, "-m", "venv", tmp_path / "venv")
    python = tmp_path / "venv/bin/python"
    run(python, "-m", "pip", "--disable-pip-version-check", "install", "--no-index", "--no-deps", wheel)
    # numpy, without a download: that of this environment, found last.
    import numpy
    site = next((tmp_path / "venv/lib").glob("python*/site-packages"))
    (site / "numpy.pth").write_text(str(pathlib.Path(numpy.__file__).parents[1]))

    environment = {k: v for k, v in os.environ.items() if not k.startswith(("RESTAGE_", "PYTHONPATH"))}
    plugins, mean, shape = run(python, "-c", SCRIPT, env=environment, cwd=tmp_path).split(maxsplit=2)
    assert int(plugins) > 15 and shape.strip() == "(32, 32, 3)"
    assert float(mean) == pytest.approx(float(cornell.render(size=(32, 32), samples=8, seed=5).color.mean()), rel=1e-5)
    said = run(tmp_path / "venv/bin/restage", "--version", env=environment).split()
    assert said[0] == "restage" and wheel.name.startswith(f"restage-{said[1]}-")
    assert run(python, "-c", "import restage; print(restage.__version__)", env=environment, cwd=tmp_path).strip() == said[1]
    assert "material diffuse" in run(python, "-m", "restage", "plugins", env=environment)
