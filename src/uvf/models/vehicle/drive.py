"""What moves a ground vehicle: which wheels, where they are, and how it turns by them. One kind of drive is one type."""

from math import atan
from typing import Annotated

import msgspec
from msgspec import Meta

from uvf.maths.kinematics import DifferentialDrive, DriveKinematics
from uvf.maths.wheels.omnidirectional import OmnidirectionalDrive, RollerWheel, mecanum_wheels
from uvf.maths.wheels.steered import AckermannDrive
from uvf.models.keys import key, plain
from uvf.models.quantities import Angle, Positive
from uvf.models.yaml_data import BadInput, FileLocation

KIND, DEFAULT = "kind", "differential"
JointName = Annotated[str, Meta(min_length=1, max_length=80)]
Coordinate = Annotated[float, Meta(ge=-1e3, le=1e3)]
Steering = Annotated[float, Meta(gt=0.01, lt=1.5)]


class DriveFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field=KIND):
    """What all drives have. ``joints``: of the driven wheels; the order of all that is told wheel by wheel."""

    wheel_radius: Annotated[Positive, key("m", "Radius of the driven wheels; within 3 % of the URDF's.")]

    @property
    def kind(self) -> str:
        """As in the file."""
        return str(self.__struct_config__.tag)

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the driven wheels' joints."""
        raise NotImplementedError

    @property
    def on_left(self) -> tuple[bool, ...]:
        """Of each of them, whether it is a wheel of the left side."""
        raise NotImplementedError

    @property
    def channels(self) -> tuple[int, ...]:
        """Of each of them, the number of the speed that it turns at, and whose counts its encoder's are part of."""
        return tuple(0 if left else 1 for left in self.on_left)

    @property
    def holds_at(self) -> tuple[float, ...] | None:
        """Of wheels with rollers, the direction in which each holds, from that in which it rolls [rad]; None: tyres."""
        return None

    @property
    def steered_wheels(self) -> dict[str, str]:
        """Of wheels that are steered and not driven, the joint that steers -> that on which the wheel turns."""
        return {}

    @property
    def all_wheels(self) -> tuple[str, ...]:
        """Names of the joints on which wheels turn, the driven ones first."""
        return (*self.joints, *self.steered_wheels.values())

    @property
    def scrubs(self) -> bool:
        """Whether wheels slip across when it turns."""
        return False

    @property
    def rolls_to(self) -> tuple[float, ...]:
        """Of each wheel, the direction in which it rolls [rad]; 0 = forward."""
        return (0.0,) * len(self.joints)

    @property
    def width(self) -> float:
        """m, from the leftmost to the rightmost contact point."""
        raise NotImplementedError

    @property
    def kinematics(self) -> DriveKinematics:
        """Wheel speeds and motion of the vehicle."""
        raise NotImplementedError


class OneAxle(DriveFile, frozen=True):
    """One driven wheel on each side."""

    left: Annotated[JointName, plain("Joint of the left wheel in the URDF.")]
    right: Annotated[JointName, plain("Joint of the right wheel in the URDF.")]
    track: Annotated[Positive, key("m", "Distance between the wheels' contact points; within 3 % of the URDF's.")]

    @property
    def joints(self) -> tuple[str, ...]:
        """Left and right."""
        return self.left, self.right

    @property
    def on_left(self) -> tuple[bool, ...]:
        """Left and right."""
        return True, False

    @property
    def width(self) -> float:
        """The track [m]."""
        return self.track


class DifferentialDriveFile(OneAxle, frozen=True, tag=DEFAULT):
    """`kind: differential`, which may be left out: one driven wheel on each side."""

    @property
    def kinematics(self) -> DriveKinematics:
        """Of the two wheels."""
        return DifferentialDrive(self.wheel_radius, self.track)


class AckermannFile(OneAxle, frozen=True, tag="ackermann"):
    """`kind: ackermann`: a car or a tricycle. Its driven wheels stay straight; one or more wheels before or behind them are steered."""

    wheelbase: Annotated[
        Positive, key("m", "Distance from the straight axle to the contact points of the steered wheels; within 3 % of the URDF's.")
    ]
    steered: Annotated[
        dict[JointName, JointName],
        plain("The steered wheels by their joints in the URDF: the joint that steers, upright, and that on which the wheel turns."),
    ]
    max_steering: Annotated[Steering, key("rad", "Largest steering, of a wheel in the middle between the steered ones.")]
    steering_rate: Annotated[Positive, key("rad/s", "How fast the steering turns.")]

    @property
    def steered_wheels(self) -> dict[str, str]:
        """As in the file."""
        return self.steered

    @property
    def kinematics(self) -> AckermannDrive:
        """Of the straight axle and the steering."""
        return AckermannDrive(self.wheel_radius, self.track, self.wheelbase, self.max_steering)


class SeveralWheels(DriveFile, frozen=True):
    """Several wheels on each side, none of which can be steered."""

    left: Annotated[list[JointName], plain("Joints of all left wheels in the URDF, from the front.")]
    right: Annotated[list[JointName], plain("Joints of all right wheels in the URDF, from the front.")]
    track: Annotated[Positive, key("m", "Distance between the contact points of left and right wheels; within 3 % of the URDF's.")]

    @property
    def joints(self) -> tuple[str, ...]:
        """Those of the left side first, from the front."""
        return (*self.left, *self.right)

    @property
    def on_left(self) -> tuple[bool, ...]:
        """The left side first."""
        return (True,) * len(self.left) + (False,) * len(self.right)

    @property
    def width(self) -> float:
        """The track [m]."""
        return self.track


