# SPDX-License-Identifier: Apache-2.0
"""Presets are listed, and added to a scene once."""
import pytest

import restage


def test_presets_of_restage_are_listed_with_their_sources():
    presets = restage.presets()
    assert len(presets) >= 60
    gold = next(p for p in presets if p.name == "Gold")
    assert (gold.category, gold.type) == ("Metal", "conductor")
    assert "Johnson and Christy" in gold.source


def test_a_preset_is_added_once(tmp_path):
    with restage.open(restage.bundled_scene("cornell")) as session:
        gold = next(p for p in restage.presets() if p.name == "Gold")
        before = len(session.materials)
        material = session.add_preset(gold.path)
        assert material.name == "Gold" and material.type == "conductor"
        assert material["eta"] == pytest.approx((0.0584, 0.5002, 1.4592), abs=1e-6)
        assert session.add_preset(gold.path).name == "Gold" and len(session.materials) == before + 1
        assert session.history == ["Material Gold"]
        broken = tmp_path / "broken.json"
        broken.write_text('{"restage": "material", "name": "a", "category": "b",\n"type": "nothing"}')
        with pytest.raises(restage.Error, match='broken.json:2: no plugin provides the material type "nothing"'):
            session.add_preset(broken)


def test_a_textured_preset_is_projected_on_objects_without_coordinates():
    with restage.new() as session:
        corners = [[0, 0, 0], [2, 0, 0], [0, 3, 0]]
        bare = session.add_mesh(corners, [[0, 1, 2]], name="Bare")
        mapped = session.add_mesh(corners, [[0, 1, 2]], name="Mapped", uvs=[[0, 0], [1, 0], [0, 1]])
        tiles = next(p for p in restage.presets() if p.name == "Tiles, black and white")
        material = session.add_preset(tiles.path)
        before = len(session.history)
        bare.material = mapped.material = material
        assert len(session.history) == before + 2
        assert bare.uvs is not None and bare.uvs.max() == pytest.approx(1)
        assert mapped.uvs.tolist() == [[0, 0], [1, 0], [0, 1]]
