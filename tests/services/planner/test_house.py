"""The burger explores the house: real physics, slam, planner and autopilot together in lockstep."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import CancelRequest, GoalRequest, Mode, NavStatus, Vector3
from services.autopilot.ground.build import hosts
from services.planner.build import build as build_planner
from services.planner.exploration_goals import SETTLING
from services.sim_ground.build import build as build_simulator
from services.slam.build import build as build_slam
from tests.runtime.outcome import ask
from uvf.maths.se2 import inverse, transform
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.world.geometry import floor_plan, reachable_floor
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.messages.convert import occupancy_cells, yaw_of
from uvf.runtime.state.stop_all import StopVoice
from uvf.runtime.time.lockstep import Lockstep

VEHICLE = "burger"
ROUND = SETTLING + 80.0  # s, of exploring the latter
GOAL = (1.4, 0.9)  # m, world: in the living room, seen early


class House:
    """A run of the demo's ground part; every message of some topics is kept as (t, message)."""

    def __init__(self, site):
        self.site = site
        build = (build_simulator, build_slam, build_planner, hosts)
        self.run = Lockstep([host for part in build for host in part(self.site)])
        self.bus = self.run.bus
        self.start = self.site.members[VEHICLE].entry.start
        self.voice = StopVoice("client")
        kept = {"truth": topics.TRUTH, "pose": topics.POSE, "contact": topics.CONTACT, "map": topics.MAP, "nav": topics.NAV_STATUS}
        kept |= {"status": topics.STATUS}
        self.kept = {name: [] for name in kept}
        for name, topic in kept.items():
            self.bus.subscribe(topic.at(VEHICLE), topic.qos, self._keep(self.kept[name], topic.message))

    @staticmethod
    def _keep(into, message):
        return lambda sample: into.append((sample.stamp_ns / 1e9, message.FromString(sample.payload)))

    def places(self):
        """(n, 3) t [s], x, y [m, world] of the truth."""
        return np.array([(t, m.position.x, m.position.y) for t, m in self.kept["truth"]])

    def put_stop(self, t, engaged):
        stops = self.kept["status"][-1][1].stops
        message = self.voice.engage(0, "") if engaged else self.voice.release(0, stops)
        key = topics.STOP.by("client").at("sys")
        self.bus.publisher(key, message.DESCRIPTOR.full_name, topics.STOP.qos).put(message.SerializeToString(), round(t * 1e9))

    def ask_goal(self, t, x, y):
        return self.ask(t, topics.GOAL, GoalRequest(position=Vector3(x=x, y=y), yaw=float("nan"), source="test"))

    def ask(self, t, request, message):
        answer = ask(self.bus, request, VEHICLE, message, t)
        self.run.run(t + 0.5)
        return answer[0][0]


@pytest.fixture(scope="module")
def explored():
    house = House(load_scenario(ROOT / "missions" / "demo.yaml"))
    house.run.run(ROUND)
    yield house
    house.run.close()


def test_drives_far_without_touching_anything(explored):
    places = explored.places()
    assert np.hypot(*np.diff(places[:, 1:], axis=0).T).sum() >= 17.5
    assert not any(m.touching for _, m in explored.kept["contact"])


def test_knows_where_it_is_all_the_time(explored):
    truth = {round(t, 2): m for t, m in explored.kept["truth"]}
    errors = [
        (np.hypot(m.pose.position.x - truth[round(t, 2)].position.x, m.pose.position.y - truth[round(t, 2)].position.y))
        for t, m in explored.kept["pose"]
        if round(t, 2) in truth
    ]
    assert len(errors) > 2000
    assert max(errors) <= 0.05


def test_the_pose_never_jumps(explored):
    poses = np.array([(m.pose.position.x, m.pose.position.y) for _, m in explored.kept["pose"]])
    headings = np.unwrap([yaw_of(m.pose.orientation) for _, m in explored.kept["pose"]])
    assert np.hypot(*np.diff(poses, axis=0).T).max() < 0.025
    assert np.abs(np.diff(headings)).max() < 0.06


def test_maps_half_of_the_house_and_maps_it_right(explored):
    site, start = explored.site, explored.start
    plan = floor_plan(site.world, 0.05)
    reachable = reachable_floor(plan, start.x, start.y, site.members[VEHICLE].file.ground.radius)
    grid = explored.kept["map"][-1][1]
    cells = occupancy_cells(grid)
    world = np.column_stack([c[reachable] for c in plan.centres()])
    in_map = transform(inverse((start.x, start.y, start.yaw)), world)
    at = np.floor((in_map - (grid.pose.position.x, grid.pose.position.y)) / grid.cell_size.x).astype(int)
    inside = ((at >= 0) & (at < cells.shape[::-1])).all(axis=1)
    values = cells[at[inside, 1], at[inside, 0]]
    free, occupied = (values >= 0) & (values < 50), values >= 60
    assert free.sum() / len(world) >= 0.58
    assert occupied.sum() / free.sum() < 0.05


def test_stop_all_holds_until_it_is_released_and_a_goal_is_driven_to(explored):
    t = ROUND + 1.0
    explored.put_stop(t, engaged=True)
    explored.run.run(t + 1.0)
    stood_from = len(explored.kept["truth"])
    explored.run.run(t + 5.0)
    places = explored.places()[stood_from:]
    assert np.ptp(places[:, 1]) + np.ptp(places[:, 2]) < 0.01
    assert "STOP ALL" in explored.ask_goal(t + 5.0, *GOAL).reason

    explored.put_stop(t + 6.0, engaged=False)
    explored.run.run(t + 7.0)
    assert not explored.ask_goal(t + 7.0, 1.7, 2.2).accepted  # in the sofa's table
    assert explored.ask_goal(t + 8.0, *GOAL).accepted
    near = []
    explored.run.run(t + 60.0, lambda now: near.append(explored.kept["nav"][-1][1].state) or near[-1] != 3)
    _, x, y = explored.places()[-1]
    assert np.hypot(x - GOAL[0], y - GOAL[1]) < 0.2
    assert not any(m.touching for _, m in explored.kept["contact"])


