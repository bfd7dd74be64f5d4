# SPDX-License-Identifier: Apache-2.0
"""Textures of every type of all plugins: created, with values and operands, assigned, switched, shown."""
import numpy as np
import pytest

import restage


@pytest.fixture
def card():
    """A square that faces the camera in even light, and fills the picture."""
    with restage.new() as session:
        paint = session.add_material("Paint", "diffuse")
        corners = np.array([[-1, 4, 0], [1, 4, 0], [1, 6, 0], [-1, 6, 0]], float)  # above the floor
        uvs = (corners[:, :2] - corners[0, :2]) / 2
        session.add_mesh(corners, [[0, 1, 2], [0, 2, 3]], name="Card", material=paint, uvs=uvs)
        session.set_sky(color=(1, 1, 1))
        session.camera = session.add_camera((0, 5, 2), (0, 5, 0), fov=40)
        yield session


def seen(session):
    return session.render(size=(48, 48), samples=16).color


@pytest.mark.parametrize("type", sorted(restage.texture_types()))
def test_every_type_is_made_assigned_and_undone(card, type):
    image = np.full((2, 2, 3), 0.25, np.float32) if type == "imagemap" else None
    history = card.history
    made = card.add_texture(image, name="Made", type=type)
    assert len(card.history) == len(history) + 1 and made.type == type and not made.scalar
    assert [p.id for p in made.parameters] == [p.id for p in restage.texture_types()[type]] == made.keys()
    for line in made.parameters:
        assert made[line.id] == line.default and line.id in made
        if line.type in ("float", "int", "color"):
            most = int(line.range[1]) if line.type == "int" else line.range[1]
            made[line.id] = most
            assert made[line.id] == (most if line.type != "color" else (most,) * 3)
            del made[line.id]
            assert made[line.id] == line.default
    card.materials["Paint"]["reflectance"] = made
    assert card.materials["Paint"]["reflectance"] == made
    assert np.isfinite(seen(card)).all()
    for _ in range(len(card.history) - len(history)):
        card.undo()
    assert not made.exists and card.history == history


def test_operands_are_textures_numbers_or_images(card, scenes):
    squares = card.add_texture(type="checkerboard", name="Squares", tex1=(0.8, 0, 0), uscale=2.0, vscale=2)
    noise = card.add_texture(type="fbm", scalar=True, octaves=3, roughness=0.4)
    assert noise.name == "Fractal noise" and noise.scalar and noise["octaves"] == 3
    mixed = card.add_texture(type="mix", tex1=squares, tex2=0.5, amount=noise)
    assert mixed["tex1"] == squares and mixed["tex2"] == (0.5, 0.5, 0.5) and mixed["amount"] == noise
    squares["tex2"] = scenes / "demo/textures/oak.png"
    assert squares["tex2"].type == "imagemap" and squares["tex2"].image_path.endswith("oak.png")
    card.materials["Paint"]["reflectance"] = mixed
    with pytest.raises(restage.Error, match="would contain itself"):
        squares["tex1"] = mixed
    with pytest.raises(restage.Error, match="in use|used"):
        squares.remove()


def test_the_picture_follows(card):
    squares = card.add_texture(type="checkerboard", tex1=(0.9, 0.1, 0.1), tex2=(0.1, 0.1, 0.9))
    card.materials["Paint"]["reflectance"] = squares
    one = seen(card)
    assert (one[..., 0] > 2 * one[..., 2]).mean() > 0.9  # uv are within one square
    squares["uscale"] = squares["vscale"] = 4.0
    four = seen(card)
    assert 0.35 < (four[..., 0] > four[..., 2]).mean() < 0.65
    squares.type = "dots"  # two operands, in order
    assert squares["inside"] == pytest.approx((0.9, 0.1, 0.1)) and squares["uscale"] == 4.0
    assert not np.allclose(seen(card), four, atol=0.05)
    card.undo()
    assert squares.type == "checkerboard" and np.allclose(seen(card), four, atol=0.05)


@pytest.mark.parametrize("arguments, says", [
    ({"type": "plaid"}, 'no texture type "plaid"'),
    ({"type": "imagemap"}, "needs an image"),
    ({"type": "fbm", "image": np.zeros((2, 2, 3))}, "a fbm has no image"),
    ({"type": "fbm", "nonsense": 1}, 'parameter "nonsense" does not exist in a fbm'),
    ({"type": "fbm", "octaves": 99}, "out of its range, 0 to 16"),
    ({"type": "fbm", "octaves": 0.5}, "a whole number"),
    ({"type": "mix", "amount": "much"}, "much"),
    ({"image": np.zeros((2, 2, 3)), "wrap": "mirror"}, "repeat|black|clamp"),
])
def test_what_does_not_fit_is_refused_and_leaves_nothing(card, arguments, says):
    history, textures = card.history, len(card.textures)
    with pytest.raises(restage.Error) as error:
        card.add_texture(**arguments)
    assert says in str(error.value)
    assert card.history == history and len(card.textures) == textures
