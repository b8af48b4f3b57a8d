"""Where numbers of a chart lie, whatever numbers they are."""

import numpy as np
import pytest

from services.gcs.view.panels.plots.chart import ChartFrame, curve, room


@pytest.mark.parametrize(
    ("low", "high"),
    (
        (0.0, 0.0),
        (1e11, np.nextafter(1e11, 2e11)),
        (-1e12, 1e12),
        (2.0**53, 2.0**53 + 2),
        (5.0, 5.0),
        (0.7853981, 0.7853992),
        (-1e-9, 1e-9),
    ),
)
def test_the_range_holds_all_and_is_never_flat(low, high):
    bottom, top = room(low, high, 1e-6)
    frame = ChartFrame(100.0, 0.0, 1.0, bottom, top)
    assert bottom < low <= high < top
    drawn = str(frame.grid(0.0)) + str(curve(frame, 0, "n", np.array((0.0, 1.0)), np.array((low, high))))
    assert "nan" not in drawn and "inf" not in drawn and "<text" in drawn
    assert [float(part) for part in str(frame.box()).split("data-frame='")[1].split("'")[0].split()][-2:] == [bottom, top]
