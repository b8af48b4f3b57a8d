"""What the planners of the command line share: the aircraft, its airspeed, and how a mission file is written."""

from dataclasses import dataclass
from pathlib import Path

from launch.vehicles.inspection import folder_of
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import VehicleFile, load_vehicle
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import BadInput, convert

WAYPOINT_ERROR = 5.0  # m


def load_aircraft(vehicle: str, errand: str) -> tuple[VehicleFile, AirParams]:
    """A vehicle that flies, and its autopilot's parameters; errand: what needs it, for the refusal of others. Raises BadInput."""
    folder = folder_of(vehicle, ROOT / "vehicles")
    file = load_vehicle(folder.parent, folder.name)
    if file.air is None:
        raise BadInput(f"vehicle '{vehicle}' is no aircraft; {errand} needs one, such as milvus")
    return file, convert(file.params.get("autopilot_air", {}), AirParams, str(folder / "vehicle.yaml"), ("params", "autopilot_air"))


def airspeed_of(vehicle: str, params: AirParams, wished: float | None) -> float:
    """The airspeed [m/s] that is wished, or the trimmed one. Raises BadInput for one that the aircraft does not fly."""
    airspeed = wished or params.trim_airspeed
    if not params.min_airspeed <= airspeed <= params.max_airspeed:
        raise BadInput(f"an airspeed of {airspeed:g} m/s; {vehicle} flies {params.min_airspeed:g} to {params.max_airspeed:g} m/s")
    return airspeed


@dataclass(frozen=True)
class MissionText:
    """A mission file of one aircraft.

    duration: s; wind: [m/s], east and north; name: of the vehicle in the mission; start, rows: as YAML;
    fence: rows of the vehicle, or none.
    """

    about: str
    world: str
    seed: int
    duration: float
    wind: tuple[float, float]
    name: str
    vehicle: str
    start: str
    rows: list[str]
    legs: int
    fence: str = ""

    def __str__(self) -> str:
        """The file."""
        wind = f"wind: {{steady: [{self.wind[0]:g}, {self.wind[1]:g}, 0.0]}}\n" if any(self.wind) else ""
        rows = "\n".join(f"        - {row}" for row in self.rows)
        return (
            f"about: {self.about}\nworld: {self.world}\nseed: {self.seed}\nduration: {self.duration:.0f}.0\n{wind}\n"
            f"vehicles:\n  {self.name}:\n    model: {Path(self.vehicle).name}\n    system_id: 1\n"
            f"    start: {self.start}\n{self.fence}    job:\n      mission:\n{rows}\n\n"
            f"criteria:\n  - {{vehicle: {self.name}, measure: legs, at_least: {self.legs}}}\n"
            f"  - {{vehicle: {self.name}, measure: waypoint_error, at_most: {WAYPOINT_ERROR}}}\n"
        )
