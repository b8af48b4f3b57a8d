"""An aircraft's sensors that look about: lidar, sonars and range finders."""

import copy
from collections.abc import Callable
from functools import partial
from typing import Self

import numpy as np
from google.protobuf.message import Message

from services.sim_air.engine.states import AircraftMotion
from uvf.maths.raycast import MovingBody, Scene
from uvf.models.vehicle.sensors import Lidar, RangeFinder, Sensors, Sonar
from uvf.runtime.messages.outputs import Value
from uvf.runtime.messages.readings.sensors import range_message, scan_message
from uvf.sensors.fitted import line_of
from uvf.sensors.range_sensors import LidarModel, RangeModel
from uvf.sensors.sampling import DelayLine

Rng = Callable[[str], np.random.Generator]
Look = Callable[[float, AircraftMotion, list[MovingBody]], Message]
Fitted = tuple[str, DelayLine[Message], Look]
"""Output name, the readings' way out, and how one is taken."""


class Rangers:
    """The range sensors of an aircraft; ``rng`` gives each of them a generator of its own by its name."""

    def __init__(self, vehicle: str, sensors: Sensors, scene: Scene, rng: Rng) -> None:
        self._vehicle = vehicle
        self._scene = scene
        self._rng = rng
        self._fitted: list[Fitted] = []
        if sensors.lidar is not None:
            model = LidarModel(sensors.lidar, scene, rng("lidar"))
            look = partial(_scan, f"{vehicle}/{sensors.lidar.frame}", sensors.lidar, model)
            self._fitted.append(("scan", line_of(sensors.lidar, rng("lidar/dropout")), look))
        for sonar in sensors.sonars:
            self._fitted.append(self._ranger("sonar", sonar))
        for finder in sensors.rangefinders:
            self._fitted.append(self._ranger("range", finder))

    def __deepcopy__(self, memo: dict[int, object]) -> Self:
        """Sensors that go on from here by themselves; the world they look at is shared."""
        memo |= {id(part): part for part in (self._scene, self._rng)}
        twin = object.__new__(type(self))
        twin.__dict__ = copy.deepcopy(self.__dict__, memo)
        return twin

    def _ranger(self, output: str, sensor: Sonar | RangeFinder) -> Fitted:
        model = RangeModel(sensor, self._scene, self._rng(f"{output}/{sensor.frame}"))
        look = partial(_range, f"{self._vehicle}/{sensor.frame}", sensor, model)
        return output, line_of(sensor, self._rng(f"{output}/{sensor.frame}/dropout")), look

    def read(self, t: float, motion: AircraftMotion, others: Callable[[], list[MovingBody]]) -> dict[str, Value]:
        """Readings that arrive at ``t`` [s], by output name; ``others``, the moving bodies, is called when a ray is cast."""
        found: dict[str, list[Message]] = {}
        for output, line, look in self._fitted:
            if (message := line.step(t, lambda look=look: look(t, motion, others()))) is not None:  # type: ignore[misc]
                found.setdefault(output, []).append(message)
        return {output: messages[0] if output == "scan" else messages for output, messages in found.items()}


def _scan(frame: str, lidar: Lidar, model: LidarModel, t: float, motion: AircraftMotion, others: list[MovingBody]) -> Message:
    return scan_message(t, frame, lidar, model.scan(motion, others))


def _range(
    frame: str, sensor: Sonar | RangeFinder, model: RangeModel, t: float, motion: AircraftMotion, others: list[MovingBody]
) -> Message:
    return range_message(t, frame, sensor, model.range(motion, others))
