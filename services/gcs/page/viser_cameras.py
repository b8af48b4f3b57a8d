"""One browser's folder with its vehicle's camera picture, and below it the sliders of its gimbal; sent only what has changed."""

from collections.abc import Callable
from math import degrees, radians
from typing import Any

import numpy as np

from services.gcs.actions import Action, AimGimbal
from services.gcs.view.camera_panel import MODES, GimbalPanel
from services.gcs.view.drawing import PagePanel

FULL_TURN = 180.0  # deg
ROUNDED = radians(0.5)  # the sliders' ends are whole degrees


class ViserCameras:
    """Camera picture and gimbal sliders. gui: the browser's; ask: takes the action of a slider."""

    def __init__(self, gui: Any, ask: Callable[[Action], None]) -> None:
        self._ask = ask
        self._image: bytes | None = None
        self._panel: GimbalPanel | None = None
        self._folder = gui.add_folder("Camera", order=60, visible=False)
        with self._folder:
            self.words: Any = gui.add_html("", order=0)
            self._picture: Any = gui.add_image(np.zeros((2, 2, 3), dtype=np.uint8), format="jpeg", order=1, visible=False)
            self._pan: Any = gui.add_slider("Pan", -FULL_TURN, FULL_TURN, 1.0, 0.0, order=2, visible=False, hint="degrees, left positive")
            self._tilt: Any = gui.add_slider("Tilt", -FULL_TURN, FULL_TURN, 1.0, 0.0, order=3, visible=False, hint="degrees, down positive")
            hint = "horizon level, pan from the heading or from east; or fixed to the body"
            self._mode: Any = gui.add_dropdown("Gimbal", tuple(MODES), order=4, visible=False, hint=hint)
        for handle in self._controls:
            handle.on_update(self._moved)

    @property
    def _controls(self) -> tuple[Any, ...]:
        return self._pan, self._tilt, self._mode

    async def _moved(self, event: Any) -> None:
        """By somebody on a page, not by us, and within what the sliders can be set to."""
        panel, mode = self._panel, MODES.get(self._mode.value)
        if event.client is None or panel is None or mode is None:
            return
        pan, tilt = radians(self._pan.value), radians(self._tilt.value)
        if abs(pan) <= panel.pan_max + ROUNDED and panel.tilts[0] - ROUNDED <= tilt <= panel.tilts[1] + ROUNDED:
            self._ask(AimGimbal(panel.vehicle, pan, tilt, mode))

    def show(self, shown: PagePanel) -> None:
        """Shows the camera picture and the gimbal of a panel."""
        self._show_controls(shown.gimbal)
        there = bool(shown.html.get("cameras"))
        if self._folder.visible != there:
            self._folder.visible = there
        if shown.image is not None and shown.image != self._image:
            self._image = self._picture._data = shown.image
        if self._picture.visible != (shown.image is not None):
            self._picture.visible = shown.image is not None

    def _show_controls(self, panel: GimbalPanel | None) -> None:
        """Set when another gimbal comes on show; from then on whoever moves them does."""
        before = self._panel
        self._panel = panel
        for handle in self._controls:
            if handle.visible != (panel is not None):
                handle.visible = panel is not None
        if panel is None or (before is not None and before.vehicle == panel.vehicle):
            return
        self._pan.min, self._pan.max = (round(degrees(way * panel.pan_max)) for way in (-1, 1))
        self._tilt.min, self._tilt.max = (round(degrees(tilt)) for tilt in panel.tilts)
        self._pan.value, self._tilt.value, self._mode.value = degrees(panel.pan), degrees(panel.tilt), panel.mode
