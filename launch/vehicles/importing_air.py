"""``uvf vehicle import`` of a JSBSim aircraft: its files, and a vehicle.yaml of what the running model shows."""

import math
import shutil
import tempfile
from pathlib import Path
from typing import Any

import msgspec
import yaml

from launch.vehicles.air_design import modelled, timing
from launch.vehicles.aircraft_rules import SEA_LEVEL, GroundStance, stands
from launch.vehicles.aircraft_trial import tried
from launch.vehicles.autopilot_guess import autopilot_figures, three_digits
from launch.vehicles.tuning import rounded
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.spin_up import FUEL_FREEZE
from uvf.control.design.design_axes import GAINS
from uvf.control.design.gain_start import begun
from uvf.maths.atmosphere import RHO0
from uvf.maths.geodesy import GRAVITY
from uvf.models.importing.jsbsim import copy_model, has_actuators
from uvf.models.importing.notes import Notes
from uvf.models.jsbsim.model_file import burns_fuel, steers_by_brakes, weight_and_wing
from uvf.models.vehicle.air import AirBody, CommandProperties, Lever
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import BadInput
from uvf.runtime.process.subprocess_jobs import Died, run_in_subprocess

NOTES = "import.txt"
LIFT = 0.4  # coefficient at which the speed is first tried
GEAR = {"nose_wheel": "wheels, one of them under its nose", "tail_wheel": "wheels, one of them under its tail", "belly": "its belly"}
PUSH = 6.0  # m/s^2, by which a throw or a bungee is felt
BRAKE_STEERING = 2.5  # per rad of rudder
LAND_FLAP = 0.3  # of their travel
LIGHT = 50.0  # kg, below which an aircraft has servos of models
MOTOR_LAG = 0.1  # s
SERVOS = {True: (6.0, 0.05), False: (1.0, 0.05)}  # rad/s, s
UNBURNT = {FUEL_FREEZE: 1.0}  # models come with fuel for minutes, or for a day
ALTIMETER = {"mount": {"rpy": [0.0, 1.5708, 0.0]}, "hz": 20.0, "range_min": 0.05, "range_max": 50.0, "noise": 0.03, "frame": "altimeter"}
SENSORS = {
    "imu": {
        **{"mount": {}, "hz": 100.0, "gyro_noise": 0.0023, "gyro_bias": 0.002},
        **{"accel_noise": 0.025, "accel_bias": 0.03, "mag_noise": 5.0e-7},
    },
    "gnss": {"hz": 5.0, "horizontal_noise": 0.8, "vertical_noise": 1.5, "speed_noise": 0.1, "latency": 0.1},
    "rangefinders": [ALTIMETER],
    "air_data": {"hz": 50.0, "static_noise": 3.0, "differential_noise": 4.0, "static_bias": 15.0, "differential_bias": 3.0},
}


def import_aircraft(path: Path, folder: Path) -> list[str]:
    """Imports the JSBSim model at ``path`` into ``folder``; returns the notes. Raises BadInput where JSBSim refuses the model."""
    with tempfile.TemporaryDirectory() as scratch:
        made = Path(scratch) / folder.name
        made.mkdir()
        model = copy_model(path, made)
        try:
            data, lines = run_in_subprocess(_described, str(made), model)
        except BadInput as error:
            raise BadInput(str(error).replace(str(made / model / f"{model}.xml"), str(path))) from error
        except Died as error:
            raise BadInput(f"{path}: JSBSim ends the process with this model ({error}); mend the model") from error
        data["about"] = f"{path.stem}, imported from {path.name} of JSBSim"
        (made / "vehicle.yaml").write_text(yaml.safe_dump(data, sort_keys=False, width=140), encoding="utf-8")
        text = "\n".join([f"Imported from {path.name}:", *(f"- {line}" for line in lines)]) + "\n"
        (made / NOTES).write_text(text, encoding="utf-8")
        folder.parent.mkdir(parents=True, exist_ok=True)
        shutil.copytree(made, folder)
    return lines


