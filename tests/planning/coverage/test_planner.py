import math
import time

import numpy as np
import pytest
import shapely

from tests.planning.coverage.shapes import HOLE, SQUARE, comb, raster_share
from uvf.planning.coverage.field import make_field
from uvf.planning.coverage.ground_speed import GroundSpeed
from uvf.planning.coverage.plan import HEADLAND, SWATH
from uvf.planning.coverage.planner import plan_coverage
from uvf.planning.coverage.task import CoverageTask, End
from uvf.planning.coverage.transits import moved
from uvf.planning.coverage.vehicles import GroundVehicle, SurveyAircraft

AIRCRAFT = SurveyAircraft(GroundSpeed(25.0), 50.0, lead_in=40.0, lead_out=10.0)
IN_WIND = SurveyAircraft(GroundSpeed(25.0, (9.0, 3.0)), 80.0, lead_in=40.0, lead_out=10.0)


def ends_of(segments):
    return np.array([moved(row[:3], row[3], row[4]) for row in segments])


def assert_is_one_path(plan, turns_on_the_spot=False):
    ends = ends_of(plan.segments)
    assert np.abs(ends[:-1, :2] - plan.segments[1:, :2]).max(initial=0.0) < 1e-3
    if not turns_on_the_spot:
        assert np.cos(ends[:-1, 2] - plan.segments[1:, 2]).min(initial=1.0) > 1.0 - 1e-9
    on = plan.segments[plan.kinds == SWATH]
    assert on[:, :2] == pytest.approx(plan.swaths[:, :2], abs=1e-6)
    assert ends_of(on)[:, :2].reshape(-1, 2) == pytest.approx(plan.swaths[:, 2:], abs=1e-6)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("vehicle", [AIRCRAFT, IN_WIND])
def test_a_comb_is_covered_by_one_flyable_path(seed, vehicle):
    field = comb(np.random.default_rng(seed))
    plan = plan_coverage(CoverageTask(field, 15.0), vehicle)
    assert_is_one_path(plan)
    assert plan.covered >= 0.995
    assert raster_share(field, plan.swaths, 15.0) == pytest.approx(plan.covered, abs=1e-3)
    assert np.abs(plan.segments[:, 3]).max() == pytest.approx(1 / vehicle.radius)
    assert plan.length >= plan.swath_length >= 0.99 * plan.bound
    times = [vehicle.speed.time(course, curvature, length) for _, _, course, curvature, length in plan.segments.tolist()]
    assert plan.time == pytest.approx(sum(times))


def test_every_corner_is_covered_where_that_is_asked_for():
    field = comb(np.random.default_rng(9))
    plan = plan_coverage(CoverageTask(field, 15.0, share=1.0), AIRCRAFT)
    assert plan.covered == pytest.approx(1.0, abs=1e-6)
    assert raster_share(field, plan.swaths, 15.0) == 1.0


def test_a_square_is_flown_along_its_longer_side_with_no_swath_too_many():
    plan = plan_coverage(CoverageTask(make_field(SQUARE), 20.0), AIRCRAFT)
    assert math.sin(plan.direction) == pytest.approx(0.0, abs=1e-6)
    assert len(plan.swaths) == 10
    assert plan.swath_ratio == pytest.approx(1.0, abs=0.005)
    assert plan.turns == 9


def test_the_order_takes_no_longer_than_the_neighbours_one_after_the_other():
    """Neighbours 20 m apart cannot be joined by half a circle of 50 m radius: leaving swaths out is quicker."""
    task = CoverageTask(make_field(SQUARE), 20.0)
    plan = plan_coverage(task, AIRCRAFT)
    rows = sorted(plan.swaths.tolist(), key=lambda row: row[1])
    turns = plan.length - plan.swath_length - 10 * 50.0
    lrl = 2 * math.acos((2 * 50.0 + 20.0 / 2 * 0 + 2 * 50.0 - 20.0) / (4 * 50.0))
    bulb = 50.0 * (math.pi + 2 * lrl)
    assert len(rows) == 10
    assert turns < 9 * bulb
    assert turns >= 9 * math.pi * 50.0 - 1e-6


@pytest.mark.parametrize("seed", [2, 3, 4])
def test_least_swaths_are_shorter_than_those_of_the_quickest_path(seed):
    field = comb(np.random.default_rng(seed))
    quick, short = (plan_coverage(CoverageTask(field, 15.0, least=least), AIRCRAFT) for least in ("time", "swaths"))
    assert short.swath_length <= quick.swath_length
    assert quick.time <= short.time


def test_swaths_over_a_small_hole_are_flown_straight_on():
    field = make_field(SQUARE, [HOLE])
    plan = plan_coverage(CoverageTask(field, 10.0, direction=0.0), SurveyAircraft(GroundSpeed(25.0), 50.0, 80.0, 40.0))
    assert_is_one_path(plan)
    pieces = (plan.swaths[:, 1] > 60.0) & (plan.swaths[:, 1] < 130.0)
    assert pieces.sum() == 14
    assert plan.turns <= 19


def test_wind_across_turns_the_swaths_only_where_it_pays():
    narrow = make_field(SQUARE * (1.0, 0.95))
    for wind in ((0.0, 15.0), (15.0, 0.0)):
        vehicle = SurveyAircraft(GroundSpeed(20.0, wind), 30.0)
        best = plan_coverage(CoverageTask(narrow, 20.0), vehicle)
        for direction in (0.0, math.pi / 2, 0.4):
            assert best.time <= plan_coverage(CoverageTask(narrow, 20.0, direction=direction), vehicle).time * 1.02


