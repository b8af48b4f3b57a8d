"""``uvf vehicle new``: a round two-wheeled vehicle from four dimensions."""

from pathlib import Path
from typing import NamedTuple

from uvf.models.yaml_data import BadInput

DENSITY = 250.0  # kg/m^3 of the whole body: boards, batteries and air
HEAVIEST_WHEEL = 0.1  # of the body's mass

URDF = """<?xml version="1.0"?>
<!-- Made from four dimensions; change what is different. base_link lies on the floor under the middle of the axle, x forward. -->
<robot name="{name}" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="../common/colours.xacro"/>
  <xacro:include filename="../common/inertia.xacro"/>
  <xacro:include filename="../common/wheel.xacro"/>
  <xacro:include filename="../common/castor.xacro"/>
  <xacro:include filename="../common/lidar.xacro"/>

  <xacro:property name="deck_radius" value="{deck_radius:.4g}"/>
  <xacro:property name="clearance" value="{clearance:.4g}"/>
  <xacro:property name="height" value="{height:.4g}"/>

  <link name="base_link">
    <xacro:cylinder_inertial mass="{mass:.3g}" radius="${{deck_radius}}" length="${{height - clearance}}"
                             at="{com:.4g} 0 ${{(height + clearance) / 2.5}}"/>
    <collision>
      <origin xyz="0 0 ${{(height + clearance) / 2}}"/>
      <geometry><cylinder radius="${{deck_radius}}" length="${{height - clearance}}"/></geometry>
    </collision>
    <visual>
      <origin xyz="0 0 ${{(height + clearance) / 2}}"/>
      <geometry><cylinder radius="${{deck_radius}}" length="${{height - clearance}}"/></geometry>
      <material name="blue"/>
    </visual>
  </link>

  <xacro:wheel side="left" y="{half_track:.4g}" radius="{wheel_radius:.4g}" width="{width:.4g}" mass="{wheel_mass:.3g}"
               tyre="tyre" hub="steel"/>
  <xacro:wheel side="right" y="{right:.4g}" radius="{wheel_radius:.4g}" width="{width:.4g}" mass="{wheel_mass:.3g}"
               tyre="tyre" hub="steel"/>
  <xacro:castor name="castor" x="{castor:.4g}" y="0" radius="{ball:.4g}" top="${{clearance}}" mass="{ball_mass:.3g}"
                ball="steel" holder="dark"/>
  <xacro:lidar x="0" y="0" z="${{height + 0.04}}" bottom="${{height}}" radius="{lidar:.4g}" mass="{lidar_mass:.3g}"
               body="dark" window="glass"/>
</robot>
"""
YAML = """about: Round two-wheeled vehicle, {across:.2f} m across.
kind: ground

ground:
  urdf: {name}.urdf.xacro
  drive:
    left: wheel_left_joint
    right: wheel_right_joint
    wheel_radius: {wheel_radius:.4g}
    track: {track:.4g}
  radius: {outline:.4g}
  max_linear: 0.5
  max_angular: 1.5
  max_linear_acceleration: 0.5
  max_angular_acceleration: 3.0
  motor: {{stall_torque: {torque:.3g}, no_load_speed: {no_load:.3g}, lag: 0.03}}
  physics_hz: 200.0

sensors:
  lidar: {{preset: lds01, mount: {{link: lidar}}}}
  imu:
    mount: {{xyz: [0.0, 0.0, {clearance:.4g}]}}
    hz: 100.0
    gyro_noise: 0.002
    gyro_bias: 0.001
    accel_noise: 0.02
    accel_bias: 0.02
    mag_noise: 5.0e-7
  encoders: {{hz: 50.0, ticks_per_turn: 4096}}
"""


class Measures(NamedTuple):
    """Sizes [m]: base_link to the body's edge, track of the wheels, radius of a wheel, floor to the top of the body."""

    radius: float
    track: float
    wheel_radius: float
    height: float


def create(folder: Path, measures: Measures) -> Path:
    """Makes the folder of a new vehicle. Raises BadInput for one that exists, and for impossible sizes."""
    check_new(folder)
    _check(measures)
    values = _values(folder.name, measures)
    folder.mkdir(parents=True)
    (folder / f"{folder.name}.urdf.xacro").write_text(URDF.format(**values), encoding="utf-8")
    (folder / "vehicle.yaml").write_text(YAML.format(**values), encoding="utf-8")
    return folder


def check_new(folder: Path) -> None:
    """Raises BadInput for a name that no vehicle can have or that one already has."""
    if not folder.name.replace("_", "a").isalnum() or not folder.name.isascii() or folder.name == "sys":
        raise BadInput(f"'{folder.name}': a vehicle's name is made of letters, digits and _")
    if folder.exists():
        raise BadInput(f"{folder}: exists; choose another name or remove it")


def _check(m: Measures) -> None:
    """Raises BadInput."""
    if m.wheel_radius >= m.height:
        raise BadInput(f"--wheel-radius {m.wheel_radius:g} m is not below --height {m.height:g} m")
    if m.wheel_radius > 0.8 * m.radius:
        raise BadInput(f"--wheel-radius {m.wheel_radius:g} m does not fit a body of --radius {m.radius:g} m; at most {0.8 * m.radius:g}")
    if not 0.5 * m.radius <= m.track <= 3 * m.radius:
        raise BadInput(f"--track {m.track:g} m does not fit --radius {m.radius:g} m; from {0.5 * m.radius:g} to {3 * m.radius:g}")


def _values(name: str, m: Measures) -> dict[str, str | float]:
    clearance = min(0.6 * m.wheel_radius, 0.4 * m.height)
    deck = 0.98 * m.radius
    mass = max(DENSITY * 3.14 * deck**2 * (m.height - clearance), 0.2)
    wheel_mass = min(1200 * 3.14 * m.wheel_radius**2 * 0.3 * m.wheel_radius, HEAVIEST_WHEEL * mass)
    speed = 0.5 / m.wheel_radius
    lidar = min(0.035, 0.5 * m.radius)
    return {
        **m._asdict(),
        "name": name,
        "clearance": clearance,
        "deck_radius": deck,
        "outline": max(m.radius, (m.track / 2 + m.wheel_radius) * 1.001) + 1e-3,
        "across": 2 * m.radius,
        "mass": mass,
        "com": -0.25 * m.radius,
        "half_track": m.track / 2,
        "right": -m.track / 2,
        "width": 0.3 * m.wheel_radius,
        "wheel_mass": wheel_mass,
        "castor": -0.8 * m.radius,
        "ball": 0.45 * clearance,
        "ball_mass": 0.01 * mass,
        "lidar": lidar,
        "lidar_mass": min(0.125, 0.1 * mass),
        "torque": 1.5 * mass * 9.81 * 0.3 * m.wheel_radius,
        "no_load": 2.5 * speed,
    }
