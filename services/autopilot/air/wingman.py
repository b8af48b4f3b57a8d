"""The autopilot of an aircraft that follows another one."""

import math

from schemas import topics
from schemas.messages import NavState
from services.autopilot.air import interface
from services.autopilot.air.config import AutopilotConfig
from services.autopilot.air.modes.follower import FormationLink
from services.autopilot.air.service import AutopilotAir
from uvf.guidance.formation_slot import FormationSlot
from uvf.models.mission.formation import Follow, chain_of, offset_of
from uvf.models.scenario import Scenario
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.contract.declaration import each_vehicle
from uvf.runtime.contract.instances import ServiceInstance


class AutopilotWingman(AutopilotAir):
    """All that an aircraft's autopilot does, and mode Follow: it hears where the others think they are."""

    class Inputs(interface.Inputs):
        others: dict[str, NavState] = each_vehicle(topics.NAV_STATE)

    def __init__(self, config: AutopilotConfig, params: AirParams, formation: FormationLink) -> None:
        super().__init__(config, params)
        self._formation = formation
        self._mode_manager.join(formation)

    def step(self, t: float, now: interface.Inputs) -> interface.Outputs:
        """One cycle at simulation time ``t`` [s]: hears the others, then flies as every aircraft."""
        assert isinstance(now, self.Inputs)
        self._formation.hear(t, now.others)
        return super().step(t, now)


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
