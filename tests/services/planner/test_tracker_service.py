"""The tracker step by step: driving, stopping before what it sees, recovering as told, standing without inputs."""

import numpy as np
import pytest

from schemas.messages import LaserScan, NavDirective, NavReport, NavStatus, Pose, PoseInFrame, PosesInFrame, Vector3
from services.planner.scan_placing import PlacedLidar, ScanPlacer
from services.planner.tracker_service import TrackerParams, TrackerService
from tests.runtime.stepping import stale, stepped
from tests.services.autopilot.ground.test_service import BODY
from tests.services.live_params import all_settable_are_read
from tests.services.planner.seeing import NO_OTHERS, NOTHING_ELSE, sensors_of
from uvf.maths.rotations import from_euler
from uvf.maths.se2 import Pose2, transform
from uvf.maths.se3 import IDENTITY, Transform
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.runtime.messages.convert import cost_cells, occupancy_grid, planar_pose, pose2_of, seconds, stamp, wxyz
from uvf.sensors.sweeping import AT_ONCE, SPACING, Sweeping


def scan(t, ahead, yaw=0.0, around=0.0):
    """A wall to the east, ``ahead`` [m] of a lidar that looks along ``yaw`` [rad]; elsewhere something ``around`` it [m], 0 = nothing."""
    angles = np.radians(np.arange(360.0))
    towards = np.cos(angles + yaw)
    ranges = np.where(towards > 0.5, ahead / np.maximum(towards, 0.5), around)
    if around > 0.0:
        ranges = np.full(360, around)
    return LaserScan(timestamp=stamp(t), start_angle=0.0, end_angle=angles[-1], ranges=ranges.tolist())


def with_post(seen, x, y, yaw, radius=0.15):
    """Puts a post at (x, y) [m] from the lidar into a scan."""
    angles = np.radians(np.arange(360.0)) + yaw
    middle = x * np.cos(angles) + y * np.sin(angles)
    inside = radius**2 - (x**2 + y**2 - middle**2)
    hit = (inside > 0.0) & (middle > 0.0)
    ranges = np.array(seen.ranges)
    ranges[hit] = (middle - np.sqrt(np.maximum(inside, 0.0)))[hit]
    seen.ranges[:] = ranges.tolist()


FOOTPRINT = RobotFootprint.circle(BODY.radius)
EAST = PosesInFrame(poses=[Pose(position=Vector3(x=0.1 * i)) for i in range(31)])
NOTHING = NOTHING_ELSE | dict.fromkeys(("odometry", "keep_out", "speed_map")) | {"team": {}, "team_nav": {}}
FOLLOW = NavDirective(number=1, action=NavDirective.FOLLOW)


class TrackerBench:
    """A vehicle that starts at the world's origin and looks east; a wall ``ahead`` [m] of it there, the path leads 3 m east."""

    def __init__(self, base_from_lidar=IDENTITY, sensors=NO_OTHERS, **params):
        self.service = TrackerService(
            "v", (BODY, FOOTPRINT), sensors_of(FOOTPRINT, base_from_lidar, sensors=sensors), TrackerParams(**params)
        )
        self.t = 0.0
        self.pose = np.zeros(3)
        self.commands = []
        self.places = []
        self.events = []
        self.report = None
        self.costs = []
        self.moving = []
        self.post = None
        """(x, y) m of something round of 15 cm before the wall."""

    def step(self, n, ahead, blind=False, directive=FOLLOW, moves=False, around=0.0, **masks):
        for _ in range(n):
            self.t += 0.1
            x, y, yaw = self.pose
            poses = [PoseInFrame(timestamp=stamp(self.t - s), pose=planar_pose(x, y, yaw)) for s in (0.08, 0.04, 0.02)]
            seen_at = 0.0 if blind else self.t - 0.03
            told = NOTHING | masks | {"directive": directive, "path": EAST, "pose": poses}
            seen = scan(seen_at, ahead - x, yaw, around)
            if self.post is not None:
                with_post(seen, self.post[0] - x, self.post[1] - y, yaw)
            out = stepped(self.service, self.t, scan=seen, **told)
            self.costs.append(out.get("costs"))
            self.moving += [out["obstacles"]] if out.get("obstacles") is not None else []
            self.commands.append((out["drive"].linear, out["drive"].angular))
            self.events += [e.text for e in out.get("events", [])]
            self.report = out.get("report")
            if moves:
                v, w = self.commands[-1]
                self.places.append((x, y))
                self.pose += (0.1 * v * np.cos(yaw), 0.1 * v * np.sin(yaw), 0.1 * w)
        return self

    @property
    def speed(self):
        return self.commands[-1][0]


