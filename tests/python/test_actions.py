# SPDX-License-Identifier: Apache-2.0
"""Actions of plugins from a script: one undo step each, cancelled by the callback, refused with a message."""
import numpy as np
import pytest

import restage


def pair(session):
    """Something to scatter, and a floor."""
    floor = session.add_mesh(name="meadow", positions=[[-5, 0, -5], [5, 0, -5], [5, 0, 5], [-5, 0, 5]],
                             triangles=[[0, 2, 1], [0, 3, 2]], material=session.objects[0].material)
    pin = session.add_mesh(name="pin", positions=[[0, 0, 0], [0.1, 1, 0], [-0.1, 1, 0]], triangles=[[0, 1, 2]],
                           material=session.objects[0].material)
    return pin, floor


def test_scatter_is_one_step_that_undo_takes_back(cornell):
    pin, floor = pair(cornell)
    steps, objects = cornell.history, len(cornell.objects)
    made = cornell.run_action("scatter", [pin, floor], count=40, seed=3, up="y", scale_max=1)
    assert made.changed and len(made.objects) == 40 and len(cornell.objects) == objects + 40
    assert cornell.history == steps + ["Scatter"]
    assert "40 copies" in str(made.report)
    assert cornell.undo() and cornell.history == steps and len(cornell.objects) == objects
    assert len(made.objects) == 0  # they no longer exist


def test_a_seed_gives_the_same_copies(cornell):
    pin, floor = pair(cornell)

    def places(seed):
        before = {o.id for o in cornell.objects}
        cornell.run_action("scatter", [pin, floor], count=10, seed=seed, up="y")
        found = np.array([o.transform for o in cornell.objects if o.id not in before])
        cornell.undo()
        return found

    assert np.array_equal(places(1), places(1)) and not np.array_equal(places(1), places(2))
    assert np.allclose(places(1)[:, 1, 3], 0, atol=1e-6)


def test_it_joins_a_step_of_the_script(cornell):
    pin, floor = pair(cornell)
    steps = cornell.history
    with cornell.step("Plant"):
        cornell.run_action("scatter", [pin, floor], count=5)
        cornell.run_action("scatter", [pin, floor], count=5, seed=2)
    assert cornell.history == steps + ["Plant"]


def test_what_there_is(cornell):
    (scatter,) = [a for a in cornell.actions() if a.id == "scatter"]
    assert scatter.label == "Scatter" and scatter.needs_selection and scatter.tooltip
    assert scatter.plugin == "org.restage.action.scatter"
    assert scatter.parameters["count"] == 100 and scatter.parameters["amount"] == "count"


@pytest.mark.parametrize("arguments, says", [
    (dict(id="scater"), 'there is no action "scater"; known: scatter'),
    (dict(id="scatter"), "nothing is selected: select objects first"),
    (dict(id="scatter", selection="one"), "at least two objects"),
    (dict(id="scatter", selection="both", sed=3), 'there is no parameter "sed"; known: amount, count'),
    (dict(id="scatter", selection="both", count=0), 'parameter "count"'),
    (dict(id="scatter", selection="both", amount="lots"), 'parameter "amount"'),
    (dict(id="scatter", selection="both", slope=0, side="back", up="y"), "faces the other way"),
])
def test_what_cannot_be_is_one_sentence_and_changes_nothing(cornell, arguments, says):
    pin, floor = pair(cornell)
    chosen = {"one": [floor], "both": [pin, floor]}.get(arguments.pop("selection", ""), [])
    steps = cornell.history
    with pytest.raises(restage.Error) as wrong:
        cornell.run_action(arguments.pop("id"), chosen, **arguments)
    assert says in str(wrong.value) and cornell.history == steps


def test_a_callback_stops_it(cornell):
    pin, floor = pair(cornell)
    steps, calls = cornell.history, []

    def stop(fraction, what):
        calls.append((fraction, what))
        return False

    with pytest.raises(restage.Cancelled):
        cornell.run_action("scatter", [pin, floor], progress=stop, count=100000, distance=0.001)
    assert calls and calls[0][1] == "scattering" and cornell.history == steps
