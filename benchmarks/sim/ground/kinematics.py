"""Each ground vehicle's simulated drives against the closed form: straight, arcs of three radii, a turn on the spot, one wheel stopped.

Cars drive the arcs that they can, and no more.

The wheels are commanded by the vehicle's own acceleration limits from rest to rest on the level floor; the closed form is the chain
of arcs of these commands. ``position %`` is the distance between both ends over the way of the faster wheel, ``heading %`` the
difference of headings over the turn (over a full turn where there is none). ``slip %`` is that part of the position's error that is
left when the closed form is fed with the wheels' true angles: what tyres lose; the rest is the motors'. ``creep %`` is the way that
the wheels turned without moving the vehicle along, over theirs.
"""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np

from services.sim_ground.loading import BodyPlacement
from services.sim_ground.world import BulletWorld
from uvf.control.steered_ramp import velocity_ramp
from uvf.maths.kinematics import Twist, WheelSpeeds, move
from uvf.maths.rotations import to_euler, wrap
from uvf.maths.se2 import Pose2
from uvf.models.scenario import ROOT
from uvf.models.urdf.model import engine_urdf
from uvf.models.vehicle.file import GroundBody, load_vehicle

PICTURE = ROOT / "docs" / "images" / "kinematics.png"
DT = 0.01  # s, between two commands
SHARE = 0.6  # of the vehicle's top speeds
RADII = (0.5, 1.0, 2.0)  # m
REST = 1.0  # s, until the wheels stand


class Drive(NamedTuple):
    """A velocity and for how long [s] it is asked for."""

    name: str
    twist: Twist
    seconds: float


class Driven(NamedTuple):
    """Poses at each command: as commanded, as the wheels turned, and true."""

    wanted: list[Pose2]
    rolled: list[Pose2]
    true: list[Pose2]


def ground_vehicles() -> Iterator[tuple[str, GroundBody, Path]]:
    """Name, body and URDF of every ground vehicle."""
    for path in sorted((ROOT / "vehicles").glob("*/vehicle.yaml")):
        ground = load_vehicle(ROOT / "vehicles", path.parent.name).ground
        if ground is not None:
            yield path.parent.name, ground, path.parent / ground.urdf


def drives(body: GroundBody) -> Iterator[Drive]:
    """At constant speed after the ramp; the times are those of the speed that is asked for."""
    linear, angular = SHARE * body.max_linear, SHARE * body.max_angular
    yield Drive("straight 10 m", Twist(linear, 0.0), 10.0 / linear)
    tightest = body.drive.kinematics.turning_radius
    for radius in (r for r in RADII if r > tightest):
        speed = min(linear, radius * angular)
        yield Drive(f"arc {radius:g} m", Twist(speed, speed / radius), np.pi * radius / speed)
    if tightest:
        return
    yield Drive("spot turn", Twist(0.0, angular), 2 * np.pi / angular)
    turning = min(angular, linear / (body.drive.track / 2))
    yield Drive("left wheel stopped", Twist(turning * body.drive.track / 2, turning), 2 * np.pi / turning)


def drive(body: GroundBody, urdf: Path, wanted: Drive) -> Driven:
    """One drive in PyBullet alone: poses asked for, rolled by the wheels, and true."""
    world = BulletWorld([], {"one": BodyPlacement(body, engine_urdf(urdf), (0.0, 0.0, 0.0))})
    wheels, ramp = body.drive.kinematics, velocity_ramp(_with_curvature_kept(body, wanted.twist))
    first = _pose(world)
    driven = Driven([first], [first], [first])
    before = world.state("one").wheel_angles
    for n in range(round((wanted.seconds + REST) / DT)):
        asked = wanted.twist if n * DT < wanted.seconds else Twist(0.0, 0.0)
        command = ramp.lead(asked, DT)
        world.advance({"one": wheels.wheels(command)}, DT, steering={"one": ramp.steering})
        angles = world.state("one").wheel_angles
        turned = WheelSpeeds(angles[0] - before[0], angles[1] - before[1])
        before = angles
        driven.wanted.append(move(driven.wanted[-1], command, DT))
        driven.rolled.append(move(driven.rolled[-1], wheels.twist(turned), 1.0))
        driven.true.append(_pose(world))
    world.close()
    return driven