def test_drives_where_the_way_is_free():
    assert TrackerBench().step(10, ahead=4.5).speed > 0.9 * TrackerParams().speed


def test_comes_to_the_end_of_its_path_and_stands_there():
    bench = TrackerBench().step(110, ahead=5.0, moves=True)
    assert bench.pose[:2] == pytest.approx((3.0, 0.0), abs=0.1)
    assert (bench.commands[-1], bench.report.drive) == ((0.0, 0.0), NavReport.ARRIVED)


def test_stops_before_a_wall_on_its_path():
    bench = TrackerBench().step(80, ahead=1.5, moves=True)
    assert 0.5 < bench.pose[0] < 1.5 - BODY.radius
    assert 0.5 < bench.step(60, ahead=1.5, moves=True).pose[0] < 1.5 - BODY.radius


def test_never_comes_nearer_than_its_margin():
    bench = TrackerBench().step(80, ahead=0.6, moves=True)
    assert bench.pose[0] + BODY.radius <= 0.6


@pytest.mark.parametrize("planner", ["dwa", "trajectory_rollout", "regulated_pure_pursuit", "elastic_band", "vfh_plus", "pid"])
def test_every_local_planner_drives_and_stops(planner):
    bench = TrackerBench(local_planner=planner, goal_tolerance=0.15).step(150, ahead=5.0, moves=True)
    assert bench.pose[:2] == pytest.approx((3.0, 0.0), abs=0.2)
    assert bench.commands[-1] == (0.0, 0.0)


def test_turns_on_the_spot_as_told_and_reports_it_done():
    spin = NavDirective(number=7, action=NavDirective.SPIN, amount=2.0)
    bench = TrackerBench().step(1, ahead=3.0)
    before = bench.pose[2]
    bench.step(40, ahead=3.0, directive=spin, moves=True)
    assert bench.pose[2] - before == pytest.approx(2.0, abs=0.2)
    assert (bench.report.number, bench.report.done) == (7, True)


def test_backs_up_as_told_but_not_into_what_stands_behind():
    back = NavDirective(number=7, action=NavDirective.BACK_UP, amount=0.3)
    bench = TrackerBench().step(40, ahead=3.0, directive=back, moves=True)
    assert bench.pose[0] == pytest.approx(-0.3, abs=0.05)
    assert bench.report.done
    bench = TrackerBench()
    bench.pose[2] = np.pi
    bench.step(40, ahead=0.25, directive=back, moves=True)
    assert bench.report.impossible
    assert bench.pose[0] + BODY.radius < 0.25


def drawn(value, x, y, size=1.0):
    """A mask with a square of ``size`` [m] about (x, y) [m, world]."""
    cells = np.zeros((80, 80), dtype=np.int8)
    at = (np.arange(80) + 0.5) * 0.1 - 4.0
    cells[(np.abs(at - y) <= size / 2)[:, None] & (np.abs(at - x) <= size / 2)] = value
    return occupancy_grid(cells, 0.1, -4.0, -4.0, "world", 0.0)


def test_it_keeps_out_of_what_is_drawn_though_nothing_is_seen_there():
    bench = TrackerBench().step(150, ahead=5.0, moves=True, keep_out=drawn(100, 1.5, 0.0))
    nearest = min(max(abs(x - 1.5), abs(y)) for x, y in bench.places)
    assert nearest > 0.5 + BODY.radius - 0.06
    assert bench.pose[0] > 2.5  # it went round