def _described(vehicle: str, model: str) -> tuple[dict[str, Any], list[str]]:
    """vehicle: path of its folder. What its file says, and the notes."""
    folder, notes = Path(vehicle), Notes()
    mass, wing = weight_and_wing(folder / model / f"{model}.xml")
    own = has_actuators(folder / model / f"{model}.xml")
    rate, lag = (None, 0.0) if own else SERVOS[mass < LIGHT]
    speed = float(f"{math.sqrt(2 * mass * GRAVITY / (RHO0 * wing * LIFT)):.2g}")
    controls = CommandProperties(throttle=Lever(lag=0.0 if own else MOTOR_LAG))
    fuel = UNBURNT if burns_fuel(folder / model / f"{model}.xml") else {}
    first = AirBody(model=model, physics_hz=120.0, trim_speed=speed, servo_rate=rate, servo_lag=lag, controls=controls, settings=fuel)
    if fuel:
        notes.add("guessed: its fuel does not burn away, its mass stays as it is tuned; take this setting out to fly by the tanks", *fuel)
    body = tried(folder, first, notes)
    guessed = f"guessed: servos of {rate} rad/s with a lag of {lag:g} s, a motor of {MOTOR_LAG:g} s"
    servos = "found: servos in the model" if own else guessed
    notes.add(f"{servos}; guessed: sensors, among them a range finder for landings, and the sink rate that the landing gear holds")
    stance = stands(folder, body, body.physics_hz)
    if stance is not None:
        body = msgspec.structs.replace(body, skids=stance.skids)
    data: dict[str, Any] = {"kind": "fixed_wing", "about": "", "air": _air(body), "sensors": SENSORS}
    if figures := _autopilot(folder, body, stance, notes):
        data["params"] = {"autopilot_air": figures}
    return data, notes.lines()


def _air(body: AirBody) -> dict[str, Any]:
    """Only what differs from the defaults."""
    controls = {}
    for name in body.controls.__struct_fields__:
        own, usual = (msgspec.to_builtins(getattr(c, name)) for c in (body.controls, CommandProperties()))
        if different := {key: value for key, value in own.items() if value != usual[key]}:
            controls[name] = different
    keys = ("model", "physics_hz", "trim_speed", "servo_rate", "servo_lag")
    given = {key: value for key in ("settings", "skids") if (value := getattr(body, key))}
    return {key: getattr(body, key) for key in keys} | {"controls": controls} | given


def _gear(path: Path, stance: GroundStance, body: AirBody, notes: Notes) -> dict[str, float | str]:
    """Autopilot parameters of how it stands, takes off and lands."""
    up = f"its nose {abs(math.degrees(stance.pitch)):.0f} degrees {'up' if stance.pitch >= 0 else 'down'}"
    on = GEAR[stance.gear]
    notes.add(f"found: it stands {stance.height:.2f} m high on {on}, {up}")
    figures: dict[str, float | str] = {
        "gear_height": three_digits(stance.height),
        "gear": stance.gear,
        "rest_pitch": three_digits(stance.pitch),
    }
    if steers_by_brakes(path):
        notes.add("found: no wheel follows its rudder; on the ground it is steered by its brakes")
        figures["brake_steering"] = BRAKE_STEERING
    if stance.gear == "belly":
        notes.add("it has no wheels: it is thrown, by 'launch' under 'start' of a mission, and slides on", ", ".join(stance.skids))
        figures["launch_push"] = PUSH
    flap = body.controls.flap.limit
    return figures | ({"land_flap": three_digits(LAND_FLAP * flap)} if flap > 0 else {})


def _autopilot(folder: Path, body: AirBody, stance: GroundStance | None, notes: Notes) -> dict[str, float | str]:
    airframe = Airframe(folder, body, SEA_LEVEL)
    if not airframe.powered:
        notes.add("it has no engine, and glides: the autopilot holds its airspeed and its path over the ground, and no height")
    try:
        figures = autopilot_figures(airframe, body)
        known = msgspec.structs.replace(AirParams(), **figures)
        aircraft = modelled(airframe, body, known)
        params = rounded(begun(aircraft.loops, known))
    except BadInput as error:
        notes.add(f"no autopilot figures: {str(error).rpartition('.xml: ')[2]}")
        return {}
    notes.add("found: the autopilot's figures of the airframe, from steady flights and linear models; its gains are by rule of thumb")
    unstable = [loop for loop in aircraft.loops.loops(params) if not loop.stable]
    if unstable:
        notes.add(f"with these gains it is unstable at {unstable[0].airspeed:.0f} m/s")
    notes.add("'uvf vehicle tune NAME --write' designs its gains and shows their margins")
    gains = {name: getattr(params, name) for name in GAINS}
    path = folder / body.model / f"{body.model}.xml"
    leads = {name: three_digits(value) for name, value in timing(aircraft, params, body.controls.aileron.limit).items()}
    return figures | gains | leads | (_gear(path, stance, body, notes) if stance else {})
