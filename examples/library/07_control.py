"""Asks the control loops of an aircraft for a bank to the right while it flies straight and level."""

import math

from uvf.control import AltitudeAirspeedSetpoint, FlightControl, Servos
from uvf.control.servos import ServoLimits
from uvf.estimation import Estimate
from uvf.models import AirParams

level = dict.fromkeys(("north", "east", "course", "climb", "roll", "yaw", "p", "q", "r", "side_force", "wind_north", "wind_east"), 0.0)
now = Estimate(**level, height=60.0, ground_speed=25.0, airspeed=25.0, pitch=0.03, density=1.225, position_sigma=0.5, height_known=True)
limits = ServoLimits(limit=0.35, rate=5.0)  # rad, rad/s
control = FlightControl(Servos(aileron=limits, elevator=limits, rudder=limits))
wanted = AltitudeAirspeedSetpoint(bank=math.radians(20), height=60.0, climb=0.0, airspeed=25.0)
surfaces = control.step(now, wanted, AirParams(), dt=0.02)
print(f"aileron {surfaces.aileron:.3f} rad, elevator {surfaces.elevator:.3f} rad, throttle {surfaces.throttle:.2f}")
