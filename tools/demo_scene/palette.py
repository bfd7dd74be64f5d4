# SPDX-License-Identifier: Apache-2.0
"""Materials that several of the bundled parts share, each with its textures."""


def oak(scene):
    scene.texture("oak grain", "spectrum", "oak.png", uscale=3.0, vscale=1.5)
    scene.material("Oak", "coateddiffuse", reflectance=("texture", "oak grain"), roughness=0.3)


def walnut(scene):
    scene.texture("walnut grain", "spectrum", "walnut.png", uscale=1.25, vscale=0.8)
    scene.material("Walnut", "coateddiffuse", reflectance=("texture", "walnut grain"), roughness=0.22)


def brass(scene):
    """By its colour, not by spectra: those are reduced to RGB on import, which is reported."""
    scene.material("Brushed brass", "conductor", reflectance=(0.86, 0.66, 0.36), roughness=0.2)


def mirror(scene):
    scene.material("Mirror", "conductor", reflectance=(0.93, 0.93, 0.92), roughness=0.0)


def bark(scene):
    scene.material("Bark", "diffuse", reflectance=(0.13, 0.085, 0.05))


def weave(scene, name="linen height", depth=0.0004, repeats=24):
    """A plain weave as a height field [m], repeats times a metre; returns the material's parameters for it."""
    scene.texture(name, "float", "weave-height.png", encoding="linear", scale=depth, uscale=repeats, vscale=repeats)
    return {"displacement": ("texture", name)}
