# SPDX-License-Identifier: Apache-2.0
"""Rendering through the package: arrays, targets, the GIL, cancellation, denoising, merging, and the program's picture."""
import json
import os
import pickle
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import restage


def read_pfm(path):
    with open(path, "rb") as f:
        channels = {b"PF": 3, b"Pf": 1}[f.readline().strip()]
        width, height = map(int, f.readline().split())
        scale = float(f.readline())
        data = np.frombuffer(f.read(), "<f4" if scale < 0 else ">f4")
    return data.reshape(height, width, channels)[::-1]


def test_arrays_have_the_documented_shapes(cornell):
    p = cornell.render(size=(48, 32), samples=4, seed=3)
    assert p.size == (48, 32) and p.samples == 4 and p.seed == 3 and p.finished and p.seconds > 0
    for name in ("color", "std_error", "albedo", "normal"):
        a = getattr(p, name)
        assert a.shape == (32, 48, 3) and a.dtype == np.float32 and np.isfinite(a).all(), name
    assert p.depth.shape == (32, 48) and p.depth.dtype == np.float32
    assert p.object_id.shape == p.material_id.shape == (32, 48) and p.object_id.dtype == np.uint32
    assert p.color.mean() > 0.01 and (p.std_error > 0).any() and 0 < p.relative_error < 10
    assert (0 <= p.albedo).all() and (p.albedo <= 1.001).all()
    hit = p.depth > 0
    # Depth is a mean; ids are of the first sample, which may miss at an edge.
    assert hit.mean() > 0.5 and (p.object_id[hit] > 0).mean() > 0.9 and (hit[p.object_id > 0]).all()
    assert p.denoised is None and p.not_finite == {}
    assert "48x32" in repr(p)


def test_masks_are_what_ids_say(cornell):
    p = cornell.render(size=(64, 64), samples=2)
    seen = 0
    for thing in cornell.objects:
        mask = p.mask(thing)
        assert mask.dtype == bool and np.array_equal(mask, p.object_id == thing.id)
        seen += mask.sum()
    assert seen == (p.object_id > 0).sum()
    for material in cornell.materials:
        assert np.array_equal(p.mask(material), p.material_id == material.id)
    both = cornell.select(cornell.objects[0], cornell.objects[1])
    assert np.array_equal(p.mask(both), p.mask(cornell.objects[0]) | p.mask(cornell.objects[1]))
    # A hidden object has no pixels, and objects behind it have more.
    visible = max(cornell.objects, key=lambda o: p.mask(o).sum())
    visible.hidden = True
    assert not cornell.render(size=(64, 64), samples=2).mask(visible).any()
    with pytest.raises(TypeError):
        p.mask("wall")


def test_a_seed_repeats_and_an_edit_shows(cornell):
    a = cornell.render(size=(32, 32), samples=4, seed=7).color.copy()
    assert np.array_equal(a, cornell.render(size=(32, 32), samples=4, seed=7).color)
    assert not np.array_equal(a, cornell.render(size=(32, 32), samples=4, seed=8).color)
    cornell.set_sky(color=(5, 0, 0))
    cornell.objects[0].hidden = True
    assert not np.allclose(a, cornell.render(size=(32, 32), samples=4, seed=7).color)
    cornell.undo(), cornell.undo()
    assert np.array_equal(a, cornell.render(size=(32, 32), samples=4, seed=7).color), "undo gives the identical picture"
    assert cornell.render(size=(32, 32), samples=1).size == (32, 32) and cornell.size != (32, 32), "size is not an edit"
    assert not np.allclose(a, cornell.render(size=(32, 32), samples=4, seed=7, max_depth=0).color)


def test_the_program_renders_the_same_picture(cornell, scenes, program, tmp_path):
    out = tmp_path / "program.pfm"
    subprocess.run([program, "render", scenes / "cornell/cornell.pbrt", "-o", out, "--size", "64x48", "--spp", "8",
                    "--seed", "5"], check=True, capture_output=True, timeout=120)
    mine = cornell.render(size=(64, 48), samples=8, seed=5)
    assert np.allclose(read_pfm(out), mine.color, rtol=1e-5, atol=1e-6)
    mine.save(tmp_path / "mine.pfm")
    assert np.array_equal(read_pfm(tmp_path / "mine.pfm"), mine.color)


def test_a_reference_has_no_limits_of_the_scene(scenes, tmp_path):
    (tmp_path / "dim.restage").write_text(json.dumps({"restage": 1, "base": {"file": str(scenes / "cornell/cornell.pbrt")}, "settings": {"clamp_indirect": 0.001}}))
    dim = restage.open(tmp_path / "dim.restage")
    limited, whole = (dim.render(size=(16, 16), samples=4, reference=r).color.mean() for r in (False, True))
    assert limited < 0.95 * whole


def test_adaptive_sampling_keeps_the_mean(cornell):
    plain, adaptive = (cornell.render(size=(32, 32), samples=48, adaptive=a) for a in (False, True))
    assert adaptive.samples == plain.samples == 48
    assert not np.array_equal(adaptive.color, plain.color)
    assert adaptive.color.mean() == pytest.approx(plain.color.mean(), rel=0.02)
    part = cornell.render(size=(32, 32), samples=48, adaptive=True, first_sample=48)  # not adaptive: to be merged
    assert np.array_equal(part.color, cornell.render(size=(32, 32), samples=48, first_sample=48).color)


