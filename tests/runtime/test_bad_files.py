"""Mission, vehicle and world files spoiled in every place: each is read, or refused with one line; nothing else."""

import copy
import shutil

import pytest
import yaml

from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.models.world.file import load_world
from uvf.models.yaml_data import BadInput

ABSENT = object()
SPOILS = {
    "absent": ABSENT,
    "none": None,
    "text": "x",
    "a name with /..": "../../x",
    "a line end": "burger\n",
    "a long text": "x" * 5000,
    "a list": [1, "a", None],
    "a mapping": {"x": 1},
    "nan": float("nan"),
    "inf": float("inf"),
    "zero": 0,
    "minus": -1,
    "huge": 1e300,
    "huge whole": 10**30,
    "tiny": 1e-300,
}
FILES = {
    "mission": "missions/demo.yaml",
    "burger": "vehicles/burger/vehicle.yaml",
    "milvus": "vehicles/milvus/vehicle.yaml",
    "world": "worlds/house/world.yaml",
}


def short(data):
    """The file with at most two entries of each list of mappings: they are all alike."""
    if isinstance(data, dict):
        return {key: short(value) for key, value in data.items()}
    if isinstance(data, list):
        return [short(value) for value in (data[:2] if data and isinstance(data[0], dict) else data)]
    return data


def read(name):
    data = short(yaml.safe_load((ROOT / FILES[name]).read_text()))
    if name == "mission":  # the jump is the last of its list
        full = yaml.safe_load((ROOT / FILES[name]).read_text())
        data["vehicles"]["milvus"]["job"]["mission"].append(full["vehicles"]["milvus"]["job"]["mission"][-1])
    return data


def ways(data, way=()):
    """Every key of a file, and the first entry of every list: the others are like it."""
    entries = data.items() if isinstance(data, dict) else enumerate(data[:1]) if isinstance(data, list) else ()
    for key, value in entries:
        yield (*way, key)
        yield from ways(value, (*way, key))


def spoiled(data, way, value):
    data = copy.deepcopy(data)
    inner = data
    for key in way[:-1]:
        inner = inner[key]
    if value is ABSENT:
        del inner[way[-1]]
    else:
        inner[way[-1]] = value
    return data


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    """Shortened copies of the demo's files, whole."""
    root = tmp_path_factory.mktemp("site")
    for folder in ("vehicles/burger", "vehicles/milvus", "worlds/house", "missions"):
        shutil.copytree(ROOT / folder, root / folder)
    for name, file in FILES.items():
        (root / file).write_text(yaml.safe_dump(read(name)))
    load(root)
    return root


def load(root, name="mission"):
    """One file; a mission with all that it names."""
    if name == "mission":
        load_scenario(root / FILES["mission"], root)
    elif name == "world":
        load_world(root / "worlds", "house")
    else:
        load_vehicle(root / "vehicles", name)


@pytest.mark.parametrize(
    ("name", "way"), [(n, w) for n in FILES for w in ways(read(n))], ids=lambda x: x if isinstance(x, str) else ".".join(map(str, x))
)
def test_a_file_spoiled_anywhere_is_read_or_refused_in_one_line(root, name, way):
    path, data = root / FILES[name], read(name)
    whole = path.read_text()
    try:
        for kind, value in SPOILS.items():
            path.write_text(yaml.dump(spoiled(data, way, value), Dumper=yaml.CSafeDumper))
            try:
                load(root, name)
            except BadInput as error:
                assert "\n" not in str(error), kind
                assert str(root) in str(error), kind
    finally:
        path.write_text(whole)


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize(
    "content", [b"", b"- a\n", b"a", b"1", b"\x00\xff\xfe", b"%PDF-1.4 \xe2", b"a: b: c", b"&a [*a]", b"? {a: b}\n: c"]
)
def test_a_file_that_is_something_else_is_refused_in_one_line(root, name, content):
    path = root / FILES[name]
    whole = path.read_text()
    try:
        path.write_bytes(content)
        with pytest.raises(BadInput) as caught:
            load(root)
        assert "\n" not in str(caught.value) and str(path) in str(caught.value)
    finally:
        path.write_text(whole)


