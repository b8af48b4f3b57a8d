"""Ground, sky and light of the scene, light or dark, for each browser its own."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

GRID, GROUND = -0.12, -0.35  # m
WIDE = 12_000.0  # m
QUAD = np.array(((0, 1, 2), (0, 2, 3)), dtype=np.uint32)

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
    corners = np.array([(x, y, GROUND) for x, y in ((-WIDE, -WIDE), (WIDE, -WIDE), (WIDE, WIDE), (-WIDE, WIDE))], dtype=np.float32)
    # Opaque: what is see-through, as the unknown part of a map, lets only what is opaque be seen.
    scene.add_mesh_simple("/ground/plane", corners, QUAD, color=colours.plane, flat_shading=True, side="double", cast_shadow=False)
    scene.set_background_image(sky(colours), format="png")


def light(scene: Any) -> None:
    """Lights the scene from all sides, without shadows that cost frames."""
    scene.configure_environment_map(hdri=None)
    scene.add_light_ambient("/world/ambient", intensity=0.7)
    scene.add_light_hemisphere("/world/sky", sky_color=(235, 242, 255), ground_color=(120, 110, 100), intensity=1.6)


def sky(colours: SceneColours) -> NDArray[np.uint8]:
    """Background image (64, 4, 3) RGB: a sky that ends in the ground's haze at the horizon."""
    share = np.linspace(0, 1, 64)[:, None, None] ** 1.5
    return np.tile(np.array(colours.zenith) * (1 - share) + np.array(colours.horizon) * share, (1, 4, 1)).astype(np.uint8)