def test_caustics_are_found_where_paths_cannot(tmp_path):
    (tmp_path / "s.pbrt").write_text("""LookAt 0 -3 0.3  0 0 0  0 0 1
Camera "perspective" "float fov" 30
WorldBegin
LightSource "point" "point3 from" [0 0 3] "rgb I" [20 20 20]
Material "diffuse"
Shape "disk" "float radius" 2
Material "dielectric"
Translate 0 0 1
Shape "disk" "float radius" 4
Translate 0 0 0.1
Shape "disk" "float radius" 4
""")
    with restage.open(tmp_path / "s.pbrt") as scene:
        by_paths = scene.render(size=(24, 24), samples=8, caustics="off").color.mean()
        found = scene.render(size=(24, 24), samples=8).color.mean()
        reference = scene.render(size=(24, 24), samples=8, reference=True).color.mean()
        with pytest.raises(restage.Error, match="caustics: 'yes' is none of auto, on and off"):
            scene.render(size=(24, 24), samples=8, caustics="yes")
    assert by_paths == reference < 0.01 * found


def test_exposure_scales_colour_and_error_alike(cornell):
    plain = cornell.render(size=(16, 16), samples=4)
    cornell.exposure = 4.0
    bright = cornell.render(size=(16, 16), samples=4)
    assert np.allclose(bright.color, 4 * plain.color) and np.allclose(bright.std_error, 4 * plain.std_error)
    assert np.array_equal(bright.albedo, plain.albedo)


