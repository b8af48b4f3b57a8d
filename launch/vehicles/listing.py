"""Vehicles as text: the list of them, one with its figures, its tree of links."""

from collections.abc import Iterator
from pathlib import Path

from rich.table import Table
from rich.tree import Tree

from uvf.maths.se3 import Transform
from uvf.models.checks.sensor_rules import mounted
from uvf.models.urdf.robot import UrdfModel
from uvf.models.vehicle.file import GroundBody, VehicleFile, load_vehicle
from uvf.models.yaml_data import BadInput


def vehicle_table(vehicles: Path) -> Table:
    """All vehicles of a folder, a row each; an unreadable one has its error in the row."""
    table = Table("vehicle", "kind", "size", "sensors", "about")
    for path in sorted(vehicles.glob("*/vehicle.yaml")):
        try:
            file = load_vehicle(vehicles, path.parent.name)
        except BadInput as error:
            table.add_row(path.parent.name, "?", "", "", str(error))
            continue
        size = f"{2 * file.ground.radius:.2f} m" if file.ground is not None else ""
        table.add_row(path.parent.name, file.kind, size, ", ".join(_fitted(file)), file.about)
    return table


def vehicle_figures(file: VehicleFile, model: UrdfModel | None) -> Table:
    """A vehicle's sizes, limits and sensors."""
    table = Table(show_header=False, box=None)
    table.add_row("about", file.about)
    if file.variant_of is not None:
        table.add_row("variant of", file.variant_of)
    if file.ground is not None:
        for name, text in _ground_rows(file.ground):
            table.add_row(name, text)
    if model is not None:
        mass = sum(link.inertial.mass for link in model.links.values() if link.inertial is not None)
        table.add_row("mass", f"{mass:.3g} kg")
    for kind in _fitted(file):
        table.add_row("sensor", kind)
    return table


def _ground_rows(ground: GroundBody) -> Iterator[tuple[str, str]]:
    drive = ground.drive
    turning = f", turns as with {drive.kinematics.track:g} m" if drive.scrubs else ""
    sideways = ", goes sideways" if drive.kinematics.goes_sideways else ""
    sizes = f"{len(drive.joints)} wheels of radius {drive.wheel_radius:g} m, {drive.width:g} m apart"
    yield "drive", f"{drive.kind}, {sizes}{turning}{sideways}"
    yield "body", f"within {ground.radius:g} m of base_link"
    yield (
        "limits",
        (
            f"{ground.max_linear:g} m/s, {ground.max_angular:g} rad/s; "
            f"{ground.max_linear_acceleration:g} m/s^2, {ground.max_angular_acceleration:g} rad/s^2"
        ),
    )
    yield "motors", f"{ground.motor.stall_torque:g} N m at stall, {ground.motor.no_load_speed:g} rad/s without load"


def _fitted(file: VehicleFile) -> list[str]:
    single = ("lidar", "imu", "encoders", "gnss", "air_data", "camera", "chase", "gimbal")
    names = [kind for kind in single if getattr(file.sensors, kind) is not None]
    several = ("other_lidars", "sonars", "rangefinders", "bumpers")
    lists = [f"{len(found)} {kind.replace('_', ' ')}" for kind in several if (found := getattr(file.sensors, kind))]
    return [*names, *lists]


def frame_tree(model: UrdfModel, file: VehicleFile) -> Tree:
    """The tree of base_footprint, base_link, links and sensors, each with its position in base_link [m]."""
    poses = model.link_poses()
    tree = Tree("base_footprint")
    root = model.roots[0] if model.roots else ""
    top = _grown(tree, model, root, poses) if root else tree
    for _, sensor in mounted(file.sensors):
        if sensor.frame not in poses:
            top.add(f"{sensor.frame}  {_place(sensor.mount.xyz)}  (sensor)")
    return tree


def _grown(tree: Tree, model: UrdfModel, link: str, poses: dict[str, Transform]) -> Tree:
    joint = model.parents.get(link)
    how = f"  ({joint.kind} {joint.name})" if joint is not None else ""
    place = _place(poses[link].translation) if link in poses else ""
    branch = tree.add(f"{link}  {place}{how}")
    for below in model.joints.values():
        if below.parent == link and below.child in poses:
            _grown(branch, model, below.child, poses)
    return branch


def _place(xyz: object) -> str:
    x, y, z = (round(float(v), 3) + 0.0 for v in xyz)  # type: ignore[attr-defined]
    return f"{x:g} {y:g} {z:g}"