def _with_curvature_kept(body: GroundBody, twist: Twist) -> GroundBody:
    """With accelerations so low that speed and turn are reached together."""
    linear, angular = body.max_linear_acceleration, body.max_angular_acceleration
    if twist.linear and twist.angular:
        rise = max(twist.linear / linear, twist.angular / angular)  # s
        linear, angular = twist.linear / rise, twist.angular / rise
    return msgspec.structs.replace(body, max_linear_acceleration=linear, max_angular_acceleration=angular)


def _pose(world: BulletWorld) -> Pose2:
    state = world.state("one")
    return Pose2(float(state.position[0]), float(state.position[1]), to_euler(state.world_from_body)[2])


def apart(a: Pose2, b: Pose2) -> float:
    """m."""
    return float(np.hypot(a.x - b.x, a.y - b.y))


def figures(body: GroundBody, driven: Driven) -> dict[str, float]:
    """Errors of position and heading, slip and creep [%], as the module states them."""
    wheels = body.drive.kinematics
    wanted, rolled, true = driven
    turn = sum(wrap(q.yaw - p.yaw) for p, q in pairwise(wanted))
    missed = sum(wrap(q.yaw - p.yaw) for p, q in pairwise(true)) - turn
    way = sum(apart(p, q) for p, q in pairwise(wanted)) + abs(turn) * wheels.track / 2
    went = sum(apart(p, q) for p, q in pairwise(true)) + abs(turn + missed) * wheels.track / 2
    rolling = sum(apart(p, q) + abs(wrap(q.yaw - p.yaw)) * wheels.track / 2 for p, q in pairwise(rolled))
    return {
        "position %": 100 * apart(wanted[-1], true[-1]) / way,
        "heading %": 100 * abs(missed) / max(abs(turn), 2 * np.pi if turn == 0 else 0.0),
        "slip %": 100 * apart(rolled[-1], true[-1]) / way,
        "creep %": 100 * (rolling - went) / rolling,
    }


def all_drives() -> Iterator[tuple[str, Drive, GroundBody, Driven]]:
    """Every drive of every vehicle: its name, the drive, its body, and how it went."""
    for name, body, urdf in ground_vehicles():
        for wanted in drives(body):
            yield name, wanted, body, drive(body, urdf, wanted)


def vehicles(data: Path | None) -> dict[str, dict[str, float]]:
    """A row for each drive of each vehicle."""
    return {f"{name}: {wanted.name}": figures(body, driven) for name, wanted, body, driven in all_drives()}


CASES = {"vehicles": vehicles}


def main() -> None:
    """Draws docs/images/kinematics.png: closed form as lines, simulated drives as dots."""
    from matplotlib.figure import Figure

    names = [name for name, _, _ in ground_vehicles()]
    figure = Figure(figsize=(12, 3.2 * len(names)), layout="constrained")
    axes = dict(zip(names, figure.subplots(len(names), 2, squeeze=False), strict=True))
    for name, wanted, _, (closed, _, true) in all_drives():
        plot = axes[name][1 if wanted.name in ("spot turn", "left wheel stopped") else 0]
        (line,) = plot.plot(*np.array(closed)[:, :2].T, lw=1, label=wanted.name)
        plot.plot(*np.array(true)[::40, :2].T, ".", ms=5, color=line.get_color())
        plot.set(title=name, xlabel="x [m]", ylabel="y [m]", aspect="equal")
    for plot in (p for row in axes.values() for p in row):
        plot.legend(fontsize="small")
        plot.grid(alpha=0.3)
    figure.savefig(PICTURE, dpi=90)


if __name__ == "__main__":
    main()
