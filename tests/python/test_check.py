# SPDX-License-Identifier: Apache-2.0
"""restage.check: the conformance test, called from Python. tests/scripts/test_check_command.py tests its findings."""
import pytest

import restage


def test_a_good_plugin_passes_and_the_report_says_what_was_done():
    report = restage.check("mirror", quick=True, seed=7)
    assert report and report.passed and report.kind == "material" and report.seed == 7 and not report.failures, str(report)
    assert len(report.steps) > 3 and all(s.verdict in ("pass", "skipped") for s in report.steps)
    assert "passed" in str(report) and report.seconds > 0


def test_a_folder_a_plugin_and_one_step():
    plugin = next(p for p in restage.plugins() if "material diffuse" in p.provides)
    report = restage.check(plugin, quick=True, only="manifest")
    steps = [s.step for s in report.steps]
    assert report.folder == str(plugin.folder) and "manifest" in steps and "energy" not in steps


def test_an_uncheckable_plugin_is_an_error(tmp_path):
    with pytest.raises(restage.Error, match="nowhere"):
        restage.check(tmp_path / "nowhere", quick=True)
    (tmp_path / "plugin.json").write_text("{ not json")
    report = restage.check(tmp_path, quick=True)
    assert not report and "plugin.json" in report.failures[0].text