MISTAKES = {
    "no vehicles": ({"vehicles": {}}, "vehicles: it has 0 entries; give at least 1 entry"),
    "the system's name": (
        {"vehicles.sys": {"model": "burger", "system_id": 9, "start": {"x": 6.0, "y": 4.4}}},
        "'sys' stands for the system",
    ),
    "a jump too far": ({"vehicles.milvus.job.mission.2.jump_to": 3}, "mission[2]: jumps to 3, but the last item is 2"),
    "no limit": ({"criteria.0": {"vehicle": "burger", "measure": "contacts"}}, "criteria[0]: no limit: give at_least, at_most or both"),
    "no room between limits": ({"criteria.0.at_most": 1.0}, "criteria[0]: at_least 12 is above at_most 1"),
    "two at one place": (
        {"vehicles.other": {"model": "burger", "system_id": 9, "start": {"x": 2.3, "y": 1.3}}},
        "vehicles: other: start: other begins 0.10 m from burger",
    ),
    "off the floor": ({"vehicles.burger.start.x": 12.5}, "start: (12.5, 1.3) is not on the floor of house"),
    "under the ground": ({"vehicles.milvus.start.z": -1.0}, "start: z: -1 m is under the ground"),
    "no world": ({"world": "hose"}, "mistake.yaml:41: world: no world 'hose' in "),
    "a line end in a world's name": ({"world": "house\n"}, "world: 'house ' is not allowed here; a folder has letters"),
    "a line end in a model's name": ({"vehicles.milvus.model": "milvus\n"}, "model: 'milvus ' is not allowed here; a folder has letters"),
    "a line end in a vehicle's name": (
        {"vehicles.other\n": {"model": "burger", "system_id": 9, "start": {"x": 6.0, "y": 4.4}}},
        "'other ' is not allowed here; a name has lower-case letters, digits and _, and begins with a letter",
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mission_that_cannot_be_is_refused_with_file_line_and_mend(root, case):
    changes, why = MISTAKES[case]
    data = read("mission")
    for way, value in changes.items():
        data = spoiled(data, [int(k) if k.isdigit() else k for k in way.split(".")], value)
    path = root / "missions" / "mistake.yaml"
    path.write_text(yaml.safe_dump(data))
    with pytest.raises(BadInput) as caught:
        load_scenario(path, root)
    assert why in str(caught.value)


WORLDS = {
    "a floor of nothing": ("floor", [0, 0, 0, 9], "floor: nothing lies in it"),
    "a floor inside out": ("floor", [9, 0, 0, 9], "floor: nothing lies in it"),
    "a floor without end": ("floor", [0, 0, 9e4, 9e4], "more than 1e+06 m^2"),
    "a box of no size": ("boxes.0.size", [0, 1, 1], "boxes[0]: size[0]"),
    "a pitch in degrees": ("boxes.0.rpy", [0, -5, 0], "boxes[0]: rpy[1]: -5 is below -3.1416: it is in radians (-5 deg = -0.08727)"),
    "two of one name": ("boxes.1.name", "front_door", "boxes[1]: name: 'front_door' is given twice"),
    "a wall of one point": ("walls.0.points", [[0, 0], [0, 0]], "walls[0]: the same point twice"),
}


@pytest.mark.parametrize("case", WORLDS)
def test_a_world_that_cannot_be_is_refused_with_file_line_and_mend(root, case):
    way, value, why = WORLDS[case]
    path = root / FILES["world"]
    whole = path.read_text()
    try:
        path.write_text(yaml.safe_dump(spoiled(read("world"), [int(k) if k.isdigit() else k for k in way.split(".")], value)))
        with pytest.raises(BadInput) as caught:
            load(root)
        assert why in str(caught.value) and f"{path}:" in str(caught.value)
    finally:
        path.write_text(whole)


def in_a_row(*ys):
    """Omni wheels that all roll forward."""
    return {f"wheel_{i}": {"x": 0.1, "y": y, "heading": 0.0} for i, y in enumerate(ys)}


STEERING = {"wheelbase": 0.5, "steered": {"c": "d"}, "max_steering": 0.4, "steering_rate": 2.0}
VEHICLES = {
    "too many beams": ("sensors.lidar.beams", 100_000, "sensors: lidar: beams: 100000 is above 4096"),
    "beams twice round": ("sensors.lidar.angle_increment", 0.04, "360 beams make 14.4 rad, more than a full turn"),
    "ranges inside out": ("sensors.lidar.range_min", 5.0, "range_min: 5 m is not below range_max, 3.5 m"),
    "a mount turned by degrees": ("sensors.lidar.mount.rpy", [0.0, 0.0, 90], "mount: rpy[2]: 90 is above 7: it is in radians"),
    "a rate of zero": ("sensors.imu.hz", 0.0, "sensors: imu: hz: 0 is below 0.01 Hz"),
    "one wheel": (
        "ground.drive.right",
        "wheel_left_joint",
        "drive: the joint wheel_left_joint is named twice; each wheel has",
    ),
    "two wheels that are to scrub": ("ground.drive.kind", "skid_steer", "left: 'wheel_left_joint' is not a list; write [...]"),
    "a kind that there is not": ("ground.drive.kind", "mecanun", "kind: no 'mecanun' here; did you mean 'mecanum'?"),
    "more wheels on one side": (
        "ground.drive",
        {"kind": "mecanum", "left": ["a", "b"], "right": ["c"], "wheel_radius": 0.1, "track": 0.3, "wheelbase": 0.3},
        "right: 1 of them, but 2 on the left side; give as many",
    ),
    "several wheels that are not": (
        "ground.drive",
        {"left": ["a", "b"], "right": ["c", "d"], "wheel_radius": 0.1, "track": 0.3},
        "left: a list is not text; put it in quotes",
    ),
    "three mecanum wheels a side": (
        "ground.drive",
        {"kind": "mecanum", "left": ["a", "b", "c"], "right": ["d", "e", "f"], "wheel_radius": 0.1, "track": 0.3, "wheelbase": 0.3},
        "left: 3 of them; a mecanum drive has a front and a rear wheel on each side",
    ),
    "two omni wheels": (
        "ground.drive",
        {"kind": "omni", "wheel_radius": 0.1, "wheels": in_a_row(0.1, -0.1)},
        "wheels: 2 of them; a vehicle that drives sideways and turns needs three",
    ),
    "omni wheels that all roll forward": (
        "ground.drive",
        {"kind": "omni", "wheel_radius": 0.1, "wheels": in_a_row(0.1, 0.0, -0.1)},
        "wheels: so placed they do not drive it forward, sideways and round, each by itself; check headings",
    ),
    "scrub that is not told": (
        "ground.drive",
        {"kind": "skid_steer", "left": ["a", "b"], "right": ["c", "d"], "wheel_radius": 0.1, "track": 0.3},
        "key 'effective_track' is missing: track of the two wheels that turn as all of them do, scrubbing included",
    ),
    "a car that steers nothing": (
        "ground.drive",
        {"kind": "ackermann", "left": "a", "right": "b", "wheel_radius": 0.1, "track": 0.3, **STEERING, "steered": {}},
        "steered: no wheel is steered; name the joints of at least one, or write kind: differential",
    ),
    "a car that steers too far": (
        "ground.drive",
        {"kind": "ackermann", "left": "a", "right": "b", "wheel_radius": 0.1, "track": 0.3, **STEERING, "max_steering": 1.3},
        "max_steering: 1.3 rad: the centre of the turn would lie 0.139 m from the middle of the axle, between its wheels",
    ),
    "scrub of two wheels": ("ground.drive.effective_track", 0.2, "effective_track: unknown key 'effective_track'; there are: kind, left"),
    "another kind": ("kind", "fixed_wing", "kind is 'fixed_wing' but there is no 'air:' section"),
}


@pytest.mark.parametrize("case", VEHICLES)
def test_a_vehicle_that_cannot_be_is_refused_with_file_line_and_mend(root, case):
    way, value, why = VEHICLES[case]
    path = root / FILES["burger"]
    whole = path.read_text()
    try:
        path.write_text(yaml.safe_dump(spoiled(read("burger"), way.split("."), value)))
        with pytest.raises(BadInput) as caught:
            load(root)
        assert why in str(caught.value) and f"{path}:" in str(caught.value)
    finally:
        path.write_text(whole)


AIRCRAFT = {
    "a motor for more than a full battery": ("air.battery.rated", 60.0, "battery: rated: 60 V, but full it has 50.4 V"),
    "a battery upside down": ("air.battery.empty", 60.0, "empty at 60 V, full at 50.4 V"),
    "a receiver aside": (
        "sensors.gnss",
        {"hz": 5.0, "mount": {"xyz": [1.0, 0.0, 0.0]}},
        "gnss: mount: an aircraft's receiver is at its centre of gravity; leave it out",
    ),
    "wheels with encoders": ("sensors.encoders", {"hz": 10.0, "ticks_per_turn": 100}, "encoders: an aircraft has no encoders"),
    "bumpers": ("sensors.bumpers", [{"name": "a", "angle_min": 0.0, "angle_max": 1.0}], "bumpers: an aircraft has no bumpers"),
    "a sensor on a link": ("sensors.imu.mount", {"link": "nose"}, "link: an aircraft's model has no links; give xyz and rpy"),
    "a preset that is not": ("sensors.gnss", {"preset": "bok"}, "preset: no preset 'bok'; did you mean 'book'?"),
}


@pytest.mark.parametrize("case", AIRCRAFT)
def test_an_aircraft_that_cannot_be_is_refused_with_file_line_and_mend(root, case):
    way, value, why = AIRCRAFT[case]
    path = root / FILES["milvus"]
    whole = path.read_text()
    try:
        path.write_text(yaml.safe_dump(spoiled(yaml.safe_load(whole), way.split("."), value)))
        with pytest.raises(BadInput) as caught:
            load(root)
        assert why in str(caught.value) and f"{path}:" in str(caught.value)
    finally:
        path.write_text(whole)


def test_a_heading_in_degrees_is_refused(root):
    path = root / FILES["mission"]
    whole = path.read_text()
    try:
        path.write_text(yaml.safe_dump(spoiled(yaml.safe_load(whole), ["vehicles", "milvus", "start", "yaw"], 90.0)))
        with pytest.raises(BadInput, match=r"start: yaw: 90 is above 7: it is in radians \(90 deg = 1\.571\)"):
            load(root)
    finally:
        path.write_text(whole)
