"""Rays in space against known distances, against the solids as meshes, and under motion of the whole scene."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from tests import planar_rays as raycast
from tests.maths.scenes import random_directions, random_parts, torus, turn
from uvf.maths.bvh import build
from uvf.maths.raycast import MovingBody, Rays, Scene, cast, warm_up
from uvf.maths.rotations import IDENTITY, from_euler, matrix
from uvf.maths.solids import BOX, CYLINDER, SPHERE, box, cylinder, joined, mesh, sphere

EAST, UP = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
NOTHING = build(joined([]))
untimed = settings(deadline=None, max_examples=60)
seeds = st.integers(0, 10_000)


def one(parts, origin, direction, **more):
    return cast(Scene(build(joined(parts)), **more), [], Rays(np.array(origin, dtype=float), np.array([direction], dtype=float)), 100.0)[0]


def scan(parts, rays, max_range=100.0):
    return cast(Scene(build(joined(parts))), [], rays, max_range)


def random_rays(rng, n=64, reach=6.0):
    return Rays(rng.uniform(-reach, reach, (n, 3)), random_directions(rng, n))


def assert_same_but_for_grazes(one, other, grazes=1, tolerance=1e-9):
    unlike = np.isinf(one) != np.isinf(other)
    both = np.isfinite(one) & np.isfinite(other)
    unlike[both] = np.abs(one[both] - other[both]) > tolerance * (1 + one[both])
    assert unlike.sum() <= grazes


def test_the_near_face_of_each_solid_is_met():
    assert one([box((2, 1, 1), (3, 0, 0))], (0, 0, 0), EAST) == pytest.approx(2.0)
    assert one([cylinder(0.5, 2.0, (3, 0, 0))], (0, 0, 0.9), EAST) == pytest.approx(2.5)
    assert one([cylinder(0.5, 2.0, (0, 0, 3))], (0.4, 0, 0), UP) == pytest.approx(2.0)
    assert one([sphere(0.5, (3, 0, 0))], (0, 0, 0), EAST) == pytest.approx(2.5)
    assert one([mesh(((3, -1, -1), (3, 1, -1), (3, 0, 1)), ((0, 1, 2),))], (0, 0, 0), EAST) == pytest.approx(3.0)


def test_from_inside_a_solid_its_exit_counts_as_it_does_in_the_plane():
    assert one([box((2, 1, 1), (0, 0, 0))], (0.25, 0, 0), EAST) == pytest.approx(0.75)
    assert one([cylinder(0.5, 2.0, (0, 0, 0))], (0.1, 0, 0), UP) == pytest.approx(1.0)
    assert one([sphere(0.5, (0, 0, 0))], (0.2, 0, 0), EAST) == pytest.approx(0.3)


def test_what_lies_behind_beside_or_beyond_the_range_is_not_met():
    parts = [box((1, 1, 1), (-3, 0, 0)), sphere(0.5, (3, 0.51, 0)), cylinder(0.5, 1.0, (3, 0, 0.51)), box((1, 1, 1), (200, 0, 0))]
    assert one(parts, (0, 0, 0), EAST) == np.inf


def test_a_surface_just_at_the_range_is_met():
    rays = Rays(np.zeros(3), np.array([EAST]))
    assert scan([box((2, 1, 1), (3, 0, 0))], rays, 2.0)[0] == 2.0
    assert scan([box((2, 1, 1), (3, 0, 0))], rays, 1.999)[0] == np.inf


def test_a_triangle_has_two_sides():
    sheet = [mesh(((3, -1, -1), (3, 1, -1), (3, 0, 1)), ((0, 1, 2),))]
    assert one(sheet, (6, 0, 0), (-1, 0, 0)) == pytest.approx(3.0)


def test_no_ray_slips_through_the_seams_of_a_mesh():
    vertices, faces = trimesh.creation.icosphere(subdivisions=2).vertices, trimesh.creation.icosphere(subdivisions=2).faces
    seams = [(vertices[a] + vertices[b]) / 2 for f in faces for a, b in ((f[0], f[1]), (f[1], f[2]))]
    aims = np.concatenate((np.asarray(vertices), np.array(seams)))
    rays = Rays(np.zeros(3), aims / np.linalg.norm(aims, axis=1, keepdims=True))
    assert np.isfinite(scan([mesh(vertices, faces)], rays)).all()


def test_the_ground_is_an_infinite_plane_seen_from_both_sides():
    slope = np.sin(np.pi / 6)
    assert one([], (5, 5, 2), (np.cos(np.pi / 6), 0, -slope), ground=-1.0) == pytest.approx(6.0)
    assert one([], (0, 0, -3), UP, ground=-1.0) == pytest.approx(2.0)
    assert one([], (0, 0, 0), EAST, ground=-1.0) == np.inf


def test_a_level_scan_is_that_of_the_plane():
    rng = np.random.default_rng(4)
    rows = np.column_stack((rng.uniform(-4, 4, (9, 2)), rng.uniform(0.2, 1.0, (9, 2)), rng.uniform(-3, 3, 9)))
    circles = np.column_stack((rng.uniform(-4, 4, (9, 2)), rng.uniform(0.1, 0.8, 9)))
    parts = [box((2 * a, 2 * b, 1), (x, y, 0.5), from_euler(0, 0, yaw)) for x, y, a, b, yaw in rows]
    parts += [cylinder(r, 1.0, (x, y, 0.5)) for x, y, r in circles]
    angles = np.linspace(-np.pi, np.pi, 360, endpoint=False)
    rays = Rays(np.array((0.3, 0.2, 0.4)), np.column_stack((np.cos(angles), np.sin(angles), np.zeros(360))))
    flat = raycast.cast(np.array((0.3, 0.2)), angles, raycast.rectangles(rows), circles)
    assert_same_but_for_grazes(scan(parts, rays), flat)


@untimed
@given(seeds)
def test_a_box_is_met_where_its_twelve_triangles_are(seed):
    rng = np.random.default_rng(seed)
    size, position, orientation = rng.uniform(0.2, 3, 3), rng.uniform(-2, 2, 3), turn(rng)
    cube = trimesh.creation.box(size)
    rays = random_rays(rng)
    assert_same_but_for_grazes(
        scan([box(size, position, orientation)], rays), scan([mesh(cube.vertices, cube.faces, position, orientation)], rays)
    )


def gap(part, points):
    """How far points [m or shares of the radius] are outside of a solid, from its definition; negative inside."""
    u = points @ part.rows[0].reshape(3, 4)[:, :3].T + part.rows[0].reshape(3, 4)[:, 3]
    if part.kinds[0] == BOX:
        return np.abs(u).max(axis=1) - 1
    if part.kinds[0] == CYLINDER:
        return np.maximum(np.hypot(u[:, 0], u[:, 1]), np.abs(u[:, 2])) - 1
    assert part.kinds[0] == SPHERE
    return np.linalg.norm(u, axis=1) - 1


@untimed
@given(seeds)
def test_hits_lie_on_the_surface_and_the_way_there_crosses_none(seed):
    rng = np.random.default_rng(seed)
    for part in random_parts(rng, each=1)[1:]:
        rays = Rays(rng.uniform(-2, 2, (64, 3)), random_directions(rng, 64))
        rays = Rays(rays.origins + (part.low[0] + part.high[0]) / 2, rays.directions)
        ranges = scan([part], rays)
        met = np.isfinite(ranges)
        assert gap(part, rays.origins + np.where(met, ranges, 0)[:, None] * rays.directions)[met] == pytest.approx(0, abs=1e-9)
        side = np.sign(gap(part, rays.origins))
        for share in np.linspace(0.01, 0.99, 20):
            between = gap(part, rays.origins + (share * np.where(met, ranges, 20.0))[:, None] * rays.directions)
            assert (np.sign(between) == side).all() or (np.abs(between[np.sign(between) != side]) < 1e-9).all()


@untimed
@given(seeds)
def test_moving_and_turning_scene_and_rays_together_changes_nothing(seed):
    rng = np.random.default_rng(seed)
    parts, rays = random_parts(rng), random_rays(rng)
    shift, turned = rng.uniform(-50, 50, 3), turn(rng)
    r = matrix(turned)
    before = scan(parts, rays)
    after = cast(
        Scene(NOTHING), [MovingBody(build(joined(parts)), shift, turned)], Rays(rays.origins @ r.T + shift, rays.directions @ r.T), 100.0
    )
    assert_same_but_for_grazes(before, after)


@untimed
@given(seeds)
def test_parts_moved_one_by_one_are_the_body_moved_as_a_whole(seed):
    rng = np.random.default_rng(seed)
    shift, turned, size = rng.uniform(-3, 3, 3), turn(rng), rng.uniform(0.3, 2, 3)
    vertices, faces = torus()
    rays = random_rays(rng)
    whole = [MovingBody(build(joined([box(size, (0, 0, 0)), mesh(vertices, faces)])), shift, turned)]
    single = [box(size, shift, turned), mesh(vertices, faces, shift, turned)]
    assert_same_but_for_grazes(cast(Scene(NOTHING), whole, rays, 100.0), scan(single, rays))


@untimed
@given(seeds, st.floats(1e-3, 1e3))
def test_directions_of_another_length_give_distances_in_that_length(seed, scale):
    rng = np.random.default_rng(seed)
    parts, rays = random_parts(rng, each=3), random_rays(rng)
    longer = scan(parts, Rays(rays.origins, rays.directions * scale), 100.0 / scale)
    assert_same_but_for_grazes(scan(parts, rays), longer * scale)


def read_only(rows):
    array = np.array(rows)
    array.flags.writeable = False
    return array


@untimed
@given(seeds, st.integers(0, 12), st.booleans())
def test_the_tree_gives_what_all_primitives_give_bit_for_bit(seed, each, along_axes):
    rng = np.random.default_rng(seed)
    tree = build(joined(random_parts(rng, each)))
    directions = np.tile(np.concatenate((np.eye(3), -np.eye(3))), (10, 1)) if along_axes else random_directions(rng, 60)
    rays = Rays(rng.uniform(-6, 6, (60, 3)).round(2), directions)
    leaf = tree._replace(bounds=read_only([[-1e3] * 3 + [1e3] * 3]), links=read_only([[0, len(tree.kinds)]]), depth=0)
    assert np.array_equal(cast(Scene(tree), [], rays, 100.0), cast(Scene(leaf), [], rays, 100.0))


def test_a_sensor_does_not_see_the_body_that_it_leaves_out():
    chassis = build(box((0.4, 0.3, 0.2), (0, 0, 0.1)))
    bodies = {"one": MovingBody(chassis, np.zeros(3)), "other": MovingBody(chassis, np.array((2.0, 0, 0)), from_euler(0, 0, np.pi / 2))}
    rays = Rays(np.array((0, 0, 0.1)), np.array([EAST]))
    others = [body for name, body in bodies.items() if name != "one"]
    assert cast(Scene(NOTHING), others, rays, 10.0)[0] == pytest.approx(1.85)
    assert cast(Scene(NOTHING), list(bodies.values()), rays, 10.0)[0] == pytest.approx(0.2)


def test_the_nearest_of_scene_ground_and_bodies_counts():
    scene = Scene(build(box((1, 1, 1), (5, 0, 0.5))), 0.0)
    down_ahead = Rays(np.array((0.0, 0, 1)), np.array([(0, 0, -1.0), (np.sqrt(0.5), 0, -np.sqrt(0.5)), (1, 0, -1e-3)]))
    low = MovingBody(build(sphere(0.25, (0, 0, 0))), np.array((0, 0, 0.25)))
    assert cast(scene, [low], down_ahead, 20.0) == pytest.approx([0.5, np.sqrt(2), 4.5], rel=1e-3)


def test_one_origin_serves_all_directions_and_a_wrong_number_is_refused():
    rng = np.random.default_rng(7)
    parts, directions = random_parts(rng), random_directions(rng, 40)
    shared = scan(parts, Rays(np.array((3.0, 0, 3)), directions))
    assert np.array_equal(shared, scan(parts, Rays(np.tile((3.0, 0, 3), (40, 1)), directions)))
    with pytest.raises(ValueError, match="2 origins for 40 directions"):
        scan(parts, Rays(np.zeros((2, 3)), directions))
    assert scan(parts, Rays(np.zeros(3), np.zeros((0, 3)))).shape == (0,)


def test_an_identical_call_gives_identical_bits():
    results = [scan(random_parts(rng := np.random.default_rng(8)), random_rays(rng)) for _ in range(2)]
    assert np.array_equal(*results)


def test_after_the_warm_up_nothing_is_left_to_compile():
    warm_up()
    from uvf.maths.raycast import _cast_ground, _cast_tree

    before = [len(kernel.signatures) for kernel in (_cast_tree, _cast_ground)]
    rng = np.random.default_rng(9)
    tree = build(joined(random_parts(rng)))
    cast(Scene(tree, 0.0), [MovingBody(tree, rng.uniform(-1, 1, 3), turn(rng))], random_rays(rng), 30.0)
    cast(Scene(NOTHING, 0), [MovingBody(tree, (1, 2, 3), IDENTITY)], Rays(np.zeros(3), np.eye(3)), 30)
    strided, frozen = np.eye(4)[:3, 3], read_only(np.eye(3).T)
    cast(Scene(NOTHING), [MovingBody(tree, strided)], Rays(frozen[0], frozen.T[::-1]), 30.0)
    assert [len(kernel.signatures) for kernel in (_cast_tree, _cast_ground)] == before
