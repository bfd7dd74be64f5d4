# SPDX-License-Identifier: Apache-2.0
"""Options of importers: restage.open(path, options={...}), Session.insert, and projects that keep them."""
import json

import numpy as np
import pytest

import restage

OBJ = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\no a\nf 1 3 2\no b\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "t.obj"
    path.write_text(OBJ)
    return path


def test_a_file_is_read_with_them(model):
    with restage.open(model) as plain, restage.open(model, options={"units": "mm", "up": "z", "merge": True}) as session:
        assert len(plain.objects) == 2 and len(session.objects) == 1
        lower, upper = plain.bounds
        assert np.allclose(upper, (1, 2, 3)) and np.allclose(lower, 0)
        lower, upper = session.bounds
        assert np.allclose(lower, (0, 0, -0.002)) and np.allclose(upper, (0.001, 0.003, 0))
    with restage.open(model, options={}) as session:
        assert len(session.objects) == 2


@pytest.mark.parametrize("options, says", [
    ({"height": 2}, 'importer "obj": there is no option "height"; known: units=as_is|mm'),
    ({"up": "x"}, 'option "up" cannot be "x"; as_is|y|z are possible'),
    ({"merge": 1}, 'option "merge" cannot be 1; known: units=as_is|mm|cm|m|in|ft, up=as_is|y|z, merge=true|false'),
    ({"merge": "true"}, 'option "merge" cannot be true; known: units='),
    ({"units": True}, 'option "units" cannot be true; known: units='),
    ({"units": None}, 'option "units": a value is text, a number, True or False, not None'),
])
def test_what_it_does_not_have_is_refused(model, options, says):
    with pytest.raises(restage.Error) as wrong:
        restage.open(model, options=options)
    assert says in str(wrong.value)
    with restage.new() as session:
        before = session.history
        with pytest.raises(restage.Error) as wrong:
            session.insert(model, options=options)
        assert says in str(wrong.value) and session.history == before


def test_an_importer_without_options_says_so(scenes):
    with pytest.raises(restage.Error, match='importer "pbrt": there is no option "up"; it has no options'):
        restage.open(scenes / "cornell/cornell.pbrt", options={"up": "z"})
    with pytest.raises(TypeError):
        restage.open(scenes / "cornell/cornell.pbrt", options=["up=z"])


def test_a_project_keeps_them_and_takes_others(model, tmp_path):
    project = tmp_path / "p.restage"
    with restage.open(model, options={"merge": True, "units": "cm"}) as session:
        session.save(project)
    assert list(json.loads(project.read_text())["base"]["options"]) == ["merge", "units"]
    with restage.open(project) as session:
        assert len(session.objects) == 1 and not session.modified
    with restage.open(project, options={"units": "m"}) as session:  # instead of both
        assert len(session.objects) == 2 and session.modified
        assert np.allclose(session.bounds[1], (1, 2, 3))


def test_inserted_files_keep_theirs(model, tmp_path):
    project = tmp_path / "p.restage"
    with restage.new() as session:
        merged = session.insert(model, options={"merge": True, "units": "cm"})
        assert isinstance(merged, restage.Object) and np.allclose(np.ptp(merged.bounds, axis=0), (0.01, 0.02, 0.03))
        assert len(session.insert(model).objects) == 2
        session.save(project)
        transforms = [o.transform for o in session.objects]
    with restage.open(project) as session:
        assert session.report.dropped == 0
        assert np.array_equal([o.transform for o in session.objects], transforms)
        assert {o.triangle_count for o in session.objects} >= {1, 3, 4}, "a, b, and both in one"
