"""Tracks grow at their tail only, and break where the vehicle was moved."""

import numpy as np

from services.gcs.state.tracks import CHUNK, MAX_CHUNKS, VehicleTrack


def drive(track, n, step=1.0, start=0.0):
    for i in range(n):
        track.add(np.array((start + i * step, 0.0, 0.0)))


def test_points_nearer_than_the_spacing_are_left_out():
    track = VehicleTrack(spacing=0.5, jump=10.0)
    drive(track, 100, step=0.1)
    assert 18 <= track.tail_length <= 21
    assert np.diff(track.tail[:, 0]).min() >= 0.5 - 1e-9


def test_a_full_chunk_is_closed_and_the_tail_goes_on_from_its_end():
    track = VehicleTrack(0.5, 10.0)
    drive(track, CHUNK + 5)
    (number, chunk), tail = track.closed[0], track.tail
    assert (number, len(chunk)) == (0, CHUNK)
    assert np.array_equal(chunk[-1], tail[0])
    assert tail[-1, 0] == CHUNK + 4


def test_closed_chunks_never_change():
    track = VehicleTrack(0.5, 10.0)
    drive(track, CHUNK)
    before = track.closed[0][1]
    drive(track, 3 * CHUNK, start=CHUNK)
    assert track.closed[0][1] is before


def test_a_jump_breaks_the_line():
    track = VehicleTrack(0.5, 10.0)
    drive(track, 5)
    drive(track, 5, start=1000.0)
    assert track.closed[0][1][:, 0].max() == 4.0
    assert track.tail[:, 0].min() == 1000.0


def test_the_oldest_chunks_go_when_there_are_too_many():
    track = VehicleTrack(0.5, 10.0)
    drive(track, (MAX_CHUNKS + 3) * CHUNK)
    assert len(track.closed) == MAX_CHUNKS
    assert track.closed[0][0] > 0
