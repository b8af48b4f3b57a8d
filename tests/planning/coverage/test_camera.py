import math

import pytest

from uvf.planning.coverage.camera import SurveyCamera


def test_a_full_frame_camera_sees_as_the_similar_triangles_say():
    camera = SurveyCamera.from_sensor(36.0, 24.0, 35.0)
    across, along = camera.footprint(100.0)
    assert (across, along) == pytest.approx((100.0 * 36 / 35, 100.0 * 24 / 35))
    assert camera.spacing(100.0, 0.6) == pytest.approx(0.4 * across)
    assert camera.trigger_distance(100.0, 0.75) == pytest.approx(0.25 * along)
    assert SurveyCamera(math.pi / 2, 1.0).footprint(50.0)[0] == pytest.approx(100.0)


def test_what_is_no_camera_or_overlap_is_refused():
    for make in (lambda: SurveyCamera(0.0, 1.0), lambda: SurveyCamera(1.0, math.nan), lambda: SurveyCamera.from_sensor(36.0, 24.0, 0.0)):
        with pytest.raises(ValueError, match="give"):
            make()
    camera = SurveyCamera(1.0, 0.8)
    for refused in (lambda: camera.spacing(100.0, 1.0), lambda: camera.trigger_distance(100.0, -0.1), lambda: camera.footprint(0.0)):
        with pytest.raises(ValueError, match="give"):
            refused()
