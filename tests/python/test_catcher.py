# SPDX-License-Identifier: Apache-2.0
"""Shadow catchers through the package: the flag, undo, projects, looks, and what an export says."""
import restage


def test_the_flag_is_undone_and_kept(cornell, tmp_path):
    floor = cornell.objects[0]
    assert not floor.shadow_catcher
    floor.shadow_catcher = True
    assert floor.shadow_catcher
    cornell.undo()
    assert not floor.shadow_catcher
    floor.shadow_catcher = True
    before = cornell.render(size=(32, 32), samples=4).color
    cornell.save(tmp_path / "caught.restage")
    with restage.open(tmp_path / "caught.restage") as again:
        assert [o.shadow_catcher for o in again.objects] == [o.id == floor.id for o in cornell.objects]
        assert (again.render(size=(32, 32), samples=4).color == before).all()


def test_an_export_says_that_files_have_none(cornell, tmp_path):
    name = cornell.objects[0].name
    assert "shadow catcher" not in str(cornell.export(tmp_path / "plain.pbrt"))
    cornell.objects[0].shadow_catcher = True
    report = str(cornell.export(tmp_path / "caught.pbrt"))
    assert "shadow catchers" in report and name in report
