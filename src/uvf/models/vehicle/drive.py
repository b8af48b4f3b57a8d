"""What moves a ground vehicle: which wheels, where they are, and how the vehicle turns by them."""

from typing import Annotated, Literal

import msgspec

from uvf.maths.kinematics import DifferentialDrive
from uvf.models.keys import key, plain
from uvf.models.quantities import Positive
from uvf.models.yaml_data import BadInput, FileLocation

Wheels = str | list[str]  # not of Name: constraints in such a union end some processes with a crash (msgspec issue 717)


class DriveFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The driven wheels, those of a side at one speed."""

    left: Annotated[Wheels, plain("Joint of the left wheel in the URDF; with skid steer the joints of all left wheels.")]
    right: Annotated[Wheels, plain("Joint of the right wheel in the URDF; with skid steer the joints of all right wheels.")]
    wheel_radius: Annotated[Positive, key("m", "Radius of the driven wheels; within 3 % of the URDF's.")]
    track: Annotated[Positive, key("m", "Distance between the contact points of left and right wheels; within 3 % of the URDF's.")]
    kind: Annotated[
        Literal["differential", "skid_steer"],
        plain("`differential` has one driven wheel on each side; `skid_steer` several that cannot be steered and scrub as it turns."),
    ] = "differential"
    effective_track: Annotated[
        Positive | None,
        key("m", "Skid steer: track of the two wheels that turn as all of them do, scrubbing included; `vehicle check` works it out."),
    ] = None

    @property
    def left_joints(self) -> tuple[str, ...]:
        """Names of the left wheels' joints."""
        return _names(self.left)

    @property
    def right_joints(self) -> tuple[str, ...]:
        """Names of the right wheels' joints."""
        return _names(self.right)

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of all driven wheels' joints, those of the left side first."""
        return self.left_joints + self.right_joints

    @property
    def kinematics(self) -> DifferentialDrive:
        """Wheel speeds and motion of the vehicle."""
        return DifferentialDrive(self.wheel_radius, self.effective_track or self.track)


def check_drive(drive: DriveFile, place: FileLocation) -> None:
    """Raises BadInput."""
    if twice := next((name for name in drive.left_joints if name in drive.right_joints), None):
        raise BadInput(f"{place.at('right')}: {twice} is a wheel of the left side too; name the right one")
    if len(drive.left_joints) != len(drive.right_joints):
        raise BadInput(
            f"{place.at('right')}: {len(drive.right_joints)} of them, but {len(drive.left_joints)} on the left side; give as many"
        )
    for side, names in (("left", drive.left_joints), ("right", drive.right_joints)):
        if len(set(names)) < len(names):
            raise BadInput(f"{place.at(side)}: a wheel is named twice")
        if drive.kind == "differential" and len(names) != 1:
            raise BadInput(f"{place.at(side)}: {len(names)} wheels, but a differential drive has one on each side; write kind: skid_steer")
        if drive.kind == "skid_steer" and len(names) < 2:
            raise BadInput(f"{place.at(side)}: one wheel, but skid steer has several on each side; write kind: differential")
    if drive.kind == "differential" and drive.effective_track is not None:
        raise BadInput(f"{place.at('effective_track')}: two wheels do not scrub; leave it out")
    if drive.kind == "skid_steer" and drive.effective_track is None:
        raise BadInput(f"{place.at('effective_track')}: is missing; with four wheels under equal loads it is track + wheelbase^2 / track")


def _names(wheels: Wheels) -> tuple[str, ...]:
    return (wheels,) if isinstance(wheels, str) else tuple(wheels)
