"""In the ground simulator: the demo's rover as far off as it says it may be; wheels that spin against a bookcase; a receiver outdoors."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from launch.vehicles.importing import import_vehicle
from schemas import topics
from schemas.messages import WheelCommand
from services.autopilot.ground.build import hosts as autopilot
from services.planner.build import build as planner
from services.sim_ground.build import build as simulator
from services.slam.build import build as slam
from tests.launch.vehicles.foreign_robots import skid_steer
from uvf.control.steered_ramp import velocity_ramp
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import to_euler, wrap
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.sensors import GnssSensor, Mount
from uvf.models.world.file import Box
from uvf.runtime.contract.declaration import Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import seconds, wxyz, yaw_of
from uvf.runtime.messages.wheels import wheel_command
from uvf.runtime.time.lockstep import Lockstep

KEPT = ("ODOMETRY", "TRUTH", "EVENTS", "NAV_STATE")
CHANGE = msgspec.structs.replace


def demo(**changes):
    """The demo's site, with parts of the rover's file changed."""
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    burger = site.members["burger"]
    return replace(site, members={**site.members, "burger": replace(burger, file=CHANGE(burger.file, **changes))})


def run(hosts, duration):
    """All messages of ``KEPT``, by topic name."""
    lockstep, heard = Lockstep(hosts), {name: [] for name in KEPT}
    for name in KEPT:
        topic = getattr(topics, name)
        lockstep.bus.subscribe(
            topic.by("*").at("burger"), topic.qos, lambda s, n=name, m=topic.message: heard[n].append(m.FromString(s.payload))
        )
    lockstep.run(duration)
    lockstep.close()
    return heard


def beside_truth(heard):
    """(t, odometry, true pose since the start, way) at each odometry whose time the truth knows, too."""
    true = {round(seconds(m.timestamp), 3): Pose2(m.position.x, m.position.y, yaw_of(m.orientation)) for m in heard["TRUTH"]}
    start, way, last = None, 0.0, None
    for told in heard["ODOMETRY"]:
        t = round(seconds(told.timestamp), 3)
        if t in true:
            start, last = start or true[t], last or true[t]
            way += float(np.hypot(true[t].x - last.x, true[t].y - last.y))
            last = true[t]
            yield t, told, compose(inverse(start), last), way


def wheels_only(turning):
    """Commands of both wheels [rad/s] after a second of standing."""

    class Driver(Service):
        name, hz = "driver", 50.0

        class Outputs(Writes):
            wheels: WheelCommand = topic(topics.WHEEL_COMMAND)

        def step(self, t, now):
            left, right = turning(t) if t > 1.0 else (0.0, 0.0)
            return self.Outputs(wheels=WheelCommand(left=left, right=right))

    return ServiceInstance(Driver, Driver, "burger")


@pytest.fixture(scope="module")
def explored():
    site = demo()
    return run([host for build in (simulator, slam, planner, autopilot) for host in build(site)], 40.0)


def test_the_rover_is_no_farther_off_than_its_covariance_says(explored):
    errors = []
    for t, told, true, way in beside_truth(explored):
        pose = told.pose
        e = np.array((pose.position.x - true.x, pose.position.y - true.y, wrap(yaw_of(pose.orientation) - true.yaw)))
        p = np.array(told.pose_covariance).reshape(6, 6)[np.ix_((0, 1, 5), (0, 1, 5))]
        if t > 5.0:
            errors.append((e @ np.linalg.solve(p, e) / 3, np.hypot(*e[:2]) / way))
    assert way > 8.0
    assert np.max(errors, axis=0)[0] < 4.0
    assert np.max(errors, axis=0)[1] < 0.02


def test_a_rover_that_drives_about_does_not_slip_by_its_own_account(explored):
    assert [event.text for event in explored["EVENTS"] if event.source == "odometry"] == []


def test_wheels_that_spin_against_a_bookcase_are_noticed():
    """Strong motors on a slippery floor: the wheels turn on when the rover stands before the shelf after 9.5 s."""
    ground = load_scenario(ROOT / "missions" / "demo.yaml").members["burger"].file.ground
    strong = CHANGE(ground, motor=CHANGE(ground.motor, stall_torque=2.0), friction=CHANGE(ground.friction, mu=0.4, mu2=0.4))
    site = demo(ground=strong)
    heard = run([*simulator(site), *slam(site), wheels_only(lambda t: (9.0, 9.0))], 18.0)
    *_, (_, told, true, _) = beside_truth(heard)
    rolled = 9.0 * strong.drive.wheel_radius * 17.0
    assert rolled - true.x > 2.0
    assert told.pose.position.x - true.x < 0.25 * (rolled - true.x)
    assert any("wheels slip" in event.text and seconds(event.timestamp) > 9.0 for event in heard["EVENTS"])


UP_THE_RAMP = """
about: A rover before the western ramp of the terrace.
world: plaza
vehicles:
  burger: {model: burger, system_id: 2, start: {x: 24.5, y: 24.0, yaw: 0.0}}
