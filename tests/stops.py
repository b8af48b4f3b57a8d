"""STOP ALL as ``step`` is handed it."""

from schemas.messages import StopEngagement
from uvf.runtime.state.stop_all import StopStatus

NOBODY = StopStatus()
ENGAGED = StopStatus((StopEngagement(source="gcs", id=1, reason="button"),))
RELEASED = StopStatus(released_by="gcs")