def test_the_path_begins_and_ends_where_it_is_told():
    start, end = End(-200.0, 50.0, 0.5), End(400.0, 300.0)
    plan = plan_coverage(CoverageTask(make_field(SQUARE), 25.0, start=start, end=end), AIRCRAFT)
    assert_is_one_path(plan)
    assert plan.segments[0, :3] == pytest.approx((-200.0, 50.0, 0.5))
    assert ends_of(plan.segments)[-1, :2] == pytest.approx((400.0, 300.0), abs=1e-3)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("radius", [0.0, 3.0])
def test_a_ground_vehicle_covers_a_field_with_a_hole(seed, radius):
    rng = np.random.default_rng(seed)
    field = make_field(SQUARE * 0.5, [HOLE * 0.5 + rng.uniform(-10, 10, 2)])
    plan = plan_coverage(CoverageTask(field, 4.0), GroundVehicle(1.0, radius, headlands=2))
    assert plan.covered >= 0.995
    assert (plan.kinds == HEADLAND).sum() == 16
    if radius == 0.0:
        assert_is_one_path(plan, turns_on_the_spot=True)
        assert plan.outside == 0.0
        assert field.shape.buffer(1e-3).covers(shapely.LineString(plan.path()[:, :2]))


def test_ways_between_parts_of_the_swaths_lead_round_a_hole():
    wall = make_field(SQUARE, [np.array([[-1.0, 90.0], [250.0, 90.0], [250.0, 110.0], [-1.0, 110.0]])])
    plan = plan_coverage(CoverageTask(wall, 8.0, start=End(5.0, 5.0), end=End(5.0, 195.0)), GroundVehicle(2.0))
    assert plan.outside == 0.0
    assert plan.covered >= 0.995
    assert_is_one_path(plan, turns_on_the_spot=True)


def test_parts_that_no_way_joins_are_refused_on_the_ground_and_flown_in_the_air():
    split = make_field(SQUARE, [np.array([[100, -1], [110, -1], [110, 201], [100, 201]])])
    with pytest.raises(ValueError, match="each part"):
        plan_coverage(CoverageTask(split, 5.0), GroundVehicle(1.0))
    assert plan_coverage(CoverageTask(split, 20.0), AIRCRAFT).covered >= 0.995


def test_a_field_narrower_than_the_width_is_one_swath():
    strip = make_field(np.array([[0, 0], [300, 30], [300, 33], [0, 3]]))
    plan = plan_coverage(CoverageTask(strip, 16.0), AIRCRAFT)
    assert len(plan.swaths) == 1
    assert plan.covered >= 0.995
    assert plan.length < 450.0
    assert plan.swath_ratio == pytest.approx(16.0 / 3.0, rel=0.05)


@pytest.mark.parametrize(
    "outline",
    [
        [[0, 0], [100, 0], [100, 80], [50, 80], [50, 80.001], [0, 80.002]],
        [[0, 0], [100, 0], [100, 100], [50, 1e-9], [0, 100]],
        [[0, 0], [100, 0], [100, 60], [100, 900], [100.01, 60], [100.02, 0], [100.02, -30]],
        [[1e6, 1e6], [1e6 + 80, 1e6], [1e6 + 80, 1e6 + 60], [1e6, 1e6 + 60]],
        [[50 + 40 * math.cos(k / 40), 40 * math.sin(k / 40)] for k in range(251)],
    ],
)
def test_odd_outlines_are_covered(outline):
    field = make_field(np.array(outline, dtype=float))
    plan = plan_coverage(CoverageTask(field, 7.0), AIRCRAFT)
    assert_is_one_path(plan)
    assert plan.covered >= 0.995


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"width": 0.0}, "spacing of 0 m"),
        ({"width": math.nan}, "spacing of nan m"),
        ({"share": 1.5}, "share"),
        ({"overshoot": -1.0}, "overshoot"),
        ({"direction": math.inf}, "direction"),
    ],
)
def test_numbers_that_make_no_sense_are_refused(changes, why):
    with pytest.raises(ValueError, match=why):
        CoverageTask(**{"field": make_field(SQUARE), "width": 10.0, **changes})


def test_too_many_swaths_are_refused_soon():
    begun = time.perf_counter()
    with pytest.raises(ValueError, match="1200 at most"):
        plan_coverage(CoverageTask(make_field(SQUARE), 0.05), AIRCRAFT)
    assert time.perf_counter() - begun < 30.0


def test_the_same_seed_plans_the_same():
    field = comb(np.random.default_rng(11))
    one, other = (plan_coverage(CoverageTask(field, 15.0, seed=4), AIRCRAFT) for _ in range(2))
    assert (one.segments == other.segments).all()


def test_a_ring_as_wide_as_two_passes_needs_no_swath():
    inner = np.array([[1.0, 1.0], [9.0, 1.0], [9.0, 9.0], [1.0, 9.0]])
    ring = make_field(np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]), [inner])
    plan = plan_coverage(CoverageTask(ring, 0.5), GroundVehicle(1.0))
    assert len(plan.swaths) == 0
    assert plan.covered >= 0.995
    assert plan.length_ratio < 1.05


def test_a_spike_narrower_than_the_tool_is_driven_along_inside():
    spiked = make_field(np.array([[0.0, 0.0], [40.0, 0.0], [40.0, 20.0], [1.0, 20.0], [0.0, 90.0]]))
    plan = plan_coverage(CoverageTask(spiked, 2.0), GroundVehicle(1.0))
    assert plan.covered >= 0.995
    assert plan.outside < 1e-3
    assert plan.swaths[:, 1::2].max() > 70.0