"""


def test_a_ramp_is_no_slip(tmp_path):
    mission = tmp_path / "ramp.yaml"
    mission.write_text(UP_THE_RAMP)
    site = load_scenario(mission)
    heard = run([*simulator(site), *slam(site), wheels_only(lambda t: (9.0, 9.0))], 14.0)
    assert heard["TRUTH"][-1].position.z > 0.35
    assert [event.text for event in heard["EVENTS"]] == []
    *_, (_, told, true, way) = beside_truth(heard)
    assert told.pose.position.x == pytest.approx(true.x, abs=0.02 * way)


def test_a_receiver_keeps_the_pose_in_the_world():
    sensors = load_scenario(ROOT / "missions" / "demo.yaml").members["burger"].file.sensors
    gnss = GnssSensor(hz=5.0, horizontal_noise=0.3, vertical_noise=0.5, speed_noise=0.05, latency=0.1, mount=Mount((-0.05, 0.03, 0.2)))
    site = demo(sensors=CHANGE(sensors, gnss=gnss))
    heard = run([*simulator(site), *slam(site), wheels_only(lambda t: (9.0, 9.0 + 2.0 * (t > 4.0)))], 9.0)
    state, truth = heard["NAV_STATE"][-1], heard["TRUTH"][-1]
    off = np.hypot(state.position.x - truth.position.x, state.position.y - truth.position.y)
    assert off < 0.2
    assert off < 4.0 * state.position_sigma
    assert heard["ODOMETRY"][0].pose.position.x == pytest.approx(0.0, abs=0.01)


def test_on_a_ramp_the_way_is_told_as_it_is_from_above():
    """12 degrees, 5 m: by the wheels alone it would be 0.1 m too long."""
    site, slope, length = demo(), np.radians(12.0), 5.0
    middle = (1.0 + length / 2 * np.cos(slope), 0.0, length / 2 * np.sin(slope) - 0.01)
    ramp = Box("ramp", tuple(map(float, middle)), (length, 2.0, 0.02), (0.0, -float(slope), 0.0))
    burger = site.members["burger"]
    start = CHANGE(burger.entry.start, x=0.0, y=0.0, yaw=0.0)
    world = CHANGE(site.world, walls=[], boxes=[ramp], cylinders=[], meshes=[], floor=(-5.0, -5.0, 9.0, 5.0))
    site = replace(site, world=world, members={"burger": replace(burger, entry=CHANGE(burger.entry, start=start))})
    heard = run([*simulator(site), *slam(site), wheels_only(lambda t: (9.0, 9.0))], 18.0)
    *_, (_, told, true, way) = beside_truth(heard)
    assert heard["TRUTH"][-1].position.z > 0.7
    assert told.pose.position.x == pytest.approx(true.x, rel=5e-3)
    assert way > 4.0
    state, truth = heard["NAV_STATE"][-1], heard["TRUTH"][-1]
    assert state.position.z == pytest.approx(truth.position.z, abs=0.06)
    assert to_euler(wxyz(state.orientation))[1] == pytest.approx(-slope, abs=0.02)
    assert state.velocity.z == pytest.approx(np.hypot(state.velocity.x, state.velocity.y) * np.tan(slope), rel=0.1)


def on_the_empty_floor(model, folder, file):
    """The demo's rover as another vehicle, with nothing about it but walls far away."""
    site = demo()
    burger = site.members["burger"]
    start = CHANGE(burger.entry.start, x=0.0, y=0.0, yaw=0.0)
    walls = [Box(f"wall_{i}", (x, y, 0.5), (8.0, 0.2, 1.0), (0.0, 0.0, yaw)) for i, (x, y, yaw) in enumerate(WALLS)]
    world = CHANGE(site.world, walls=[], boxes=walls, cylinders=[], meshes=[], floor=(-5.0, -5.0, 5.0, 5.0))
    member = replace(burger, folder=folder, file=file, entry=CHANGE(burger.entry, model=model, start=start))
    return replace(site, world=world, members={"burger": member})


