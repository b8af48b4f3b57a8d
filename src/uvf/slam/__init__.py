"""Laser SLAM: readings in, trajectory and map out. Methods, localization on a known map, merging of maps, logs and their evaluation."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.slam.evaluation.run import run_over as run_over
    from uvf.slam.graph.method import GraphParams as GraphParams
    from uvf.slam.graph.method import GraphSlam as GraphSlam
    from uvf.slam.hector.method import HectorSlam as HectorSlam
    from uvf.slam.hector.params import HectorParams as HectorParams
    from uvf.slam.localization.localizer import Localizer as Localizer
    from uvf.slam.logs.carmen import read_carmen as read_carmen
    from uvf.slam.maps.tiles import TileMap as TileMap
    from uvf.slam.octree.octree import Octree as Octree
    from uvf.slam.pose_graph.pose_graph import PoseGraph as PoseGraph
    from uvf.slam.rbpf.method import RbpfSlam as RbpfSlam
    from uvf.slam.rbpf.params import RbpfParams as RbpfParams
    from uvf.slam.reading import Beams as Beams
    from uvf.slam.reading import Reading as Reading

OFFERED = {
    "GraphSlam": "uvf.slam.graph.method:GraphSlam",
    "GraphParams": "uvf.slam.graph.method:GraphParams",
    "RbpfSlam": "uvf.slam.rbpf.method:RbpfSlam",
    "RbpfParams": "uvf.slam.rbpf.params:RbpfParams",
    "HectorSlam": "uvf.slam.hector.method:HectorSlam",
    "HectorParams": "uvf.slam.hector.params:HectorParams",
    "Localizer": "uvf.slam.localization.localizer:Localizer",
    "Reading": "uvf.slam.reading:Reading",
    "Beams": "uvf.slam.reading:Beams",
    "TileMap": "uvf.slam.maps.tiles:TileMap",
    "PoseGraph": "uvf.slam.pose_graph.pose_graph:PoseGraph",
    "Octree": "uvf.slam.octree.octree:Octree",
    "read_carmen": "uvf.slam.logs.carmen:read_carmen",
    "run_over": "uvf.slam.evaluation.run:run_over",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