def test_a_cancelled_goal_stops_the_vehicle_and_exploring_goes_on_later(explored):
    t = explored.kept["truth"][-1][0] + 8.0
    explored.run.run(t)
    assert explored.ask_goal(t, 3.4, 1.3).accepted
    explored.run.run(t + 3.0)
    moved = np.ptp(explored.places()[-20:, 1:], axis=0).max()
    reply = explored.ask(t + 3.0, topics.CANCEL, CancelRequest(source="test"))
    assert reply.accepted and moved > 0.02
    explored.run.run(t + 5.0)
    stood_from = len(explored.kept["truth"])
    explored.run.run(t + 7.5)
    assert explored.kept["nav"][-1][1].state == NavStatus.CANCELLED
    assert np.ptp(explored.places()[stood_from:, 1:], axis=0).max() < 0.005
    explored.run.run(t + 15.0)
    assert explored.kept["nav"][-1][1].job == "explore"


def test_slam_that_is_started_again_finds_the_vehicle_in_its_old_map():
    """Both slam services die on the way and are back two seconds later; the vehicle stands meanwhile."""
    house = House(load_scenario(ROOT / "missions" / "demo.yaml"))
    newest = {}
    for topic in (topics.ODOMETRY, topics.TF_MAP, topics.MAP_SESSION):
        house.bus.subscribe(topic.at(VEHICLE), topic.qos, lambda sample: newest.update({sample.key: sample.payload}))
    house.run.run(12.0)
    before = house.places()[-1]
    for i, shell in enumerate(house.run.shells):
        if shell.type.name in ("odometry", "mapping"):
            house.run.shells[i] = again = ServiceRunner(shell.host, house.bus)  # which hears what is latched, as a new process does
            again.recall(newest.get)
            again.skip_to(round(14.0e9))
    house.run.run(13.99)
    stood = house.places()[-20:, 1:]
    assert np.ptp(stood, axis=0).max() < 0.01
    assert np.hypot(*(stood[-1] - before[1:])) > 0.02  # it did not stop at once
    house.run.run(30.0)
    house.run.close()
    truth = {round(t, 2): m.position for t, m in house.kept["truth"]}
    errors = [
        np.hypot(m.pose.position.x - truth[round(t, 2)].x, m.pose.position.y - truth[round(t, 2)].y)
        for t, m in house.kept["pose"]
        if t > 15.0
    ]
    assert max(errors) < 0.05
    assert np.hypot(*(house.places()[-1, 1:] - before[1:])) > 1.0


ROUNDS = "[{x: 6.2, y: 1.3}, {x: 5.6, y: 4.4, hold: 1.0}, {kind: return}]"
"""Two waypoints in rooms that cannot be seen from the start, then home."""


def mission_site(tmp_path, items=ROUNDS):
    path = tmp_path / "rounds.yaml"
    path.write_text(
        "about: The burger drives a mission.\n"
        "world: house\n"
        "vehicles:\n"
        "  burger:\n"
        "    model: burger\n"
        "    system_id: 2\n"
        "    start: {x: 2.2, y: 1.3, yaw: 0.5}\n"
        f"    job: {{mission: {items}}}\n"
    )
    return load_scenario(path)


def test_a_mission_leads_through_rooms_not_seen_yet_and_home(tmp_path):
    house = House(mission_site(tmp_path))
    progress = []
    house.bus.subscribe(topics.PROGRESS.at(VEHICLE), topics.PROGRESS.qos, House._keep(progress, topics.PROGRESS.message))
    house.run.run(90.0, lambda t: not progress or progress[-1][1].state != progress[-1][1].COMPLETE)
    house.run.close()
    assert progress[-1][1].state == progress[-1][1].COMPLETE
    reached = {m.reached: t for t, m in reversed(progress)}
    places = house.places()
    for item, (x, y) in enumerate(((6.2, 1.3), (5.6, 4.4), (2.2, 1.3))):
        _, there_x, there_y = places[np.searchsorted(places[:, 0], reached[item]) - 1]
        assert np.hypot(there_x - x, there_y - y) < 0.35
    assert not any(m.touching for _, m in house.kept["contact"])


def test_a_mission_item_in_a_table_ends_in_hold_with_the_reason(tmp_path):
    house = House(mission_site(tmp_path, "[{x: 1.7, y: 2.2}]"))
    status, events = [], []
    house.bus.subscribe(topics.STATUS.at(VEHICLE), topics.STATUS.qos, House._keep(status, topics.STATUS.message))
    house.bus.subscribe(topics.EVENTS.by("*").at(VEHICLE), topics.EVENTS.qos, House._keep(events, topics.EVENTS.message))
    house.run.run(60.0, lambda t: not status or status[-1][1].mode != Mode.MODE_HOLD)
    house.run.close()
    assert status[-1][1].mode == Mode.MODE_HOLD
    told = [(m.text, m.cause) for _, m in events]
    cause = next(cause for text, cause in told if text == "mission: holding")
    assert cause in ("no way leads to the goal", "an obstacle stands in the way and does not leave")  # its legs, seen from near alone
    assert ("mode HOLD", "asked by planner") in told