WALLS = ((0.0, 4.0, 0.0), (0.0, -4.0, 0.0), (4.0, 0.0, 1.5708), (-4.0, 0.0, 1.5708))


def driven_by(body, wanted):
    """Commands as the autopilot makes them, of what is wanted at a time [s], after a second of standing."""
    ramp, drive = velocity_ramp(body), body.drive.kinematics

    class Driver(Service):
        name, hz = "driver", 50.0

        class Outputs(Writes):
            wheels: WheelCommand = topic(topics.WHEEL_COMMAND)

        def step(self, t, now):
            speeds = drive.wheels(ramp.lead(wanted(t) if t > 1.0 else Twist(0.0, 0.0), 0.02))
            return self.Outputs(wheels=wheel_command(t, speeds, ramp.steering))

    return ServiceInstance(Driver, Driver, "burger")


def farthest_off(heard):
    """Largest share of the way by which the odometry is off, after the first metre, and the way [m]."""
    rows = []
    for _, told, true, way in beside_truth(heard):
        if way > 1.0:
            rows.append((np.hypot(told.pose.position.x - true.x, told.pose.position.y - true.y) / way, way))
    return max(off for off, _ in rows), rows[-1][1]


def hasty(t):
    """A car that speeds up and stops hard again and again, forwards and backwards, steered from stop to stop."""
    way = 1.0 if t % 4.0 < 2.0 else -1.0
    return Twist(0.6 * way if t % 2.0 < 1.5 else 0.0, 0.6 * np.sin(2.0 * t))


def test_a_hasty_car_knows_its_way():
    file = load_vehicle(ROOT / "vehicles", "minicar")
    site = on_the_empty_floor("minicar", ROOT / "vehicles" / "minicar", file)
    heard = run([*simulator(site), *slam(site), driven_by(file.ground, hasty)], 40.0)
    off, way = farthest_off(heard)
    assert way > 10.0
    assert off < 0.02


def test_a_vehicle_on_mecanum_wheels_knows_its_way(tmp_path):
    source, folder = skid_steer(tmp_path / "source"), tmp_path / "vehicles" / "it"
    source.write_text(source.read_text().replace("libgazebo_ros_skid_steer_drive.so", "gz-sim-mecanum-drive-system"))
    import_vehicle(source, folder)
    lidar, imu = (getattr(load_vehicle(ROOT / "vehicles", "burger").sensors, name) for name in ("lidar", "imu"))
    file = load_vehicle(folder.parent, "it")
    file = CHANGE(file, sensors=CHANGE(file.sensors, lidar=CHANGE(lidar, mount=Mount((0.0, 0.0, 0.3))), imu=imu))
    site = on_the_empty_floor("it", folder, file)
    heard = run([*simulator(site), *slam(site), driven_by(file.ground, lambda t: Twist(0.3 * np.sin(t), 0.4, 0.3 * np.cos(0.7 * t)))], 30.0)
    off, way = farthest_off(heard)
    assert way > 6.0
    assert off < 0.02