def test_it_is_as_slow_as_is_drawn_where_it_is():
    bench = TrackerBench().step(15, ahead=5.0, speed_map=drawn(40, 0.0, 0.0, 2.0))
    assert bench.speed == pytest.approx(0.4 * TrackerParams().speed, abs=0.03)
    assert TrackerBench().step(15, ahead=5.0, speed_map=drawn(40, 3.0, 3.0, 0.5)).speed > 0.4


def test_an_unknown_action_means_to_stop():
    bench = TrackerBench().step(10, ahead=3.0)
    assert bench.step(3, ahead=3.0, directive=NavDirective(number=2, action=99)).commands[-1] == (0.0, 0.0)


def test_what_a_scanner_sees_that_hangs_upside_down_is_on_the_side_where_it_is():
    """Its right is the vehicle's left: what it sees there is kept in mind as an obstacle on the left."""
    beside = LaserScan(timestamp=stamp(1.0), start_angle=-1.0, end_angle=-0.8, ranges=[0.5] * 9)
    poses = [PoseInFrame(timestamp=stamp(1.0), pose=planar_pose(0.0, 0.0, 0.0))]
    service = TrackerService(
        "v", (BODY, FOOTPRINT), sensors_of(FOOTPRINT, Transform(from_euler(np.pi, 0.0, 0.0), np.zeros(3))), TrackerParams()
    )
    stepped(service, 1.0, directive=FOLLOW, path=EAST, pose=poses, scan=beside, **NOTHING)
    seen = service._executor.controller.layer.lethal_near((0.0, 0.0), 1.0)
    assert len(seen) >= 2 and (seen[:, 1] > 0.3).all()


TURNING = 1.5  # rad/s
SWEEP = 0.2  # s


def swept_post(clockwise):
    """A post 0.5 m east of a vehicle that turns left on the spot, and its lidar with it; the sweep ends at 1 s."""
    moments, angles = np.linspace(1.0 - SWEEP, 1.0, 360), np.radians(np.arange(360.0))
    seen_along = angles + TURNING * (moments[::-1] if clockwise else moments)
    ranges = np.where(np.cos(seen_along) > np.cos(0.1), 0.5, 0.0)
    return LaserScan(timestamp=stamp(1.0 - SWEEP), start_angle=0.0, end_angle=angles[-1], ranges=ranges.tolist())


def poses_until(end):
    return [PoseInFrame(timestamp=stamp(t), pose=planar_pose(0.0, 0.0, TURNING * t)) for t in np.arange(0.0, end + 1e-9, 0.02)]


def post_seen(sweeping, clockwise, end=1.02):
    """Bearings [rad] in the world at which its beams end, near as they are."""
    placer = ScanPlacer({"": PlacedLidar(IDENTITY, sweeping)}, 4.0)
    for message in poses_until(end):
        placer.move(seconds(message.timestamp), pose2_of(message.pose), wxyz(message.pose.orientation))
    seen = placer.place(swept_post(clockwise))
    if seen is None:
        return np.zeros(0)
    points = transform(seen.pose, seen.points[seen.ranges > 0.0])
    return np.arctan2(points[:, 1], points[:, 0])


@pytest.mark.parametrize("clockwise", [False, True])
def test_what_a_slow_lidar_sees_is_where_it_was_when_it_was_seen(clockwise):
    found = post_seen(Sweeping(SWEEP, clockwise), clockwise)
    assert len(found) > 8
    assert np.abs(found).max() < 0.1 + TURNING * SPACING / 2
    assert np.abs(post_seen(AT_ONCE, clockwise)).max() > 0.15


def test_a_sweep_counts_when_the_pose_at_its_last_beam_is_known():
    assert len(post_seen(Sweeping(SWEEP), False, end=0.96)) == 0