class SkidSteerFile(SeveralWheels, frozen=True, tag="skid_steer"):
    """`kind: skid_steer`: several wheels on each side, all of a side at one speed, which scrub as it turns."""

    effective_track: Annotated[
        Positive,
        key("m", "Track of the two wheels that turn as all of them do, scrubbing included; `vehicle check` works it out."),
    ]

    @property
    def scrubs(self) -> bool:
        """Yes."""
        return True

    @property
    def kinematics(self) -> DriveKinematics:
        """Of the two wheels that turn as all of them do."""
        return DifferentialDrive(self.wheel_radius, self.effective_track)


class MecanumFile(SeveralWheels, frozen=True, tag="mecanum"):
    """`kind: mecanum`: two wheels on each side with rollers at 45 degrees whose axes form an X from above; it drives sideways, too."""

    wheelbase: Annotated[Positive, key("m", "Distance between the contact points of front and rear wheels; within 3 % of the URDF's.")]

    @property
    def wheels(self) -> tuple[RollerWheel, ...]:
        """In the order of the joints."""
        return mecanum_wheels(self.track, self.wheelbase)

    @property
    def channels(self) -> tuple[int, ...]:
        """Each its own."""
        return tuple(range(4))

    @property
    def holds_at(self) -> tuple[float, ...] | None:
        """45 degrees one way or the other [rad]."""
        return tuple(wheel.roller for wheel in self.wheels)

    @property
    def kinematics(self) -> DriveKinematics:
        """Of the four wheels."""
        return OmnidirectionalDrive(self.wheel_radius, self.wheels)


class OmniWheel(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where an omni wheel stands and where it rolls to, in base_link; across that its rollers let it slide."""

    x: Annotated[Coordinate, key("m", "Contact point, forward.")]
    y: Annotated[Coordinate, key("m", "Contact point, left.")]
    heading: Annotated[Angle, key("rad", "Direction in which it rolls when its joint turns forward; 0 = forward, counter-clockwise.")]


class OmniFile(DriveFile, frozen=True, tag="omni"):
    """`kind: omni`: three or more omni wheels that stand any way; it drives sideways, too."""

    wheels: Annotated[dict[str, OmniWheel], plain("The wheels by their joints in the URDF.")]

    @property
    def joints(self) -> tuple[str, ...]:
        """As in the file."""
        return tuple(self.wheels)

    @property
    def on_left(self) -> tuple[bool, ...]:
        """Those at y > 0."""
        return tuple(wheel.y > 0.0 for wheel in self.wheels.values())

    @property
    def channels(self) -> tuple[int, ...]:
        """Each its own."""
        return tuple(range(len(self.wheels)))

    @property
    def holds_at(self) -> tuple[float, ...] | None:
        """In the direction in which each rolls."""
        return (0.0,) * len(self.wheels)

    @property
    def rolls_to(self) -> tuple[float, ...]:
        """As in the file [rad]."""
        return tuple(wheel.heading for wheel in self.wheels.values())

    @property
    def width(self) -> float:
        """m, from the leftmost to the rightmost one."""
        sides = [wheel.y for wheel in self.wheels.values()]
        return max(sides) - min(sides)

    @property
    def kinematics(self) -> OmnidirectionalDrive:
        """Of all wheels."""
        return OmnidirectionalDrive(self.wheel_radius, tuple(RollerWheel(w.x, w.y, w.heading) for w in self.wheels.values()))


AnyDrive = DifferentialDriveFile | SkidSteerFile | MecanumFile | OmniFile | AckermannFile
"""The first is the one that is meant where no kind is given."""


def check_drive(drive: DriveFile, place: FileLocation) -> None:
    """Raises BadInput."""
    seen: set[str] = set()
    for name in (*drive.all_wheels, *drive.steered_wheels):
        if name in seen:
            raise BadInput(f"{place}: the joint {name} is named twice; each wheel has joints of its own")
        seen.add(name)
    if isinstance(drive, SeveralWheels):
        _check_sides(drive, place)
    if isinstance(drive, OmniFile):
        _check_omni(drive, place)
    if isinstance(drive, AckermannFile):
        _check_car(drive, place)


def _check_sides(drive: SeveralWheels, place: FileLocation) -> None:
    if len(drive.left) != len(drive.right):
        raise BadInput(f"{place.at('right')}: {len(drive.right)} of them, but {len(drive.left)} on the left side; give as many")
    if len(drive.left) < 2:
        raise BadInput(f"{place.at('left')}: {len(drive.left)} of them; give all wheels of the side, or write kind: {DEFAULT}")
    if isinstance(drive, MecanumFile) and len(drive.left) != 2:
        raise BadInput(f"{place.at('left')}: {len(drive.left)} of them; a mecanum drive has a front and a rear wheel on each side")


def _check_omni(drive: OmniFile, place: FileLocation) -> None:
    if len(drive.wheels) < 3:
        raise BadInput(f"{place.at('wheels')}: {len(drive.wheels)} of them; a vehicle that drives sideways and turns needs three")
    if not drive.kinematics.is_complete:
        raise BadInput(f"{place.at('wheels')}: so placed they do not drive it forward, sideways and round, each by itself; check headings")


def _check_car(drive: AckermannFile, place: FileLocation) -> None:
    """The innermost wheel must not stand nearer to the turn's centre than the axle is wide."""
    if not drive.steered:
        raise BadInput(f"{place.at('steered')}: no wheel is steered; name the joints of at least one, or write kind: {DEFAULT}")
    tightest, half = drive.kinematics.turning_radius, drive.track / 2
    if tightest <= half:
        raise BadInput(
            f"{place.at('max_steering')}: {drive.max_steering:g} rad: the centre of the turn would lie {tightest:.3g} m from the middle of "
            f"the axle, between its wheels; {atan(drive.wheelbase / half):.3g} is too much already"
        )
