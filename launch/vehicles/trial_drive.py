"""A vehicle's folder driven on a flat floor in the ground simulator's physics: whether it goes where its wheels' kinematics say."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.loading import BodyPlacement
from services.sim_ground.world import BulletWorld
from uvf.control.steered_ramp import velocity_ramp
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import to_euler
from uvf.models.urdf.model import engine_urdf
from uvf.models.vehicle.drive import SkidSteerFile
from uvf.models.vehicle.file import GroundBody, load_vehicle
from uvf.models.yaml_data import FileLocation

Floats = NDArray[np.float64]

STEP = 0.02  # s
STANDS = 2.0  # s after which it has come to a stand
SPEED, TURN_RATE = 0.3, 0.5  # m/s and rad/s of the trial, at most half of what the vehicle can
WAY, TURN = 1.0, 2.0  # m and rad of it
OFF = 0.05  # share of way or turn, beyond which a vehicle does not do what its file says


class Driven(NamedTuple):
    """x, y [m] and the angle turned [rad], simulated and by the wheels' closed-form kinematics; the largest tilt [rad].

    bearing: names of the links beside its wheels with which the vehicle bears on the floor at the end.
    """

    pose: Floats
    expected: Floats
    tilt: float
    bearing: tuple[str, ...]

    @property
    def turned_share(self) -> float:
        """How far it has turned of what its wheels say."""
        return float(self.pose[2] / self.expected[2])

    @property
    def remedy(self) -> str:
        """Where to look for what keeps it from its way."""
        borne = (
            f"beside its wheels {', '.join(self.bearing)} bear on the floor"
            if self.bearing
            else "nothing but its wheels bears on the floor"
        )
        return f"{borne}: look at what these weigh and how they slide, and at the motors"


def drive(folder: Path, twist: tuple[float, ...], duration: float) -> Driven:
    """From a stand, at the accelerations the file allows, for ``duration`` [s], and to a stand again.

    twist: velocity forward [m/s], turn rate [rad/s], and velocity to the left [m/s] where given. Raises BadInput.
    """
    ground = load_vehicle(folder.parent, folder.name).ground
    if ground is None:
        raise ValueError(f"{folder} holds no ground vehicle")
    kinematics = ground.drive.kinematics
    world = BulletWorld([], {"it": BodyPlacement(ground, engine_urdf(folder / ground.urdf), (0.0, 0.0, 0.0))})
    ramp, expected, turned, last, tilt = velocity_ramp(ground), np.zeros(3), 0.0, 0.0, 0.0
    try:
        for i in range(round((duration + STANDS) / STEP)):
            command = ramp.lead(Twist(*twist) if i * STEP < duration else Twist(0.0, 0.0), STEP)
            expected = _rolled(expected, command)
            world.advance({"it": kinematics.wheels(command)}, STEP, steering={"it": ramp.steering})
            state = world.state("it")
            roll, pitch, yaw = to_euler(state.world_from_body)
            turned, last, tilt = turned + (yaw - last + np.pi) % (2 * np.pi) - np.pi, yaw, max(tilt, abs(roll), abs(pitch))
        return Driven(np.array((*state.position[:2], turned)), expected, tilt, tuple(world.bearing("it")))
    finally:
        world.close()


def _rolled(pose: Floats, command: Twist) -> Floats:
    """x, y, yaw after a step along the arc about the ICC."""
    (x, y, yaw), (v, w, aside) = pose, command
    if abs(w) < 1e-9:
        c, s = np.cos(yaw) * STEP, np.sin(yaw) * STEP
        return np.array((x + v * c - aside * s, y + v * s + aside * c, yaw))
    new = yaw + w * STEP
    sines, cosines = (np.sin(new) - np.sin(yaw)) / w, (np.cos(new) - np.cos(yaw)) / w
    return np.array((x + v * sines + aside * cosines, y - v * cosines + aside * sines, new))


def turned_share(folder: Path, body: GroundBody) -> float:
    """How far it turns of what its wheels say: on the spot, or of a car on an arc."""
    return _turned(folder, body).turned_share


def _turned(folder: Path, body: GroundBody) -> Driven:
    tightest = body.drive.kinematics.turning_radius
    speed = min(SPEED, body.max_linear / 2) if tightest else 0.0
    rate = min(TURN_RATE, body.max_angular / 2, *([speed / (2 * tightest)] if tightest else []))
    return drive(folder, (speed, rate), TURN / rate)


def trial_faults(folder: Path, body: GroundBody) -> Iterator[str]:
    """Lines on a straight line and a turn that end elsewhere than the wheels say."""
    place = FileLocation(str(folder / "vehicle.yaml")).at("ground", "drive")
    speed = min(SPEED, body.max_linear / 2)
    straight = drive(folder, (speed, 0.0), WAY / speed)
    x, y, yaw = straight.pose.tolist()
    if abs(x - straight.expected[0]) > OFF * WAY or abs(y) > OFF * WAY:
        yield (
            f"{place}: driven {straight.expected[0]:.2f} m straight on in the simulator it ends at ({x:.2f}, {y:.2f}) m, turned by "
            f"{np.degrees(yaw):.0f} deg: {straight.remedy}"
        )
        return
    turned = _turned(folder, body)
    share = turned.turned_share
    if abs(share - 1.0) <= OFF:
        return
    if isinstance(body.drive, SkidSteerFile) and share > 0.1:
        told, right = body.drive.effective_track, body.drive.effective_track / share
        yield f"{place.at('effective_track')}: {told:g} m, but in the simulator it turns as with {right:.4g} m"
    else:
        yield f"{place}: in the simulator it turns by {100 * share:.0f} % of what its wheels say: {turned.remedy}"