def test_a_wall_seen_from_a_slope_is_where_it_is_from_above():
    tilted = from_euler(0.0, -0.3, 0.5)
    placer = ScanPlacer({"": PlacedLidar(Transform(IDENTITY.rotation, np.array((0.1, 0.0, 0.4))), AT_ONCE)}, 4.0)
    for t in (0.0, 1.0):
        placer.move(t, Pose2(2.0, 1.0, 0.5), tilted)
    seen = placer.place(LaserScan(timestamp=stamp(1.0), start_angle=0.0, end_angle=np.pi / 2, ranges=[3.0, 3.0]))
    upward = 0.1 * np.cos(0.3) - 0.4 * np.sin(0.3)
    assert seen.eye == pytest.approx((upward, 0.0))
    assert seen.points == pytest.approx(np.array(((upward + 3.0 * np.cos(0.3), 0.0), (upward, 3.0))))


def test_a_slow_scan_is_as_old_as_its_last_beam():
    wall = scan(1.0, ahead=3.0)
    service = TrackerService("v", (BODY, FOOTPRINT), sensors_of(FOOTPRINT, sweeping=Sweeping(0.5)), TrackerParams())
    told = NOTHING | {"directive": FOLLOW, "path": EAST, "scan": wall}
    poses = [PoseInFrame(timestamp=stamp(0.02 * k), pose=planar_pose(0.0, 0.0, 0.0)) for k in range(100)]
    assert stepped(service, 2.0, pose=poses, **told)["drive"].linear > 0.05
    assert stepped(service, 2.2, pose=[], **told)["drive"].linear == 0.0


def test_of_more_beams_than_are_needed_the_nearest_of_neighbours_count():
    ranges = np.full(20_000, 3.0)
    ranges[777], ranges[5000:5100] = 0.7, 0.0
    placer = ScanPlacer({"": PlacedLidar(IDENTITY, AT_ONCE)}, 4.0)
    for t in (0.0, 1.0):
        placer.move(t, Pose2(0.0, 0.0, 0.0), IDENTITY.rotation)
    seen = placer.place(LaserScan(timestamp=stamp(1.0), start_angle=-3.0, end_angle=3.0, ranges=ranges.tolist()))
    assert len(seen.ranges) <= 1440
    assert ((seen.ranges > 0.0) & (seen.ranges < 1.0)).sum() == 1
    angle = -3.0 + 6.0 * 777 / 19_999
    assert seen.points[np.argmin(np.where(seen.ranges > 0.0, seen.ranges, 9.0))] == pytest.approx(
        (0.7 * np.cos(angle), 0.7 * np.sin(angle)), abs=1e-3
    )


def test_an_obstacle_that_comes_and_goes_is_told_every_ten_seconds_at_most():
    bench = TrackerBench()
    for _ in range(50):
        bench.step(3, ahead=4.0, around=0.155).step(2, ahead=4.0)
    assert bench.t == pytest.approx(25.0)
    assert bench.events == ["obstacle ahead"] * 3


def test_blind_it_does_not_move():
    bench = TrackerBench().step(10, ahead=3.0)
    assert bench.step(10, ahead=3.0, blind=True).commands[-1] == (0.0, 0.0)


def test_stale_inputs_mean_stop():
    drive = stale(TrackerBench().service, 3.0, ("pose",))["drive"]
    assert (drive.linear, drive.angular) == (0.0, 0.0)


def test_parameters_of_the_tracker_count_while_running():
    bench = TrackerBench()
    with all_settable_are_read(bench.service):
        bench.step(5, ahead=3.0).step(20, ahead=0.18)
    bench = TrackerBench().step(10, ahead=4.5)
    bench.service.params = TrackerParams(speed=0.1)
    assert bench.step(8, ahead=4.5).speed == pytest.approx(0.1, abs=0.02)
    bench.service.params = TrackerParams(margin=1.0)
    assert bench.step(5, ahead=0.6).speed <= 0.0


