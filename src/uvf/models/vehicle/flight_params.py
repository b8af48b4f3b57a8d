"""Parameters of the air autopilot; a vehicle.yaml sets those of its airframe, the rest are good for its class."""

from typing import Annotated, Literal

from msgspec import Meta

from uvf.models.vehicle.failsafe_params import FailsafeParams


def _meta(low: float, high: float, unit: str, about: str) -> Meta:
    return Meta(ge=low, le=high, description=about, extra_json_schema={"unit": unit})


FIXED = frozenset({"estimator"})
"""Read only when the autopilot starts."""


class AirParams(FailsafeParams, frozen=True):
    """Parameters of an aircraft's autopilot. Names have at most 16 characters, the length of a MAVLink parameter."""

    estimator: Annotated[Literal["full", "book"], Meta(description="error-state filter, or the two filters of Beard & McLain")] = "full"

    # airframe: what the wing and tail do, from the linear coefficients (see design.py)
    trim_airspeed: Annotated[float, _meta(2, 300, "m/s", "cruise; surface gains are given for it")] = 25.0
    min_airspeed: Annotated[float, _meta(2, 300, "m/s", "lowest airspeed commanded")] = 19.0
    max_airspeed: Annotated[float, _meta(2, 400, "m/s", "highest airspeed commanded")] = 32.0
    trim_throttle: Annotated[float, _meta(0, 1, "", "throttle of level cruise")] = 0.6
    alpha_zero_lift: Annotated[float, _meta(-0.3, 0.3, "rad", "angle of attack without lift")] = -0.04
    alpha_per_load: Annotated[float, _meta(0, 2000, "rad m", "rise of the angle of attack per lift acceleration over EAS squared")] = 6.0
    alpha_max: Annotated[float, _meta(0.05, 0.6, "rad", "largest angle of attack flown")] = 0.2
    flap_alpha: Annotated[float, _meta(0, 1, "", "fall of the angle of attack per flap; 0: flaps make no lift at once")] = 0.0
    elev_zero_alpha: Annotated[float, _meta(-0.5, 0.5, "rad", "elevator that balances zero angle of attack")] = 0.0
    elev_per_alpha: Annotated[float, _meta(-10, 0, "", "elevator that balances a unit of angle of attack")] = -1.0

    # inner loops
    roll_time: Annotated[float, _meta(0.1, 2, "s", "time constant of roll to its command")] = 0.3
    roll_ff: Annotated[float, _meta(0, 2, "s", "aileron per commanded roll rate")] = 0.15
    roll_p: Annotated[float, _meta(0, 2, "s", "aileron per error of roll rate")] = 0.05
    roll_i: Annotated[float, _meta(0, 2, "", "aileron per integrated error of roll rate")] = 0.1
    pitch_time: Annotated[float, _meta(0.1, 2, "s", "time constant of pitch to its command")] = 0.4
    pitch_ff: Annotated[float, _meta(0, 2, "s", "elevator per commanded pitch rate")] = 0.1
    pitch_p: Annotated[float, _meta(0, 2, "s", "elevator per error of pitch rate")] = 0.1
    pitch_i: Annotated[float, _meta(0, 2, "", "elevator per integrated error of pitch rate")] = 0.2
    yaw_damping: Annotated[float, _meta(0, 1, "s", "rudder per yaw rate beyond that of a coordinated turn")] = 0.15
    rudder_mix: Annotated[float, _meta(-2, 2, "", "rudder per aileron, against what ailerons and rolling yaw")] = 0.0
    aileron_turn: Annotated[float, _meta(-2, 2, "s", "aileron per yaw rate of a turn, against the roll that the turn makes")] = 0.0
    rudder_turn: Annotated[float, _meta(-2, 2, "s", "rudder per yaw rate of a turn, so that it does not slip")] = 0.0
    slip_i: Annotated[float, _meta(0, 1, "rad s/m", "rudder per integrated side force but the rudder's own")] = 0.01
    rudder_force: Annotated[float, _meta(-50, 50, "m/s^2", "side force of the rudder alone, per rad at the trim airspeed")] = 0.0
    turn_ff: Annotated[float, _meta(0, 10, "s", "airship: rudder per commanded turn rate")] = 0.5
    turn_i: Annotated[float, _meta(0, 10, "", "airship: rudder per integrated error of turn rate")] = 0.2

    # altitude and airspeed
    law: Annotated[
        Literal["energy", "thesis", "airship"],
        Meta(description="energy: total energy and rate loops; thesis: its loops and gains; airship: turns by its rudder"),
    ] = "energy"
    altitude_p: Annotated[float, _meta(0, 2, "1/s", "climb rate per error of altitude")] = 0.5
    climb_p: Annotated[float, _meta(0, 4, "", "pitch per error of climb angle")] = 1.0
    climb_i: Annotated[float, _meta(0, 1, "1/s", "pitch per integrated error of climb angle")] = 0.6
    final_roll_time: Annotated[float, _meta(0.1, 2, "s", "roll_time on the final approach, and where an attitude is asked for")] = 0.3
    final_roll_p: Annotated[float, _meta(0, 2, "s", "roll_p on the final approach, and where an attitude is asked for")] = 0.05
    final_roll_i: Annotated[float, _meta(0, 2, "", "roll_i on the final approach, and where an attitude is asked for")] = 0.1
    final_course_p: Annotated[float, _meta(0.1, 5, "1/s", "course_p on the final approach")] = 1.0
    final_k_path: Annotated[float, _meta(0.001, 1, "1/m", "k_path on the final approach")] = 0.04
    final_climb_p: Annotated[float, _meta(0, 8, "", "climb_p on the final approach, where comfort does not count")] = 3.0
    final_pitch_time: Annotated[float, _meta(0.1, 2, "s", "pitch_time on the final approach, and where an attitude is asked for")] = 0.28
    final_pitch_p: Annotated[float, _meta(0, 2, "s", "pitch_p on the final approach, and where an attitude is asked for")] = 0.15
    final_pitch_i: Annotated[float, _meta(0, 2, "", "pitch_i on the final approach, and where an attitude is asked for")] = 0.4
    flare_p: Annotated[float, _meta(0.1, 3, "1/s", "climb rate per error of height in the flare")] = 1.5
    climb_max: Annotated[float, _meta(0.5, 15, "m/s", "fastest climb")] = 4.0
    sink_max: Annotated[float, _meta(0.5, 15, "m/s", "fastest descent")] = 4.0
    airspeed_p: Annotated[float, _meta(0.05, 2, "1/s", "acceleration per error of airspeed")] = 0.8
    airspeed_pitch_p: Annotated[float, _meta(0.02, 2, "1/s", "airspeed_p by pitch, while the throttle is at its stop")] = 0.8
    power_pole: Annotated[float, _meta(0.05, 5, "rad/s", "how fast the power that throttle and trim do not explain is learnt")] = 0.9
    throttle_climb: Annotated[float, _meta(0, 0.5, "s/m", "throttle per climb rate; 0: it has no engine")] = 0.04
    idle_sink: Annotated[float, _meta(0.1, 20, "m/s", "sink at cruise airspeed when less throttle brakes no more")] = 5.0
    throttle_load: Annotated[float, _meta(0, 0.5, "", "throttle per load factor squared beyond one")] = 0.01
    throttle_speed: Annotated[float, _meta(0, 0.2, "s/m", "throttle per airspeed beyond cruise")] = 0.03

    # guidance
    chi_inf: Annotated[float, _meta(0.1, 1.57, "rad", "course towards a line from far away")] = 1.0472
    k_path: Annotated[float, _meta(0.001, 1, "1/m", "steepness of the field about a line, at cruise")] = 0.04
    k_orbit: Annotated[float, _meta(0, 15, "", "steepness of the field about an orbit, by its radius; 0: as about a line")] = 0.0
    course_p: Annotated[float, _meta(0.1, 5, "1/s", "turn rate per error of course")] = 1.0
    course_i: Annotated[float, _meta(0, 2, "1/s^2", "turn rate per integrated error of course")] = 0.03
    lead_time: Annotated[float, _meta(0, 2, "s", "how early a bend of the path is banked for")] = 0.3
    bank_time: Annotated[float, _meta(0, 2, "s", "how far a change of the bend is banked for beyond that")] = 0.0
    bank_limit: Annotated[float, _meta(0.1, 1.2, "rad", "largest bank commanded")] = 1.05
    roll_in: Annotated[float, _meta(0.5, 10, "s", "time from level to turn_bank that turns are planned with")] = 1.0
    turn_bank: Annotated[float, _meta(0.1, 1.1, "rad", "bank that turns between legs are planned for")] = 0.9
    load_max: Annotated[float, _meta(1.05, 10, "", "largest load factor flown")] = 3.0
    pitch_limit: Annotated[float, _meta(0.1, 1, "rad", "largest pitch commanded, up and down")] = 0.45

    # following a leader
    follow_p: Annotated[float, _meta(0, 2, "1/s", "speed per distance behind the station")] = 0.4
    follow_i: Annotated[float, _meta(0, 0.5, "1/s^2", "speed per integrated distance behind the station")] = 0.01
    follow_sep: Annotated[float, _meta(2, 500, "m", "least distance from another aircraft of the formation")] = 10.0

    # modes
    hold_radius: Annotated[float, _meta(20, 20000, "m", "orbit of Hold and Return, clockwise")] = 90.0
    return_altitude: Annotated[float, _meta(10, 1000, "m", "lowest altitude of Return, above home")] = 60.0
    descend_alt: Annotated[float, _meta(0, 1000, "m", "height above home that Return comes down to, over it; 0: it stays up")] = 0.0
    land_delay: Annotated[float, _meta(-1, 3600, "s", "circled over home by Return until it lands; below 0: it does not land")] = -1.0
    takeoff_alt: Annotated[float, _meta(5, 1000, "m", "height above the start at which a take-off is done")] = 40.0
    takeoff_pitch: Annotated[float, _meta(0.05, 0.5, "rad", "nose up when the wheels are to leave the ground")] = 0.2
    takeoff_throttle: Annotated[float, _meta(0.05, 1, "", "throttle of the take-off; less where a strong motor would turn it over")] = 1.0
    launch_push: Annotated[float, _meta(0, 200, "m/s^2", "forward push of a catapult or throw; 0: takes off from its wheels")] = 0.0
    glide_slope: Annotated[float, _meta(0.03, 0.2, "rad", "down the final approach")] = 0.08
    land_flap: Annotated[float, _meta(0, 1, "rad", "flaps on the final approach")] = 0.0
    crosswind_max: Annotated[float, _meta(0, 100, "m/s", "crosswind at 10 m in which it lands; in more it waits on the circle")] = 8.0
    gear_height: Annotated[float, _meta(0, 5, "m", "of the IMU and range finder over the ground the aircraft stands on")] = 0.3
    gear: Annotated[Literal["nose_wheel", "tail_wheel", "belly"], Meta(description="what it stands, takes off and lands on")] = "nose_wheel"
    brake_steering: Annotated[float, _meta(0, 5, "", "brake on one wheel per rad of rudder asked for; 0: a wheel steers")] = 0.0
    rest_pitch: Annotated[float, _meta(-0.3, 0.5, "rad", "nose up as it stands on its landing gear")] = 0.0
    min_altitude: Annotated[float, _meta(0, 1000, "m", "a goal below this is flown to at the present altitude")] = 30.0
