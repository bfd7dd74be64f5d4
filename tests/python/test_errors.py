# SPDX-License-Identifier: Apache-2.0
"""A wrong argument raises a one-sentence error: the argument, its required type, the given value."""
import inspect

import numpy as np
import pytest

import restage

WRONG = [
    (lambda s, o: o.move("x"), "move(): \"by\" must be three numbers, not 'x' (str)"),
    (lambda s, o: o.move(np.zeros(2)), 'move(): "by" must be three numbers, not array([0., 0.]) (ndarray)'),
    (lambda s, o: o.move(), 'move() needs "by"'),
    (lambda s, o: o.move((1, 2, 3), 4), "move() takes 1 argument, not 2"),
    (lambda s, o: o.move((1, 2, 3), by=4), 'move() got "by" twice'),
    (lambda s, o: o.remove(1), "remove() takes no arguments, not 1"),
    (lambda s, o: o.scale("x"), "scale(): \"factor\" must be a number or three numbers, not 'x' (str)"),
    (lambda s, o: s.render(sampels=4), 'render() has no argument "sampels"; did you mean "samples"?'),
    (lambda s, o: s.render(samples=1.5), 'render(): "samples" must be a whole number or None, not 1.5 (float)'),
    (lambda s, o: s.render(samples=-1), 'render(): "samples" must be a whole number from 0 to 2147483647, not -1 (int)'),
    (lambda s, o: s.render(size=3), 'render(): "size" must be two whole numbers or None, not 3 (int)'),
    (lambda s, o: setattr(s.camera, "fov", "wide"), "Camera.fov must be a number, not 'wide' (str)"),
    (lambda s, o: setattr(o, "material", None), "Object.material must be a Material, not None (NoneType)"),
    (lambda s, o: setattr(s.camera, "screen_window", (1, 2, 3)), "Camera.screen_window must be four numbers or None, not (1, 2, 3) (tuple)"),
    (lambda s, o: s.objects[1.5], "Objects[...]: expected a str or a whole number, not 1.5 (float)"),
    (lambda s, o: restage.open(3), 'open(): "path" must be a path, not 3 (int)'),
    (lambda s, o: restage.merge(3), 'merge(): "pictures" must be a list of Pictures, not 3 (int)'),
    (lambda s, o: restage.Bsdf(3), 'Bsdf(): "type" must be a str, not 3'),
    (lambda s, o: restage.check(3), 'check(): "plugin" must be a path, an id or a Plugin, not 3'),
]


@pytest.mark.parametrize("call, says", WRONG, ids=[says[:30] for _, says in WRONG])
def test_a_wrong_argument_is_one_sentence(cornell, call, says):
    before = cornell.history
    with pytest.raises(TypeError) as wrong:
        call(cornell, cornell.objects[0])
    assert str(wrong.value) == says and cornell.history == before


def test_missing_things_raise_pythons_usual_errors(cornell):
    with pytest.raises(KeyError, match='there is no object called "nobody"'):
        cornell.objects["nobody"]
    for index in (99, -99):
        with pytest.raises(IndexError, match=f"there is no object {index}: there are {len(cornell.objects)}, counted from 0"):
            cornell.objects[index]
    with pytest.raises(restage.Error, match='there is no bundled scene "3"'):
        restage.bundled_scene(3)


def functions():
    for owner in (restage._core, *(c for c in vars(restage._core).values() if isinstance(c, type))):
        for name, member in vars(owner).items():
            functions = (member.fset, ) if isinstance(member, property) else (member, )
            for function in functions:
                if function is not None and (name[0] != "_" or name in ("__getitem__", "__setitem__", "__contains__")):
                    yield f"{owner.__name__}.{name}", function


def test_every_function_of_the_module_answers_so():
    names = [name for name, function in functions() if type(function).__name__ in ("nb_func", "nb_method")]
    assert names == []
    assert sum(1 for _ in functions()) > 100


def test_help_and_completion_know_the_signature():
    assert str(inspect.signature(restage.Session.add_light)) == (
        "(self, kind: 'str', value: 'numpy.typing.ArrayLike' = [1.0, 1.0, 1.0], name: 'str' = 'Light') -> 'Light'")
    assert list(inspect.signature(restage.Object.rotate).parameters) == ["self", "degrees", "axis", "center"]
    assert list(inspect.signature(restage.Object.move).parameters) == ["self", "by", "collide"]
    assert restage.Object.move.__doc__.startswith("Moves by this vector, world space [scene units].")
