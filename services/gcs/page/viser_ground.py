"""Ground, sky and light of the scene, light or dark, for each browser its own."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

GRID, GROUND = -0.12, -0.35  # m
EDGES = np.array((-12_000, -3000, -800, -200, -50, -12, 0, 12, 50, 200, 800, 3000, 12_000), dtype=np.float32)
"""Where the plane is cut [m], along x and y: what is drawn in software gets the depth of a triangle of kilometres wrong by half a metre,
and the floor of a house lay below the ground."""

Rgb = tuple[int, int, int]


class SceneColours(NamedTuple):
    """Colours of one theme."""

    zenith: Rgb
    horizon: Rgb
    cells: Rgb
    sections: Rgb
    plane: Rgb


THEMES = {
    "light": SceneColours((150, 190, 232), (232, 240, 248), (196, 205, 216), (160, 173, 189), (222, 228, 235)),
    "dark": SceneColours((10, 17, 32), (74, 98, 134), (66, 80, 100), (96, 114, 140), (22, 30, 42)),
}


def dress(scene: Any, theme: str) -> None:
    """Draws the ground and the sky of a theme into a browser's scene."""
    colours = THEMES[theme]
    scene.add_grid(
        "/ground",
        infinite_grid=True,
        cell_size=10.0,
        section_size=100.0,
        cell_color=colours.cells,
        section_color=colours.sections,
        cell_thickness=0.8,
        section_thickness=1.2,
        fade_distance=900.0,
        position=(0, 0, GRID),
    )
    # Opaque: what is see-through, as the unknown part of a map, lets only what is opaque be seen.
    scene.add_mesh_simple("/ground/plane", *plane(), color=colours.plane, flat_shading=True, side="double", cast_shadow=False)
    scene.set_background_image(sky(colours), format="png")


def plane() -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Vertices (n, 3) [m] and faces (m, 3) of the ground, in triangles that are small where the worlds are."""
    x, y = np.meshgrid(EDGES, EDGES, indexing="ij")
    vertices = np.stack((x, y, np.full_like(x, GROUND)), axis=-1).reshape(-1, 3)
    at = np.arange(len(vertices), dtype=np.uint32).reshape(x.shape)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    return vertices, np.concatenate((np.stack((a, b, c), axis=1), np.stack((a, c, d), axis=1)))


def light(scene: Any) -> None:
    """Lights the scene from all sides, without shadows that cost frames."""
    scene.configure_environment_map(hdri=None)
    scene.add_light_ambient("/world/ambient", intensity=0.7)
    scene.add_light_hemisphere("/world/sky", sky_color=(235, 242, 255), ground_color=(120, 110, 100), intensity=1.6)


def sky(colours: SceneColours) -> NDArray[np.uint8]:
    """Background image (64, 4, 3) RGB: a sky that ends in the ground's haze at the horizon."""
    share = np.linspace(0, 1, 64)[:, None, None] ** 1.5
    return np.tile(np.array(colours.zenith) * (1 - share) + np.array(colours.horizon) * share, (1, 4, 1)).astype(np.uint8)
