"""Makes the autopilots of followers, for stations that can be kept."""

import math

from services.autopilot.air.config import AutopilotConfig
from services.autopilot.air.formation.wingman import AutopilotWingman
from services.autopilot.air.modes.follower import FormationLink
from uvf.guidance.formation_slot import FormationSlot
from uvf.models.mission.formation import Follow, chain_of, offset_of
from uvf.models.scenario import Scenario
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.contract.instances import ServiceInstance

NEAREST = 1.0  # s behind a leader: what lies ahead of the follower has to be known


def wingman(site: Scenario, config: AutopilotConfig, params: AirParams) -> ServiceInstance:
    """Of an aircraft that follows. Raises BadInput for a station that cannot be kept."""
    follow = site.members[config.name].entry.job.follow
    assert follow is not None
    _check(site, config.name, follow, params)
    station = FormationSlot(follow.behind, follow.right, follow.above)
    return ServiceInstance(
        AutopilotWingman, lambda: AutopilotWingman(config, params, FormationLink(config.name, follow.leader, station)), config.name
    )


def _check(site: Scenario, name: str, follow: Follow, params: AirParams) -> None:
    """Raises BadInput for one that cannot be kept or is too near to another one."""
    place = FileLocation(str(site.mission_path)).at("vehicles", name, "job", "follow")
    if site.members[follow.leader].file.kind != "fixed_wing":
        raise BadInput(f"{place.at('leader')}: {follow.leader} is no aircraft; only aircraft are followed")
    if follow.behind < NEAREST * params.trim_airspeed:
        least = NEAREST * params.trim_airspeed
        raise BadInput(f"{place.at('behind')}: {follow.behind:g} m is too near behind {follow.leader}; give {least:g} m or more")
    follows = {n: m.entry.job.follow for n, m in site.members.items() if m.entry.job.follow is not None}
    own = offset_of(name, follows)
    first = chain_of(name, follows)[-1]
    for other in site.members:
        if other != name and first in (other, *chain_of(other, follows)):
            apart = math.dist(own, offset_of(other, follows))
            if apart < params.follow_sep:
                raise BadInput(f"{place}: {apart:.1f} m from {other}; stations of a formation are {params.follow_sep:g} m apart or more")
