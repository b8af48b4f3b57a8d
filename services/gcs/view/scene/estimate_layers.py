"""What a vehicle believes: its frames, how sure it is of its place, and what moves around it."""

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.vehicle_model import STALE_AFTER, VehicleModel
from services.gcs.view.drawing import Axes, TextNode
from services.gcs.view.scene.estimates import cloud, covariance_of, ellipse
from services.gcs.view.scene.found_markers import MOST as MARKERS_MOST
from services.gcs.view.scene.found_markers import ring_about
from services.gcs.view.scene.frames import chained, fixed_frames
from services.gcs.view.scene.levels import UP
from services.gcs.view.scene.node_cache import Layers, NodeCache, Nodes
from services.gcs.view.scene.obstacles import MOST as OBSTACLES_MOST
from services.gcs.view.scene.obstacles import predicted

Floats = NDArray[np.float64]


class EstimateLayers:
    """Draws what a vehicle's estimators tell."""

    def __init__(self, nodes: NodeCache) -> None:
        self._nodes = nodes

    def of(self, v: VehicleModel, t: float) -> Layers:
        """The layers of a vehicle at ``t`` [s, wall]."""
        return {
            "frame": ("Frames", lambda: self._frames(v)),
            "moving": ("Obstacles", lambda: self._obstacles(v, t)),
            "marker": ("Markers", lambda: self._markers(v)),
            "sigma": ("Uncertainty", lambda: self._ellipse(v)),
            "particles": ("Uncertainty", lambda: self._particles(v)),
        }

    def _frames(self, v: VehicleModel) -> Nodes:
        """Those of the map and of odometry in the world, those of the body below the vehicle's frame.

        Names that would cover each other are left out.
        """
        length = 1.0 if v.flies else 0.15
        found: dict[str, Axes] = {}
        for name, chain in (("map", (v.world_from_map,)), ("odom", (v.world_from_map, v.map_from_odom))):
            links = [one for one in chain if one is not None]
            if len(links) == len(chain):
                found[f"/{name}"] = chained(links, 2 * length)
        if v.tf_static is not None and v.place is not None:
            found |= {f"/body/{name}": axes for name, axes in fixed_frames(v.tf_static, "base_link", length).items()}
        drawn: Nodes = {}
        named: list[Floats] = []
        for name, axes in found.items():
            is_alone = not name.startswith("/body/") or all(float(np.abs(axes.position - at).max()) > length for at in named)
            named += [axes.position] if name.startswith("/body/") else []
            drawn |= {name + end: node for end, node in self._axes(v, name, axes, is_alone).items()}
        return drawn

    def _axes(self, v: VehicleModel, name: str, axes: Axes, is_named: bool) -> Nodes:
        at = (*np.round(np.concatenate((axes.position, axes.wxyz)), 3).tolist(), is_named)

        def draw() -> Nodes:
            label: Nodes = {"/name": TextNode(name.rpartition("/")[2], (0.0, 0.0, axes.length))} if is_named else {}
            return {"": axes, **label}

        return self._nodes.make_all(f"frame {v.name}{name}", at, draw)

    def _obstacles(self, v: VehicleModel, t: float) -> Nodes:
        if v.obstacles is None or t - v.heard_at["obstacles"] > STALE_AFTER:
            return {}
        told = list(enumerate(v.obstacles.obstacles[:OBSTACLES_MOST]))
        return self._nodes.make_all(f"moving {v.name}", v.obstacles, lambda: {f"/{i}": predicted(one, 5 * UP) for i, one in told})

    def _markers(self, v: VehicleModel) -> Nodes:
        if v.detections is None:
            return {}
        told = v.detections.detections[:MARKERS_MOST]

        def draw() -> Nodes:
            drawn: Nodes = {}
            for each in told:
                drawn[f"/{each.id}"] = ring_about(each)
                drawn[f"/{each.id}/name"] = TextNode(f"{v.name} {each.id}", (each.position.x, each.position.y, each.position.z + 1.0))
            return drawn

        return self._nodes.make_all(f"marker {v.name}", v.detections, draw)

    def _ellipse(self, v: VehicleModel) -> Nodes:
        covariance = covariance_of(v.fix, v.quality, v.world_from_map) if v.place is not None else None
        if covariance is None:
            return {}
        found = ellipse(covariance, 0.0 if v.flies else 4 * UP)
        return {} if found is None else {"/edge": self._nodes.make(f"sigma {v.name}", _rounded(covariance), lambda: found)[""]}

    def _particles(self, v: VehicleModel) -> Nodes:
        told = v.particles
        if told is None or not told.poses:
            return {}
        return self._nodes.make(f"particles {v.name}", (told, v.world_from_map), lambda: cloud(told, v.world_from_map, 4 * UP))


def _rounded(covariance: Floats) -> tuple[float, ...]:
    """To two digits: nobody sees more of it."""
    return tuple(float(f"{value:.1e}") for value in covariance.ravel())
