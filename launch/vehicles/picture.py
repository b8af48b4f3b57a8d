"""What a vehicle looks like: from the front left, from above and from its side, by the renderer of the cameras."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from services.sim_camera.build import look_at
from services.sim_camera.renderer import BulletRenderer, Look, Pose
from uvf.maths.rotations import from_matrix
from uvf.models.aircraft.shape import AircraftShape
from uvf.models.shapes.mesh import placed, triangles
from uvf.models.urdf.model import load_urdf
from uvf.models.vehicle.file import VehicleFile
from uvf.models.vehicle.sensors import Camera, Mount
from uvf.models.world.file import Origin, WorldFile
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]

PIXELS = 640
FAR_OFF = 30.0  # of the vehicle's size, from which a picture has hardly any perspective
GROUND = (0.78, 0.78, 0.80)  # the pattern on it makes it lighter
UP = np.array((0.0, 0.0, 1.0))


@dataclass(frozen=True)
class PictureView:
    """A view. to_eye: (3,) direction from the vehicle's middle; away: distance in sizes of the vehicle; axes: which go right and up."""

    title: str
    to_eye: tuple[float, float, float]
    away: float
    axes: tuple[str, str] | None = None


VIEWS = (
    PictureView("from the front left", (1.0, 0.8, 0.7), 6.0),
    PictureView("from above", (0.0, 0.0, 1.0), FAR_OFF, ("x", "y")),
    PictureView("from the right", (0.0, -1.0, 0.0), FAR_OFF, ("x", "z")),
)


def write_picture(folder: Path, file: VehicleFile, target: Path) -> None:
    """Draws three views with scales in metres into a PNG. Raises BadInput where it cannot be written."""
    look = look_at(folder, file)
    middle, size = _extent(look, folder, file)
    renderer = BulletRenderer(WorldFile("", Origin(0.0, 0.0, 0.0), (-1.0, -1.0, 1.0, 1.0), ground_colour=GROUND), [], {"it": look})
    figure = Figure(figsize=(12.0, 4.4), layout="constrained")
    try:
        renderer.place(0.0, {"it": Pose(_origin(look), np.array((1.0, 0.0, 0.0, 0.0)))})
        for view, axes in zip(VIEWS, figure.subplots(1, len(VIEWS)), strict=True):
            _draw(axes, view, _seen(renderer, view, middle, size), (middle, size))
    finally:
        renderer.close()
    figure.suptitle(f"{folder.name}: {file.about}", fontsize=10)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(target, dpi=90)
    except (OSError, ValueError) as error:
        raise BadInput(f"{target}: cannot be written: {error}") from error


def _origin(look: Look) -> Floats:
    """(3,) m: aircraft are shown in the air."""
    return np.array((0.0, 0.0, 1.5 * float(np.ptp(look.bounds, axis=0).max()) if isinstance(look, AircraftShape) else 0.0))


def _extent(look: Look, folder: Path, file: VehicleFile) -> tuple[Floats, float]:
    """What the views turn about (3,) m, and how far the vehicle goes from there [m]."""
    if isinstance(look, AircraftShape):
        return _origin(look) + look.bounds.mean(axis=0), 0.55 * float(np.ptp(look.bounds, axis=0).max())
    assert file.ground is not None
    model = load_urdf(folder / file.ground.urdf)
    poses = model.link_poses()
    points = [triangles(placed(s, poses[n]))[0] for n, link in model.links.items() for s in link.visuals or link.collisions]
    top = float(np.vstack(points)[:, 2].max())
    return np.array((0.0, 0.0, top / 2)), max(file.ground.radius, 0.6 * top)


def _seen(renderer: BulletRenderer, view: PictureView, middle: Floats, size: float) -> Any:
    """(PIXELS, PIXELS, 3) RGB; what lies in the plane of the middle spans 2.4 sizes."""
    to_eye = np.array(view.to_eye) / np.linalg.norm(view.to_eye)
    away = view.away * size
    forward = -to_eye
    left = np.cross(UP, forward) if abs(forward[2]) < 0.99 else np.array((-1.0, 0.0, 0.0))
    left /= np.linalg.norm(left)
    turned = from_matrix(np.column_stack((forward, left, np.cross(forward, left))))
    fov = float(2 * np.arctan(1.2 * size / away))
    camera = Camera(mount=Mount(), hz=1.0, width=PIXELS, height=PIXELS, fov=fov, far=away + 20 * size)
    return renderer.take(camera, Pose(middle + away * to_eye, turned)).picture


def _draw(axes: Any, view: PictureView, picture: Any, shown: tuple[Floats, float]) -> None:
    middle, size = shown
    axes.set_title(view.title, fontsize=9)
    if view.axes is None:
        axes.imshow(picture)
        axes.axis("off")
        return
    right, up = ("xyz".index(a) for a in view.axes)
    half = 1.2 * size
    axes.imshow(picture, extent=(middle[right] - half, middle[right] + half, middle[up] - half, middle[up] + half))
    axes.set_xlabel(f"{view.axes[0]} [m]", fontsize=8)
    axes.set_ylabel(f"{view.axes[1]} [m]", fontsize=8)
    axes.tick_params(labelsize=7)
