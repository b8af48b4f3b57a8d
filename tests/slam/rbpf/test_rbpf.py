"""The Rao-Blackwellized particle filter in a made-up room."""

import numpy as np
import pytest

from tests.services.slam.drives import broken, drive, odometry_of, off_by, truth
from uvf.maths.se2 import Pose2
from uvf.models.yaml_data import BadInput
from uvf.slam.matching.points import points_of
from uvf.slam.methods import make_method, method_params
from uvf.slam.rbpf.fit import log_likelihood
from uvf.slam.rbpf.method import RbpfSlam
from uvf.slam.rbpf.motion import MotionModel
from uvf.slam.rbpf.params import RbpfParams
from uvf.slam.rbpf.particle_step import draw_pose, match
from uvf.slam.rbpf.proposal import proposal

FEW = {"particles": 5, "linearUpdate": 0.2}


def run(readings, **params):
    method = RbpfSlam(RbpfParams(**FEW | params))
    return method, [method.add(reading) for reading in readings]


def test_a_room_is_tracked_within_centimetres_though_the_odometry_is_not():
    readings = drive(turns=1.1)
    method, told = run(readings)
    assert off_by(odometry_of(readings))[0] > 0.3
    assert off_by([e.map_from_base for e in told])[0] < 0.05
    metres, radians = off_by(method.trajectory())
    assert metres < 0.05
    assert radians < 0.03
    assert np.median([e.quality for e in told]) > 0.8


def test_a_lidar_that_turns_clockwise_and_sits_aside_is_tracked_too():
    assert off_by(run(drive(offset=True))[0].trajectory())[0] < 0.05


def test_keyframes_are_the_readings_of_the_updates_on_the_path_told():
    readings = drive()
    method, _ = run(readings)
    keyframes = list(method.keyframes())
    at = [next(i for i, r in enumerate(readings) if r is k.reading) for k in keyframes]
    assert at[0] == 0
    assert 10 < len(at) < 60
    assert at == sorted(set(at))
    assert np.array([k.map_from_base for k in keyframes]) == pytest.approx(method.trajectory()[at], abs=1e-9)


def test_the_same_seed_gives_the_same_path_and_another_one_another():
    first, again, other = (run(drive(30), seed=seed)[0].trajectory() for seed in (4, 4, 5))
    assert (first == again).all()
    assert (first != other).any()


def test_the_proposal_is_narrower_than_the_motion_model_where_the_sweep_tells():
    readings = drive(2)
    method, _ = run(readings[:1])
    sweep, grid = (points_of(readings[1], 80.0, 180), (0.0, 0.0)), method._map(0)
    model = MotionModel(0.1, 0.1, 0.1, 0.2).covariance(Pose2(0.5, 0.0, 0.3))
    prior = (truth(2)[1] + (0.04, -0.03, 0.02), np.linalg.inv(model))
    matched = match(prior[0], sweep, grid, prior, RbpfParams())
    rng = np.random.default_rng(1)
    drawn = np.array([draw_pose(matched, sweep, grid, prior, RbpfParams(), rng)[0] for _ in range(60)])
    assert (drawn.std(axis=0) < 0.3 * np.sqrt(np.diag(model))).all()
    assert np.abs(drawn.mean(axis=0) - truth(2)[1]).max() < 0.02


def test_the_weight_of_a_particle_is_the_integral_of_likelihood_times_motion_model():
    """Equation 19, found a second way: the mean likelihood at poses drawn from the motion model."""
    readings = drive(2)
    method, _ = run(readings[:1])
    sweep, grid = (points_of(readings[1], 80.0, 60), (0.0, 0.0)), method._map(0)
    model, sigma = np.diag((0.03, 0.03, 0.02)) ** 2, 0.3
    prior = (truth(2)[1] + (0.01, -0.01, 0.01), np.linalg.inv(model))
    matched = match(prior[0], sweep, grid, prior, RbpfParams(sigma=sigma))
    rng = np.random.default_rng(1)
    told = [proposal(matched.pose, matched.h, prior, (sweep, grid, sigma, 1.0), rng).log_weight for _ in range(40)]
    drawn = prior[0] + rng.standard_normal((4000, 3)) @ np.sqrt(model)
    likelihoods = np.exp([log_likelihood(pose, sweep, grid, sigma) for pose in drawn])
    assert np.mean(np.exp(told)) == pytest.approx(likelihoods.mean(), rel=0.15)


def test_the_motion_model_by_hand():
    """0.01 m and 0.005 rad of no motion; 1 m ahead and 0.5 rad on the spot on top."""
    model = MotionModel(srr=0.1, srt=0.2, str_=0.3, stt=0.4)
    ahead, turned = (np.sqrt(np.diag(model.covariance(m))) for m in (Pose2(1.0, 0.0, 0.0), Pose2(0.0, 0.0, -0.5)))
    assert ahead == pytest.approx((0.11, 0.11, 0.305))
    assert turned == pytest.approx((0.11, 0.11, 0.205))


def test_particles_that_lie_apart_make_the_pose_uncertain():
    readings = drive(12)
    method, told = run(readings)
    assert told[-1].covariance[0, 0] < 0.01
    method.particles.poses[:, 0] += np.arange(5.0)
    assert method.add(readings[-1]).covariance[0, 0] > 1.0


def test_where_nothing_is_seen_the_pose_is_drawn_from_the_motion_model():
    method, _ = run(drive(1))
    model = MotionModel(0.1, 0.1, 0.1, 0.2).covariance(Pose2(0.5, 0.0, 0.3))
    prior, nothing = (np.array((0.5, 0.0, 0.3)), np.linalg.inv(model)), (np.zeros((0, 2)), (0.0, 0.0))
    matched = match(prior[0], nothing, method._map(0), prior, RbpfParams())
    rng = np.random.default_rng(1)
    drawn = np.array([draw_pose(matched, nothing, method._map(0), prior, RbpfParams(), rng)[0] for _ in range(400)])
    assert not matched.found
    assert drawn.std(axis=0) == pytest.approx(np.sqrt(np.diag(model)), rel=0.15)


def test_a_particle_in_the_wrong_place_loses_its_weight():
    readings = drive(12)
    method, _ = run(readings[:11])
    k = (method.particles.best + 1) % 5
    method.particles.poses[k] += (0.5, -0.4, 0.3)
    before = method.particles.weights[k]
    method._update(readings[11], (points_of(readings[11], 80.0, 180), (0.0, 0.0)))
    assert method.particles.weights[k] < 0.5 * before or k not in method.particles._next


def test_a_match_below_the_minimum_score_is_not_believed():
    readings = drive(turns=1.1)
    method, told = run(readings, minimumScore=1e6, particles=2)
    assert off_by(method.trajectory())[0] > 0.1
    assert told[-1].covariance[0, 0] > 1e-4


def test_nothing_in_a_reading_ends_it():
    method, told = run(broken())
    assert np.isfinite(method.trajectory()).all()
    assert all(np.isfinite(e.covariance).all() and 0.0 <= e.quality <= 1.0 for e in told)
    assert off_by(run([*drive(), *broken()])[0].trajectory()[:80])[0] < 0.05


def test_parameters_have_gmappings_names():
    params = method_params("rbpf", {"particles": 3, "linearUpdate": 0.5, "str": 0.2, "maxUrange": 10.0}, "here")
    assert make_method("rbpf", params).trajectory().shape == (0, 3)
    with pytest.raises(BadInput, match="did you mean 'linearUpdate'"):
        method_params("rbpf", {"linear_update": 0.5}, "here")
    with pytest.raises(BadInput, match="particles"):
        method_params("rbpf", {"particles": 0}, "here")
