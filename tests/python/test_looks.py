# SPDX-License-Identifier: Apache-2.0
"""Looks through the package: recorded, gone to, saved, undone."""
import pytest

import restage


def test_looks_are_recorded_and_gone_to(cornell, tmp_path):
    wall = next(m for m in cornell.materials if "reflectance" in m)
    before = tuple(wall["reflectance"])
    assert cornell.looks == [] and cornell.look is None
    cornell.new_look("as it was")
    wall["reflectance"] = (0.1, 0.2, 0.3)
    cornell.exposure = 2
    cornell.new_look()
    assert cornell.looks == ["as it was", "Look 1"] and cornell.look == "Look 1"
    assert cornell.go_to_look("as it was") == []
    assert tuple(wall["reflectance"]) == before and cornell.exposure == 1 and cornell.look == "as it was"
    assert cornell.history[-1] == "Go to look as it was"
    cornell.undo()
    assert cornell.exposure == 2 and cornell.look == "Look 1"
    cornell.rename_look("Look 1", "blue")
    with pytest.raises(KeyError, match='no look called "blu"; did you mean "blue"'):
        cornell.go_to_look("blu")
    with pytest.raises(restage.Error, match='there is a look "blue"'):
        cornell.new_look("blue")
    cornell.save(tmp_path / "looks.restage")
    with restage.open(tmp_path / "looks.restage") as again:
        assert again.looks == ["as it was", "blue"] and again.look == "blue"
        again.go_to_look("as it was")
        assert again.exposure == 1
        again.update_look("blue")
        again.remove_look("as it was")
        assert again.looks == ["blue"]


def test_an_object_removed_since_is_named(cornell):
    cornell.new_look("all")
    name = cornell.objects[0].name
    cornell.objects[0].remove()
    assert cornell.go_to_look("all") == [f'object "{name}"']
