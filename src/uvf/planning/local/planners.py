"""The local planners by their names."""

from collections.abc import Callable

from uvf.models.yaml_data import nearest
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.local.dwa import Dwa, DwaSettings
from uvf.planning.local.elastic_band import ElasticBand, ElasticBandSettings
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.local.pid import PidFollower, PidGains
from uvf.planning.local.planner import Limits, LocalPlanner
from uvf.planning.local.regulated_pure_pursuit import RegulatedPurePursuit, RppSettings
from uvf.planning.local.vfh_plus import VfhPlus, VfhSettings

LocalPlannerMaker = Callable[[Limits, RobotFootprint, int], LocalPlanner]

LOCAL_PLANNERS: dict[str, LocalPlannerMaker] = {
    "mppi": lambda limits, footprint, seed: Mppi(limits, footprint, MppiSettings(), seed),
    "dwa": lambda limits, footprint, seed: Dwa(limits, footprint, DwaSettings()),
    "trajectory_rollout": lambda limits, footprint, seed: Dwa(limits, footprint, DwaSettings(whole_horizon=True)),
    "regulated_pure_pursuit": lambda limits, footprint, seed: RegulatedPurePursuit(limits, footprint, RppSettings()),
    "elastic_band": lambda limits, footprint, seed: ElasticBand(limits, footprint, ElasticBandSettings()),
    "pid": lambda limits, footprint, seed: PidFollower(limits, footprint, PidGains()),
    "vfh_plus": lambda limits, footprint, seed: VfhPlus(limits, footprint, VfhSettings()),
}
"""Makers from the vehicle's limits and footprint and a seed, which counts where random numbers do; the first one is the default."""


def make_local_planner(name: str, limits: Limits, footprint: RobotFootprint, seed: int = 0) -> LocalPlanner:
    """The local planner of a name. Raises ValueError for an unknown one."""
    if name not in LOCAL_PLANNERS:
        raise ValueError(f"local planner: there is no '{name}'; {nearest(name, LOCAL_PLANNERS)}")
    return LOCAL_PLANNERS[name](limits, footprint, seed)
