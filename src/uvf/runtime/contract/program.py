"""A service that somebody has written for a vehicle of a mission: it runs with the others, in lockstep too, and is recorded."""

from uvf.models.scenario import MissionVehicle
from uvf.runtime.contract.service import Service


class Program(Service):
    """Base of such services: one instance for each vehicle whose ``program`` in the mission names the file.

    Parameters come from the mission: ``self.params = vehicle.params(self.name, OwnParams)``, where ``OwnParams`` derives from ``Params``.
    """

    def __init__(self, vehicle: MissionVehicle) -> None:
        """vehicle: its entry in the mission, and its file."""
        self.vehicle = vehicle
