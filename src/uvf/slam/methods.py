"""SLAM methods by name."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from uvf.models.params import Params
from uvf.models.yaml_data import BadInput, convert, nearest
from uvf.slam.graph.method import GraphParams, GraphSlam
from uvf.slam.hector.method import HectorSlam
from uvf.slam.hector.params import HectorParams
from uvf.slam.method import SlamMethod
from uvf.slam.odometry_method import OdometryMethod, OdometryMethodParams
from uvf.slam.rbpf.method import RbpfSlam
from uvf.slam.rbpf.params import RbpfParams


@dataclass(frozen=True)
class MethodKind:
    """Parameters and constructor of a method."""

    params: type[Params]
    make: Callable[[Any], SlamMethod]


METHODS: dict[str, MethodKind] = {
    "graph": MethodKind(GraphParams, GraphSlam),
    "rbpf": MethodKind(RbpfParams, RbpfSlam),
    "hector": MethodKind(HectorParams, HectorSlam),
    "odometry": MethodKind(OdometryMethodParams, OdometryMethod),
}


def method_params(name: str, values: Mapping[str, Any], source: str) -> Params:
    """Parameters of a method: its defaults, but for ``values``, which come from ``source``. Raises BadInput."""
    if name not in METHODS:
        raise BadInput(f"no SLAM method '{name}'; {nearest(name, METHODS)}")
    return convert(dict(values), METHODS[name].params, source)


def make_method(name: str, params: Params) -> SlamMethod:
    """A new instance of a method. params: of ``method_params``."""
    return METHODS[name].make(params)
