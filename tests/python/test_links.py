# SPDX-License-Identifier: Apache-2.0
"""Linked files, shared materials and variants through the package."""
import json

import pytest

import restage

CORNERS = "v 0 0 1\nv 1 0 1\nv 0 1 1\n"


@pytest.fixture
def files(tmp_path):
    (tmp_path / "wood.mtl").write_text("newmtl oak\nKd 0.5 0.3 0.1\n")
    (tmp_path / "chair.obj").write_text(f"mtllib wood.mtl\n{CORNERS}usemtl oak\nf 1 2 3\no back\nf 1 3 2\n")
    (tmp_path / "stool.obj").write_text(f"mtllib wood.mtl\n{CORNERS}usemtl oak\nf 1 2 3\n")
    return tmp_path


def test_equal_materials_of_inserted_files_are_shared(files):
    with restage.new() as session:
        session.insert(files / "chair.obj")
        before = len(session.materials)
        session.insert(files / "stool.obj")
        assert len(session.materials) == before
        assert session.merge_equal_materials() == 0


def test_a_link_follows_its_file_and_is_stored_as_a_path(files):
    with restage.new() as session:
        chair = session.insert(files / "chair.obj", link=True)
        assert chair.linked_file == files / "chair.obj"
        with pytest.raises(restage.Error, match='"chair" is linked from chair.obj'):
            chair.objects[0].move((1, 0, 0))
        chair.move((2, 0, 0))
        lower = chair.bounds[0][0]
        session.save(files / "shop.restage")
        (link,) = json.loads((files / "shop.restage").read_text())["links"]
        assert link["file"] == "chair.obj" and link["name"] == "chair"

        (files / "chair.obj").write_text(f"mtllib wood.mtl\n{CORNERS}usemtl oak\nf 1 2 3\n")
        session.reload_links()
        assert len(chair.objects) == 1 and chair.bounds[0][0] == pytest.approx(lower)
        chair.make_editable()
        assert chair.linked_file is None
        chair.objects[0].move((1, 0, 0))
    with restage.open(files / "shop.restage") as again:
        assert len(again.find("chair").objects) == 1


def test_a_file_without_variants_makes_no_looks(cornell):
    with pytest.raises(restage.Error, match="the file has no variants"):
        cornell.looks_from_variants()
