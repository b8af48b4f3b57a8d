"""The scan and the clearance in closed form, beside PyBullet's rays and closest points."""

import numpy as np
import pytest

from benchmarks.planning.barn.contacts import pybullet
from benchmarks.planning.barn.jackal import SCANNER
from benchmarks.planning.barn.scanning import clearance_to_boxes, clearance_to_discs, see_discs, see_segments, sides

ANGLES = (SCANNER.angle_min, SCANNER.angle_increment)
HALF = (0.254, 0.216)


def scattered(seed):
    """Discs, boxes and a pose outside all of them."""
    rng = np.random.default_rng(seed)
    discs = np.column_stack((rng.uniform(-8, 8, (40, 2)), rng.uniform(0.05, 0.6, 40)))
    boxes = np.column_stack((rng.uniform(-8, 8, (6, 2)), rng.uniform(0.2, 4.0, (6, 2))))
    while True:
        pose = np.array((*rng.uniform(-6, 6, 2), rng.uniform(-7, 7)))
        if min(clearance_to_discs(pose, HALF, discs), clearance_to_boxes(pose, HALF, boxes)) > 0.3:
            return discs, boxes, pose


@pytest.fixture
def engine():
    client = pybullet.connect(pybullet.DIRECT)
    yield client
    pybullet.disconnect(client)


def bodies(client, discs, boxes):
    """One for each disc and box."""
    for x, y, radius in discs.tolist():
        shape = pybullet.createCollisionShape(pybullet.GEOM_CYLINDER, radius=radius, height=1.0, physicsClientId=client)
        yield pybullet.createMultiBody(0.0, shape, basePosition=(x, y, 0.0), physicsClientId=client)
    for x, y, a, b in boxes.tolist():
        shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=(a / 2, b / 2, 0.5), physicsClientId=client)
        yield pybullet.createMultiBody(0.0, shape, basePosition=(x, y, 0.0), physicsClientId=client)


@pytest.mark.parametrize("seed", range(4))
def test_a_scan_is_what_bullet_sees(engine, seed):
    discs, boxes, pose = scattered(seed)
    list(bodies(engine, discs, boxes))
    ranges = np.full(SCANNER.beams, np.inf)
    see_discs(pose, discs, ANGLES, ranges)
    see_segments(pose, sides(boxes), ANGLES, ranges)
    beams = np.arange(0, SCANNER.beams, 9)
    headings = pose[2] + SCANNER.angle_min + beams * SCANNER.angle_increment
    ends = pose[:2] + 30.0 * np.column_stack((np.cos(headings), np.sin(headings)))
    rays = pybullet.rayTestBatch([(*pose[:2], 0.0)] * len(beams), [(x, y, 0.0) for x, y in ends.tolist()], physicsClientId=engine)
    seen = np.array([30.0 * ray[2] if ray[0] >= 0 else np.inf for ray in rays])
    agree = np.isclose(ranges[beams], seen, rtol=0.0, atol=3e-3)
    assert np.isfinite(seen).sum() > 20
    assert (~agree).sum() <= 1  # a beam that grazes a disc


@pytest.mark.parametrize("seed", range(4))
def test_a_clearance_is_what_bullet_measures(engine, seed):
    discs, boxes, pose = scattered(seed)
    shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=(*HALF, 0.3), physicsClientId=engine)
    turned = pybullet.getQuaternionFromEuler((0.0, 0.0, pose[2]))
    robot = pybullet.createMultiBody(1.0, shape, -1, (*pose[:2], 0.0), turned, physicsClientId=engine)
    near = [pybullet.getClosestPoints(robot, body, 30.0, physicsClientId=engine)[0][8] for body in bodies(engine, discs, boxes)]
    assert clearance_to_discs(pose, HALF, discs) == pytest.approx(min(near[: len(discs)]), abs=2e-3)
    assert clearance_to_boxes(pose, HALF, boxes) == pytest.approx(min(near[len(discs) :]), abs=2e-3)


def test_a_disc_behind_is_not_seen_and_one_across_the_first_beam_is():
    for bearing, seen in ((np.pi, False), (SCANNER.angle_min, True), (-SCANNER.angle_min, True)):
        ranges = np.full(SCANNER.beams, np.inf)
        see_discs(np.zeros(3), np.array([(2.0 * np.cos(bearing), 2.0 * np.sin(bearing), 0.3)]), ANGLES, ranges)
        assert np.isfinite(ranges).any() == seen
        if seen:
            edge = 0 if bearing < 0 else -1
            assert ranges[edge] == pytest.approx(1.7, abs=1e-6)
            assert 0 < np.isfinite(ranges).sum() <= 0.5 + np.arcsin(0.3 / 2.0) / SCANNER.angle_increment + 1


def test_of_two_discs_in_a_line_the_near_one_is_seen():
    discs = np.array([(5.0, 0.0, 0.5), (3.0, 0.0, 0.1)])
    for order in (discs, discs[::-1].copy()):
        ranges = np.full(3, np.inf)
        see_discs(np.zeros(3), order, (-0.05, 0.05), ranges)
        assert ranges[1] == pytest.approx(2.9)
        assert ranges[0] == pytest.approx(5.0 * np.cos(0.05) - np.sqrt(0.25 - (5.0 * np.sin(0.05)) ** 2))


def test_within_a_disc_there_is_no_range():
    ranges = np.full(5, np.inf)
    see_discs(np.zeros(3), np.array([(0.1, 0.0, 0.2)]), (-0.1, 0.05), ranges)
    assert not ranges.any()


def test_an_overlap_is_negative_and_nothing_is_infinitely_far():
    assert clearance_to_discs(np.zeros(3), HALF, np.array([(0.3, 0.0, 0.1)])) == pytest.approx(0.3 - 0.254 - 0.1)
    assert clearance_to_discs(np.zeros(3), HALF, np.zeros((0, 3))) == np.inf
    assert clearance_to_boxes(np.zeros(3), HALF, np.zeros((0, 4))) == np.inf