def test_other_threads_run_while_one_renders(cornell):
    """If render() held the GIL, the counter would stand still."""
    cornell.render(size=(32, 32), samples=1)  # shaders are compiled
    stop, count = threading.Event(), [0]

    def tick():
        while not stop.is_set():
            count[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    before, start = count[0], time.perf_counter()
    cornell.render(size=(128, 128), seconds=1.0)
    ticks, took = count[0] - before, time.perf_counter() - start
    stop.set()
    thread.join()
    assert ticks > 50 * took, (ticks, took)


def test_another_thread_may_edit_while_one_renders(cornell):
    result = []
    thread = threading.Thread(target=lambda: result.append(cornell.render(size=(64, 64), seconds=0.7)))
    thread.start()
    for i in range(20):
        cornell.objects[0].move((0.001, 0, 0))
        time.sleep(0.01)
    second = cornell.render(size=(32, 32), samples=2)  # waits for its turn
    thread.join()
    assert result[0].finished and result[0].samples > 0 and second.samples == 2
    assert len(cornell.history) == 20


def test_progress_is_reported_and_false_stops(cornell):
    told = []
    p = cornell.render(size=(64, 64), seconds=0.6, progress=lambda at: told.append((at.fraction, at.samples)))
    assert p.finished and len(told) >= 3 and told == sorted(told) and 0 <= told[0][0] <= told[-1][0] <= 1
    start = time.perf_counter()
    p = cornell.render(size=(64, 64), samples=1000000, progress=lambda at: at.samples < 3)
    assert not p.finished and 3 <= p.samples < 1000000 and time.perf_counter() - start < 20
    assert np.isfinite(p.color).all() and p.color.mean() > 0.01

    def fails(at):
        raise ZeroDivisionError("mine")
    with pytest.raises(ZeroDivisionError, match="mine"):
        cornell.render(size=(64, 64), seconds=30, progress=fails)
    with pytest.raises(restage.Error, match="its progress callback cannot"):
        cornell.render(size=(64, 64), seconds=30, progress=lambda at: cornell.render(size=(8, 8), samples=1))
    assert cornell.render(size=(16, 16), samples=1).finished, "and it still works"


@pytest.fixture
def interruptible():
    """Background jobs of a script ignore Ctrl-C, and so do their children."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_ctrl_c_is_a_keyboard_interrupt_at_once(cornell):
    cornell.render(size=(128, 128), samples=1)
    asked = []

    def interrupt():
        asked.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)
    timer = threading.Timer(0.5, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        cornell.render(size=(128, 128), seconds=60)
    took = time.perf_counter() - asked[0]
    timer.join()
    assert took < 1.0, f"{took:.2f} s until Ctrl-C took effect"
    assert cornell.render(size=(16, 16), samples=1).finished


def test_an_emitting_material_lights_the_scene_and_comes_back_from_pbrt(cornell, tmp_path):
    def brightness(session):
        return float(session.render(size=(32, 32), samples=16, denoise=False).color.mean())

    before = brightness(cornell)
    thing = next(o for o in cornell.objects if o.emission is None)
    thing.material.type = "emissive"
    thing.material["scale"] = 20
    after = brightness(cornell)
    assert after > 1.5 * before and thing.emission is None, "the light is the material's"
    cornell.export(tmp_path / "lit.pbrt")
    with restage.open(tmp_path / "lit.pbrt") as again:
        assert again.objects[thing.name].material.type == "emissive" and again.objects[thing.name].emission is None
        assert brightness(again) == pytest.approx(after, rel=1e-3)
    while cornell.undo():
        pass
    assert brightness(cornell) == pytest.approx(before, rel=1e-3)


def test_targets(cornell):
    start = time.perf_counter()
    p = cornell.render(size=(32, 32), seconds=0.5)
    assert p.samples >= 1 and time.perf_counter() - start < 5
    p = cornell.render(size=(32, 32), error=0.5)
    assert p.samples >= 8 and p.relative_error <= 0.5
    cornell.samples = 3
    assert cornell.render(size=(8, 8)).samples == 3
    for wrong in ({"samples": 1, "seconds": 1}, {"samples": 0}, {"error": -1}, {"size": (0, 4)}):
        with pytest.raises(restage.Error, match="render:"):
            cornell.render(**wrong)
    with pytest.raises(restage.Error, match="no tracer"):
        cornell.render(size=(8, 8), samples=1, tracer="abacus")
    with pytest.raises(restage.Error, match="no such device"):
        cornell.render(size=(8, 8), samples=1, device="no such device")


def test_parts_of_a_seed_merge_into_the_whole(cornell):
    whole = cornell.render(size=(32, 32), samples=12, seed=4)
    parts = [cornell.render(size=(32, 32), samples=n, seed=4, first_sample=at) for at, n in ((0, 5), (5, 3), (8, 4))]
    parts = [pickle.loads(pickle.dumps(p)) for p in parts]  # as other processes send them
    merged = restage.merge(parts[::-1])
    assert merged.samples == 12 and merged.first_sample == 0 and merged.finished
    assert np.allclose(merged.color, whole.color, rtol=1e-5, atol=1e-6)
    # The film keeps sums of squares as floats: where all samples are alike, as on a lamp, their difference is rounding.
    errors = np.abs(merged.std_error.astype(float)**2 - whole.std_error.astype(float)**2)
    assert (errors <= 1e-3 * whole.std_error**2 + 1e-6 * whole.color**2).all()
    for name in ("albedo", "normal", "depth"):
        assert np.allclose(getattr(merged, name), getattr(whole, name), rtol=1e-5, atol=1e-5), name
    assert np.array_equal(merged.object_id, whole.object_id) and np.array_equal(merged.material_id, whole.material_id)
    assert not np.allclose(parts[0].color, whole.color)
    with pytest.raises(restage.Error, match="different sizes"):
        restage.merge([parts[0], cornell.render(size=(16, 16), samples=1)])
    with pytest.raises(restage.Error, match="no pictures"):
        restage.merge([])


def test_denoising_and_saving(cornell, tmp_path):
    noisy = cornell.render(size=(64, 64), samples=4, denoise="fast")
    clean = cornell.render(size=(64, 64), samples=256)
    assert noisy.denoised.shape == (64, 64, 3)
    def error(a):  # without the lamp: it outshines the rest, and is noise-free except at its edges
        return np.sqrt(np.mean((np.clip(a, 0, 1) - np.clip(clean.color, 0, 1)) ** 2))
    assert error(noisy.denoised) < 0.5 * error(noisy.color)
    assert clean.denoise("high") is clean and clean.denoised is not None
    for name in ("a.exr", "a.png", "a.hdr", "a.pfm"):
        noisy.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 1000
    assert np.array_equal(read_pfm(tmp_path / "a.pfm"), noisy.denoised)
    with pytest.raises(restage.Error, match=".exr, .png"):
        noisy.save(tmp_path / "a.jpeg2000")
    with pytest.raises(restage.Error, match="no folder"):
        noisy.save(tmp_path / "no/a.png")
    with pytest.raises(restage.Error, match="fast, balanced, high"):
        noisy.denoise("best")


def test_arrays_outlive_the_session(scenes):
    with restage.open(scenes / "cornell/cornell.pbrt") as session:
        color = session.render(size=(16, 16), samples=1).color
    assert color.mean() > 0


def test_a_scene_without_a_camera_is_refused(scenes, tmp_path):
    (tmp_path / "bare.restage").write_text('{"restage": 1}')
    with restage.open(tmp_path / "bare.restage") as session:
        assert session.camera is None
        with pytest.raises(restage.Error, match="no camera"):
            session.render(size=(8, 8), samples=1)


def test_a_denoiser_by_name_and_unknown_layers(cornell, tmp_path):
    picture = cornell.render(size=(16, 16), samples=2, denoise="fast", denoiser="oidn")
    assert picture.denoiser == "oidn fast" and cornell.render(size=(8, 8), samples=1).denoiser == "none"
    picture.save(tmp_path / "a.exr")
    assert b"oidn fast" in (tmp_path / "a.exr").read_bytes()
    with pytest.raises(restage.Error, match='there is no denoiser "nosuch"; there are'):
        cornell.render(size=(8, 8), samples=1, denoise=True, denoiser="nosuch")
    with pytest.raises(restage.Error, match="there is no layer"):
        picture.save(tmp_path / "b.exr", aovs="depth,foo")
