"""What a run consists of: one line per kind of process. A service's folder, its tests and a line here make a service."""

import importlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from uvf.models.scenario import Scenario
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.contract.instances import Build, ServiceInstance


@dataclass(frozen=True)
class Kind:
    """A kind of service. ``build``: module with ``build(site)``; ``needs``: the vehicles without which it has no work, or
    ``asked``: one that has parameters for it, ``program``: one that brings a program along, or ``team``: two that draw
    maps; or ``tasks``: those of the mission.

    ``nice``: its nice value, so that time keepers (router, conductor, simulators) come first when processors are few.
    """

    name: str
    build: str
    about: str
    needs: Literal["ground", "fixed_wing", "any", "asked", "program", "team", "tasks"] = "any"
    clock: Literal["sim", "wall"] = "sim"
    simulator: bool = False
    nice: int = 0


KINDS = (
    Kind("sim_ground", "services.sim_ground.build", "PyBullet world of the ground vehicles, their sensors", "ground", simulator=True),
    Kind("sim_air", "services.sim_air.build", "JSBSim aircraft, wind, their sensors", "fixed_wing", simulator=True),
    Kind("sim_camera", "services.sim_camera.build", "every vehicle's camera", nice=15),
    Kind("slam", "services.slam.build", "odometry, mapping, localization", "ground", nice=3),
    Kind("octree", "services.slam.octree.build", "3-D maps of the vehicles that ask for one", "asked", nice=12),
    Kind("elevation", "services.slam.elevation.build", "heights of the ground below the aircraft that ask for them", "asked", nice=10),
    Kind("detector", "services.detector.build", "coloured markers in the pictures of the vehicles that ask for it", "asked", nice=8),
    Kind("merging", "services.slam.merging.build", "one map of those who map the same place", "team", nice=12),
    Kind("planner", "services.planner.build", "exploration, paths, tracking", "ground", nice=2),
    Kind("autopilot", "services.autopilot.build", "command multiplexer, estimator, guidance, control, modes", nice=2),
    Kind("executive", "services.executive.build", "the tasks of the mission", "tasks", nice=5),
    Kind("programs", "services.programs.build", "the vehicles' own programs", "program", nice=5),
    Kind("mavlink", "services.autopilot.mavlink.build", "MAVLink over UDP for ground stations", clock="wall", nice=5),
    Kind("gcs", "services.gcs.build", "the page at http://127.0.0.1:8080", clock="wall", nice=10),
)
INFRASTRUCTURE = ("router", "conductor", "recorder")


def kind(name: str) -> Kind:
    """The service kind of this name. Raises BadInput for an unknown name."""
    found = next((k for k in KINDS if k.name == name), None)
    if found is None:
        raise BadInput(f"no service '{name}'; {nearest(name, [k.name for k in KINDS])}")
    return found


def needed(site: Scenario) -> list[Kind]:
    """The service kinds that have work in a mission."""
    kinds: set[str] = {member.file.kind for member in site.members.values()}
    asked = {name for member in site.members.values() for name in member.file.params}
    kinds |= {"team"} if len(site.mapping) > 1 else set()
    kinds |= {"program"} if any(member.entry.program for member in site.members.values()) else set()
    kinds |= {"tasks"} if site.mission.tasks else set()
    return [k for k in KINDS if k.needs in ("any", *kinds) or (k.needs == "asked" and k.name in asked)]


def hosts(site: Scenario, kinds: Sequence[Kind], vehicle: str | None = None) -> list[ServiceInstance]:
    """The service instances of these kinds; ``vehicle`` keeps only those of one vehicle."""
    if vehicle is not None and vehicle not in site.members:
        raise BadInput(f"no vehicle '{vehicle}' in {site.mission_path}; {nearest(vehicle, site.members)}")
    made: list[ServiceInstance] = []
    for each in kinds:
        build: Build = importlib.import_module(each.build).build
        built = [_in_mission(site, host) for host in build(site)]
        wanted = [host for host in built if vehicle is None or host.vehicle == vehicle]
        if built and not wanted:
            raise BadInput(f"{each.name} has nothing of its own for '{vehicle}': it serves all vehicles together; leave --vehicle out")
        made += wanted
    return made


def _in_mission(site: Scenario, host: ServiceInstance) -> ServiceInstance:
    """The mission says which vehicle is whose leader, and whose link is cut."""
    roles = site.members[host.vehicle].entry.roles if host.vehicle else host.roles
    return replace(host, roles=roles, faults=tuple(site.mission.faults))
