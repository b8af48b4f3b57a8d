"""Meshes of several colours keep them: a part for each, of pictures their few main ones."""

import numpy as np
import pytest
import trimesh
from PIL import Image

from launch.vehicles.importing import import_vehicle
from tests.launch.vehicles.test_odd_robots import mesh, write
from uvf.models.importing.mesh_colours import MOST, colour_groups
from uvf.models.urdf.model import load_urdf

RED, BLUE = (255, 0, 0, 255), (0, 0, 255, 255)


def painted(colours):
    """A box whose faces have these colours in turn."""
    box = trimesh.creation.box((0.3, 0.2, 0.06))
    box.visual = trimesh.visual.ColorVisuals(box, face_colors=[colours[k % len(colours)] for k in range(12)])
    return box


def pictured(pixels):
    """A sheet of 2 m by 1 m, of 20 x 10 squares, with a picture laid over it."""
    x, y = np.meshgrid(np.linspace(0.0, 2.0, 21), np.linspace(0.0, 1.0, 11))
    corner = (np.arange(10)[:, None] * 21 + np.arange(20)).ravel()
    faces = np.concatenate([np.column_stack((corner, corner + 1, corner + 22)), np.column_stack((corner, corner + 22, corner + 21))])
    uv = np.column_stack((x.ravel() / 2.0, y.ravel()))
    visual = trimesh.visual.TextureVisuals(uv=uv, image=Image.fromarray(pixels))
    return trimesh.Trimesh(np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size))), faces, visual=visual, process=False)


def test_faces_of_two_colours_are_two_parts():
    groups = colour_groups([painted([RED, BLUE])])
    assert sorted(colour for _, colour in groups) == [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]
    assert [len(part.faces) for part, _ in groups] == [6, 6]
    assert sum(part.area for part, _ in groups) == pytest.approx(trimesh.creation.box((0.3, 0.2, 0.06)).area)


def test_what_has_no_colour_is_a_part_of_its_own():
    groups = colour_groups([trimesh.creation.box((1, 1, 1)), painted([RED])])
    assert [(len(part.faces), colour) for part, colour in groups] == [(12, None), (12, (1.0, 0.0, 0.0))]


def test_a_picture_colours_the_faces_that_it_lies_on():
    """Left half red, right half blue; its upper edge is v = 1."""
    pixels = np.zeros((8, 16, 3), np.uint8)
    pixels[:, :8, 0], pixels[:, 8:, 2] = 255, 255
    parts = {colour: part for part, colour in colour_groups([pictured(pixels)])}
    assert parts[(1.0, 0.0, 0.0)].bounds[1][0] == parts[(0.0, 0.0, 1.0)].bounds[0][0] == pytest.approx(1.0)
    upper = np.zeros((8, 16, 3), np.uint8)
    upper[:4, :, 0] = 255
    parts = {colour: part for part, colour in colour_groups([pictured(upper)])}
    assert parts[(1.0, 0.0, 0.0)].bounds[0][1] == pytest.approx(0.5)


def test_of_very_many_colours_a_few_are_left():
    pixels = np.random.default_rng(1).integers(0, 256, (64, 64, 3)).astype(np.uint8)
    groups = colour_groups([pictured(pixels)])
    assert 2 <= len(groups) <= MOST
    assert sum(len(part.faces) for part, _ in groups) == 400


def test_an_imported_robot_has_the_colours_of_its_mesh(tmp_path):
    painted([RED, BLUE]).export(tmp_path / "body.ply")
    import_vehicle(write(tmp_path / "x.urdf", mesh("body.ply", "visual")), tmp_path / "it")
    visuals = load_urdf(tmp_path / "it" / "it.urdf").links["base_link"].visuals
    meshes = [visual for visual in visuals if visual.shape == "mesh"]
    assert {visual.colour for visual in meshes} >= {(1.0, 0.0, 0.0), (0.0, 0.0, 1.0)}
    assert len({visual.mesh for visual in meshes}) == len(meshes)
