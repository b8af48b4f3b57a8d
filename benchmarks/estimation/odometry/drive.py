"""Simulated drives of a differential-drive vehicle with all that spoils odometry, and the truth beside."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.estimation.odometry.states import Step
from uvf.maths.kinematics import Twist, WheelTravel, move
from uvf.maths.se2 import IDENTITY, Pose2

Floats = NDArray[np.float64]

DT = 0.02  # s
TRACK = 0.2  # m
SPEED, TURN = 0.5, 1.2  # m/s, rad/s, the fastest
RISE, TURN_RISE = 0.6, 3.0  # m/s^2, rad/s^2
HOLD = (1.0, 5.0)  # s that a speed is kept
STOPS = 0.15  # part of the speeds that are none


@dataclass(frozen=True)
class World:
    """1 sigma of what is drawn for each drive, and what is the same for all of them."""

    seconds: float = 120.0
    distance: float = 0.005  # m per square root of m that a wheel rolls
    radius: float = 0.005  # of each wheel's radius
    left: float = 1.0  # true radius over the one that the odometry knows
    right: float = 1.0
    track: float = 1.0
    gyro: float = 3e-4  # rad per square root of s
    gyro_turn: float = 0.003  # rad per square root of rad
    bias: float = 0.02  # rad/s
    bias_walk: float = 3e-5  # rad/s per square root of s
    accel: float = 0.01  # m/s per square root of s
    accel_offset: float = 0.1  # m/s^2
    tick: float = 5e-5  # m
    slips: tuple[tuple[float, float, float, float], ...] = ()
    """begin and end [s], and what the left and the right wheel roll beside the ground [m/s]."""
    has_imu: bool = True


class Moment(NamedTuple):
    """t: s, at the end of the step."""

    t: float
    step: Step
    pose: Pose2
    twist: Twist


def wanted(seconds: float, rng: np.random.Generator) -> Iterator[Twist]:
    """A speed and a turn rate each step, kept for a while, reached by limited accelerations; it begins with a standstill."""
    now, left, goal = Twist(0.0, 0.0), 2.0, Twist(0.0, 0.0)
    for _ in range(round(seconds / DT)):
        left -= DT
        if left < 0.0:
            left = rng.uniform(*HOLD)
            stops = rng.random() < STOPS
            goal = Twist(0.0, 0.0) if stops else Twist(rng.uniform(-0.2, 1.0) * SPEED, rng.choice((0.0, 1.0)) * rng.uniform(-TURN, TURN))
        now = Twist(
            now.linear + float(np.clip(goal.linear - now.linear, -RISE * DT, RISE * DT)),
            now.angular + float(np.clip(goal.angular - now.angular, -TURN_RISE * DT, TURN_RISE * DT)),
        )
        yield now


def drive(world: World, seed: int) -> list[Moment]:
    """What the sensors tell and where the vehicle is, step by step."""
    rng = np.random.default_rng(seed)
    pose, before, moments = IDENTITY, Twist(0.0, 0.0), []
    radii = np.array((world.left, world.right)) * (1.0 + world.radius * rng.standard_normal(2))
    track, bias, offset = TRACK * world.track, world.bias * rng.standard_normal(), world.accel_offset * rng.standard_normal()
    rolled, counted, felt = np.zeros(2), np.zeros(2), 0.0
    for k, after in enumerate(wanted(world.seconds, rng), 1):
        mean = Twist((before.linear + after.linear) / 2, (before.angular + after.angular) / 2)
        pose = move(pose, mean, DT)
        ground = (mean.linear + mean.angular * track / 2 * np.array((-1.0, 1.0))) * DT
        slip = sum((np.array(s[2:]) for s in world.slips if s[0] < k * DT <= s[1]), np.zeros(2)) * DT
        noise = world.distance * np.sqrt(np.abs(ground)) * rng.standard_normal(2)
        rolled += (ground + slip + noise) / radii
        ticks = np.floor(rolled / world.tick) * world.tick
        left, right = (ticks - counted).tolist()
        counted = ticks
        bias += world.bias_walk * np.sqrt(DT) * rng.standard_normal()
        turning = world.gyro_turn * np.sqrt(abs(mean.angular) * DT) + world.gyro * np.sqrt(DT)
        rate = mean.angular + bias + turning / DT * rng.standard_normal()
        force = (after.linear - before.linear) / DT + offset + world.accel / np.sqrt(DT) * rng.standard_normal()
        step = Step(DT, WheelTravel(left, right))
        if world.has_imu:
            step = step._replace(rate=float(rate), force=float(force), jolt=float(force - felt))
            felt = force
        moments.append(Moment(k * DT, step, pose, after))
        before = after
    return moments