def test_people_see_what_it_drives_by():
    bench = TrackerBench().step(8, ahead=1.0, moves=True)
    told = [costs for costs in bench.costs if costs is not None]
    assert len(told) == 2
    values, (x, y) = cost_cells(told[-1]), (told[-1].pose.position.x, told[-1].pose.position.y)
    row, column = int((0.0 - y) / 0.05), int((1.02 - x) / 0.05)
    assert values.shape == (160, 160) and values[row - 1 : row + 2, column - 1 : column + 2].max() == 254
    assert told[-1].frame_id == "world"


def test_people_see_what_it_takes_for_moving():
    """A post of 15 cm comes along at 0.6 m/s, 1.5 m ahead."""
    bench = TrackerBench()
    for n in range(25):
        bench.post = (1.5, -1.2 + 0.06 * n)
        bench.step(1, ahead=3.4)
    ((post,),) = [told.obstacles for told in bench.moving[-1:]]
    assert (post.position.x, post.position.y) == pytest.approx((1.5, 0.24), abs=0.08)
    assert (post.velocity.x, post.velocity.y) == pytest.approx((0.0, 0.6), abs=0.12)
    assert post.radius == pytest.approx(0.15, abs=0.04)


def mate(x, y, z=0.0):
    """One of the team, as it says where it is [m]; its radius is 20 cm."""
    return {"team": {"low": PoseInFrame(pose=planar_pose(x, y, 0.0, z))}, "team_nav": {"low": NavStatus(radius=0.2)}}


@pytest.mark.parametrize("beside", [None, (1.5, -0.42), (1.72, -0.36), (1.85, 0.0)])
def test_one_of_the_team_that_the_lidar_looks_over_is_not_driven_into(beside):
    """Nor where it stands beside or before something that the lidar does show."""
    bench = TrackerBench()
    bench.post = beside
    for _ in range(120):
        bench.step(1, ahead=5.0, moves=True, **mate(1.5, 0.0))
    distances = np.hypot(*(np.array(bench.places) - (1.5, 0.0)).T)
    assert distances.min() > 0.2 + BODY.radius
    assert bench.pose[0] > 2.5


def speed_before_one_that_was_at(before):
    """m/s that is commanded where one of the team is 0.6 m ahead, as the lidar shows, and says that it was ``before`` [m ahead] then."""
    bench = TrackerBench().step(12, ahead=5.0, moves=True)
    for ahead in (before, before, 0.6, 0.6):
        x = bench.pose[0] + ahead
        bench.post = (x, 0.0)
        told = mate(x, 0.0)
        told["team"]["low"].timestamp.CopyFrom(stamp(bench.t + 0.08))
        bench.step(1, ahead=5.0, **told)
    return bench.speed


def test_one_of_the_team_that_comes_nearer_is_stopped_for_earlier():
    assert speed_before_one_that_was_at(0.75) < speed_before_one_that_was_at(0.6) - 0.05


@pytest.mark.parametrize(
    "where", [(1.5, 0.0, 60.0), (np.nan, 0.0, 0.0), (0.05, 0.0, 0.0)], ids=["flies", "nowhere", "wrong about its place"]
)
def test_who_cannot_be_in_the_way_is_none(where):
    bench = TrackerBench().step(60, ahead=5.0, moves=True, **mate(*where))
    assert bench.pose[0] > 1.6
    assert np.abs(np.array(bench.places)[:, 1]).max() < 0.1


def test_one_of_the_team_that_the_lidar_sees_is_where_it_is_seen():
    bench = TrackerBench()
    bench.post = (1.5, 0.6)
    bench.step(60, ahead=5.0, moves=True, **mate(1.5, 0.42))
    assert bench.pose[0] > 1.6
    assert np.abs(np.array(bench.places)[:, 1]).max() < 0.2


def test_where_one_of_the_team_has_been_the_way_is_free_again():
    bench = TrackerBench().step(10, ahead=5.0, **mate(1.0, 0.0)).step(60, ahead=5.0, moves=True, **mate(1.0, 2.0))
    assert bench.pose[0] > 1.6
    assert np.abs(np.array(bench.places)[:, 1]).max() < 0.1
