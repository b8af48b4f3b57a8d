"""Robots as others write them, each with habits of its own; written into a folder for a test."""

import numpy as np
import trimesh

from launch.vehicles.importing import import_vehicle
from uvf.models.urdf.source import XacroValues

BOX_INERTIA = '<inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.04"/>'
WHEEL_INERTIA = '<inertia ixx="0.0004" ixy="0" ixz="0" iyy="0.0004" iyz="0" izz="0.0007"/>'


def solidworks(folder):
    """sw2urdf: a package, meshes for looks and collisions, y forward, wheels flipped, no gazebo tags."""
    meshes = folder / "rover_description" / "meshes"
    meshes.mkdir(parents=True)
    base = trimesh.creation.box((0.24, 0.36, 0.08))
    base.export(meshes / "base_link.STL")
    wheel = trimesh.creation.cylinder(0.06, 0.03, sections=60)
    for name in ("whl_l", "whl_r"):
        wheel.export(meshes / f"{name}.STL")
    trimesh.creation.icosphere(radius=0.02).export(meshes / "caster.STL")

    def link(name, mass, inertia, colour="0.79 0.82 0.93 1"):
        shape = f'<geometry><mesh filename="package://rover_description/meshes/{name}.STL"/></geometry>'
        material = f'<material name=""><color rgba="{colour}"/></material>'
        return (
            f'<link name="{name}"><inertial><origin xyz="0.001 -0.02 0" rpy="0 0 0"/><mass value="{mass}"/>{inertia}</inertial>'
            f'<visual><origin xyz="0 0 0" rpy="0 0 0"/>{shape}{material}</visual><collision>{shape}</collision></link>'
        )

    def joint(name, kind, child, xyz, rpy, axis):
        return (
            f'<joint name="{name}" type="{kind}"><origin xyz="{xyz}" rpy="{rpy}"/><parent link="base_link"/><child link="{child}"/>'
            f'<axis xyz="{axis}"/></joint>'
        )

    path = folder / "rover_description" / "urdf" / "rover.urdf"
    path.parent.mkdir()
    path.write_text(
        '<?xml version="1.0" encoding="utf-8"?>\n<!-- exported by the SolidWorks to URDF exporter -->\n<robot name="rover">'
        + link("base_link", 3.2, BOX_INERTIA)
        + link("whl_l", 0.2, WHEEL_INERTIA)
        + link("whl_r", 0.2, WHEEL_INERTIA)
        + link("caster", 0.05, '<inertia ixx="1E-05" ixy="0" ixz="0" iyy="1E-05" iyz="0" izz="1E-05"/>')
        + joint("whl_l", "continuous", "whl_l", "-0.15 0.08 0", "0 1.5707963 0", "0 0 -1")
        + joint("whl_r", "continuous", "whl_r", "0.15 0.08 0", "0 -1.5707963 0", "0 0 -1")
        + joint("caster", "fixed", "caster", "0 -0.15 -0.04", "0 0 0", "0 0 0")
        + "</robot>"
    )
    return path


def gazebo_urdf(folder):
    """xacro with a prefix, base_footprint, millimetre meshes, Gazebo's sensors and drive, a transmission, an include that is not there."""
    (folder / "meshes").mkdir(parents=True)
    shell = trimesh.creation.cylinder(170.0, 60.0)
    shell.export(folder / "meshes" / "shell.stl")
    path = folder / "bot.urdf.xacro"
    path.write_text(f"""<?xml version="1.0"?>
<robot name="bot" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default="bot_"/>
  <xacro:include filename="$(find somewhere_else)/urdf/extras.xacro"/>
  <xacro:property name="p" value="$(arg prefix)"/>
  <xacro:macro name="wheel" params="side y">
    <joint name="${{p}}${{side}}_wheel_joint" type="revolute">
      <parent link="${{p}}base_link"/><child link="${{p}}${{side}}_wheel"/>
      <origin xyz="0.02 ${{y}} -0.01" rpy="${{-pi/2}} 0 0"/><axis xyz="0 0 1"/>
      <limit lower="-1e16" upper="1e16" effort="5" velocity="20"/>
    </joint>
    <link name="${{p}}${{side}}_wheel">
      <inertial><mass value="0.15"/>{WHEEL_INERTIA}</inertial>
      <visual><geometry><cylinder radius="0.04" length="0.02"/></geometry></visual>
      <collision><geometry><cylinder radius="0.04" length="0.02"/></geometry></collision>
    </link>
    <transmission name="${{side}}_transmission"><type>simple</type></transmission>
  </xacro:macro>
  <link name="${{p}}base_footprint"/>
  <joint name="${{p}}base_joint" type="fixed">
    <parent link="${{p}}base_footprint"/><child link="${{p}}base_link"/><origin xyz="0 0 0.05"/>
  </joint>
  <link name="${{p}}base_link">
    <inertial><origin xyz="-0.02 0 0.02"/><mass value="2.4"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>
    <visual><origin xyz="0 0 0.02"/><geometry><mesh filename="package://bot/meshes/shell.stl"/></geometry></visual>
    <collision><origin xyz="0 0 0.02"/><geometry><cylinder radius="0.17" length="0.06"/></geometry></collision>
  </link>
  <xacro:wheel side="left" y="0.13"/>
  <xacro:wheel side="right" y="-0.13"/>
  <joint name="${{p}}castor_swivel" type="continuous">
    <parent link="${{p}}base_link"/><child link="${{p}}castor_fork"/><origin xyz="-0.12 0 -0.01"/><axis xyz="0 0 1"/>
  </joint>
  <link name="${{p}}castor_fork"><inertial><mass value="0.02"/>{WHEEL_INERTIA}</inertial></link>
  <joint name="${{p}}castor_roll" type="continuous">
    <parent link="${{p}}castor_fork"/><child link="${{p}}castor_wheel"/>
    <origin xyz="-0.01 0 -0.02" rpy="${{-pi/2}} 0 0"/><axis xyz="0 0 1"/>
  </joint>
  <link name="${{p}}castor_wheel">
    <inertial><mass value="0.02"/>{WHEEL_INERTIA}</inertial>
    <collision><geometry><cylinder radius="0.02" length="0.01"/></geometry></collision>
  </link>
  <joint name="${{p}}laser_joint" type="fixed">
    <parent link="${{p}}base_link"/><child link="${{p}}laser"/><origin xyz="0.05 0 0.1" rpy="0 0 ${{pi}}"/>
  </joint>
  <link name="${{p}}laser"/>
  <gazebo reference="${{p}}laser">
    <sensor type="ray" name="laser">
      <update_rate>40</update_rate>
      <ray>
        <scan><horizontal><samples>720</samples><min_angle>-1.570796</min_angle><max_angle>1.570796</max_angle></horizontal></scan>
        <range><min>0.10</min><max>30.0</max></range>
        <noise><type>gaussian</type><stddev>0.02</stddev></noise>
      </ray>
      <plugin name="laser_plugin" filename="libgazebo_ros_laser.so"/>
    </sensor>
  </gazebo>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so">
      <leftJoint>${{p}}left_wheel_joint</leftJoint><rightJoint>${{p}}right_wheel_joint</rightJoint>
      <wheelSeparation>0.26</wheelSeparation><wheelDiameter>0.1</wheelDiameter>
    </plugin>
  </gazebo>
</robot>""")
    return path


def _sdf_inertial(mass, moments):
    xx, yy, zz = moments
    return f"<inertial><mass>{mass}</mass><inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{zz}</izz></inertia></inertial>"


def _sdf_wheel(name, pose, radius=0.3, length=0.2, rolled=True):
    shape = f"<geometry><cylinder><radius>{radius}</radius><length>{length}</length></cylinder></geometry>"
    turned = '<pose relative_to="__model__">' if rolled else "<pose>"
    return (
        f'<link name="{name}">{turned}{pose}</pose>{_sdf_inertial(2, (0.05, 0.05, 0.09))}'
        f'<visual name="v">{shape}</visual><collision name="c">{shape}</collision></link>'
    )


def _sdf_joint(name, child, xyz):
    return f'<joint name="{name}" type="revolute"><parent>chassis</parent><child>{child}</child><axis>{xyz}</axis></joint>'


def gazebo_sdf(folder):
    """The differential-drive vehicle of Gazebo's tutorials: large, a castor on a ball joint, axes in the model's frame."""
    folder.mkdir(parents=True, exist_ok=True)
    axis = '<xyz expressed_in="__model__">0 1 0</xyz>'
    box = "<geometry><box><size>2.0 1.0 0.5</size></box></geometry>"
    ball = "<geometry><sphere><radius>0.2</radius></sphere></geometry>"
    path = folder / "vehicle.sdf"
    path.write_text(f"""<?xml version="1.0"?>
<sdf version="1.7"><model name="vehicle_blue"><pose>0 2 0.325 0 0 0.4</pose>
  <link name="chassis"><pose>-0.151427 0 0.175 0 0 0</pose>{_sdf_inertial(40, (4.0, 14.0, 16.0))}
    <visual name="v">{box}<material><diffuse>0.5 0.5 1.0 1</diffuse></material></visual><collision name="c">{box}</collision>
    <sensor name="imu" type="imu"><update_rate>1000</update_rate></sensor>
    <sensor name="radar" type="radar"/>
    <sensor name="scan" type="gpu_lidar"><pose>0.9 0 0.4 0 0 0</pose><update_rate>10</update_rate>
      <lidar><scan><horizontal><samples>640</samples><min_angle>-1.396263</min_angle><max_angle>1.396263</max_angle></horizontal></scan>
      <range><min>0.08</min><max>10.0</max></range></lidar></sensor>
  </link>
  {_sdf_wheel("left_wheel", "0.554283 0.625029 -0.025 -1.5707 0 0")}
  {_sdf_wheel("right_wheel", "0.554282 -0.625029 -0.025 -1.5707 0 0")}
  <link name="caster"><pose>-0.957138 0 -0.125 0 0 0</pose>{_sdf_inertial(1, (0.016, 0.016, 0.016))}
    <visual name="v">{ball}</visual><collision name="c">{ball}</collision></link>
  {_sdf_joint("left_wheel_joint", "left_wheel", axis)}
  {_sdf_joint("right_wheel_joint", "right_wheel", axis)}
  <joint name="caster_wheel" type="ball"><parent>chassis</parent><child>caster</child></joint>
  <plugin filename="ignition-gazebo-diff-drive-system" name="ignition::gazebo::systems::DiffDrive">
    <left_joint>left_wheel_joint</left_joint><right_joint>right_wheel_joint</right_joint>
    <wheel_separation>1.25</wheel_separation><wheel_radius>0.3</wheel_radius></plugin>
  <plugin filename="libsomething.so" name="something"/>
</model></sdf>""")
    return path


def skid_steer(folder):
    """Four driven wheels in an old SDF, whose axes are in the model's frame."""
    folder.mkdir(parents=True, exist_ok=True)
    box = "<geometry><box><size>0.5 0.3 0.12</size></box></geometry>"
    places = {"front_left": (0.16, 0.2), "front_right": (0.16, -0.2), "rear_left": (-0.16, 0.2), "rear_right": (-0.16, -0.2)}
    wheels = "".join(_sdf_wheel(n, f"{x} {y} 0.08 1.570796 0 0", 0.08, 0.05, rolled=False) for n, (x, y) in places.items())
    joints = "".join(_sdf_joint(f"{n}_joint", n, "<xyz>0 1 0</xyz>") for n in places)
    path = folder / "model.sdf"
    path.write_text(f"""<sdf version="1.4"><model name="skid"><link name="chassis"><pose>0 0 0.13 0 0 0</pose>
  {_sdf_inertial(10, (0.1, 0.25, 0.3))}<visual name="v">{box}</visual><collision name="c">{box}</collision></link>{wheels}{joints}
  <plugin filename="libgazebo_ros_skid_steer_drive.so" name="skid_steer"/></model></sdf>""")
    return path


def kobuki(folder):
    """base_footprint before the axle, wheels as mirrored halves in millimetres on hubs, castors before and behind, a cliff sonar first."""
    folder.mkdir(parents=True, exist_ok=True)
    half = trimesh.creation.cylinder(35.0, 10.0, sections=60)
    half.apply_translation((0, 0, 5.0))
    half.export(folder / "half.stl")

    def joint(name, kind, parent, child, xyz, rpy="0 0 0"):
        ends = f'<parent link="{parent}"/><child link="{child}"/>'
        return f'<joint name="{name}" type="{kind}">{ends}<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 1 0"/></joint>'

    def mass(kilograms, inertia):
        return f'<inertial><mass value="{kilograms}"/>{inertia}</inertial>'

    def wheel(side, y):
        halves = "".join(
            f'<collision><geometry><mesh filename="half.stl" scale="0.001 0.001 {z}"/></geometry></collision>' for z in (0.001, -0.001)
        )
        return (
            f'<link name="{side}_hub"/><link name="{side}_tyre">{mass(0.1, WHEEL_INERTIA)}{halves}</link>'
            + joint(f"wheel_{side}", "continuous", "base_link", f"{side}_hub", f"0 {y} 0.025")
            + joint(f"{side}_fixed", "fixed", f"{side}_hub", f"{side}_tyre", "0 0 0", "-1.5707963 0 0")
        )

    def castor(side, x):
        ball = '<collision><geometry><sphere radius="0.012"/></geometry></collision>'
        return f'<link name="caster_{side}">{mass(0.02, WHEEL_INERTIA)}{ball}</link>' + joint(
            f"caster_{side}_joint", "fixed", "base_link", f"caster_{side}", f"{x} 0 0.002"
        )

    def ray(link, plugin, samples):
        scan = f"<scan><horizontal><samples>{samples}</samples><min_angle>-0.3</min_angle><max_angle>0.3</max_angle></horizontal></scan>"
        ranges = "<range><min>0.03</min><max>2.5</max></range>"
        return (
            f'<link name="{link}"/>'
            + joint(f"{link}_joint", "fixed", "base_link", link, "0.1 0 0.15", "0 0 0.2")
            + f'<gazebo reference="{link}"><sensor type="ray" name="{link}"><update_rate>20</update_rate><ray>{scan}{ranges}</ray>'
            f'<plugin name="{link}" filename="{plugin}"/></sensor></gazebo>'
        )

    path = folder / "kobuki.urdf"
    body = '<collision><origin xyz="0 0 0.06"/><geometry><cylinder radius="0.17" length="0.08"/></geometry></collision>'
    path.write_text(
        '<robot name="kobuki"><link name="base_footprint"/>'
        + joint("base", "fixed", "base_footprint", "base_link", "0.02 0 0.01")
        + f'<link name="base_link">{mass(2.4, BOX_INERTIA)}{body}</link>'
        + wheel("left", 0.115) + wheel("right", -0.115) + castor("front", 0.115) + castor("back", -0.115)
        + ray("front_sonar", "libgazebo_ros_range.so", 5) + ray("laser", "libgazebo_ros_laser.so", 90)
        + "</robot>"
    )  # fmt: skip
    return path


def bare(folder):
    """No inertia, no collisions, names in Italian, wheels as meshes made off their axis, root above the axle and behind it."""
    folder.mkdir(parents=True, exist_ok=True)
    wheel = trimesh.creation.cylinder(0.05, 0.02, sections=48)
    wheel.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    wheel.apply_translation((0, 0.03, 0))
    wheel.export(folder / "ruota.obj")
    path = folder / "carro.urdf"

    def joint(name, kind, child, xyz, rpy="0 0 0"):
        ends = f'<parent link="telaio"/><child link="{child}"/>'
        return f'<joint name="{name}" type="{kind}">{ends}<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 1 0"/></joint>'

    mesh = '<visual><geometry><mesh filename="ruota.obj"/></geometry></visual>'
    path.write_text(
        '<robot name="carro"><link name="telaio"><visual><origin xyz="0.05 0 0"/>'
        '<geometry><box size="0.3 0.2 0.06"/></geometry></visual></link>'
        f'<link name="ruota_sinistra">{mesh}</link><link name="ruota_destra">{mesh}</link>'
        '<link name="ball_caster"><visual><geometry><sphere radius="0.03"/></geometry></visual></link>'
        + joint("giunto_sinistra", "continuous", "ruota_sinistra", "0.1 0.1 -0.05")
        + joint("giunto_destra", "continuous", "ruota_destra", "0.1 -0.1 -0.05", "0 0 3.14159265")
        + joint("caster_joint", "fixed", "ball_caster", "-0.07 0 -0.07")
        + "</robot>"
    )
    return path


def car(folder):
    """Steering knuckles that weigh nothing and have their limits, the right one upside down; the root in the middle of the car."""
    folder.mkdir(parents=True, exist_ok=True)

    def link(name, mass, shape=""):
        inertia = f'<inertial><mass value="{mass}"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>'
        return f'<link name="{name}">{inertia if mass else ""}{shape}</link>'

    def joint(name, kind, ends, xyz, axis):
        limit = '<limit lower="-0.55" upper="0.6" effort="5" velocity="4"/>' if kind == "revolute" else ""
        return (
            f'<joint name="{name}" type="{kind}"><parent link="{ends[0]}"/><child link="{ends[1]}"/>'
            f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>{limit}</joint>'
        )

    tyre = '<collision><origin rpy="1.5707963 0 0"/><geometry><cylinder radius="0.08" length="0.05"/></geometry></collision>'
    body = '<collision><geometry><box size="0.7 0.3 0.1"/></geometry></collision>'
    parts = [link("chassis", 8, body)]
    for side, y, up in (("left", 0.2, 1), ("right", -0.2, -1)):
        parts += [link(f"{side}_knuckle", 0), link(f"front_{side}", 0.5, tyre), link(f"rear_{side}", 0.5, tyre)]
        parts.append(joint(f"{side}_steering_hinge", "revolute", ("chassis", f"{side}_knuckle"), f"0.25 {y} -0.02", f"0 0 {up}"))
        parts.append(joint(f"front_{side}_wheel_joint", "continuous", (f"{side}_knuckle", f"front_{side}"), "0 0 0", "0 1 0"))
        parts.append(joint(f"rear_{side}_wheel_joint", "continuous", ("chassis", f"rear_{side}"), f"-0.25 {y} -0.02", "0 1 0"))
    path = folder / "car.urdf"
    path.write_text(f'<robot name="car">{"".join(parts)}</robot>')
    return path


ROBOTS = {f.__name__: f for f in (solidworks, gazebo_urdf, gazebo_sdf, skid_steer, kobuki, bare)}


def import_one(tmp_path, name, edit=None, arguments=None):
    """The notes of importing one of them as ``vehicles/it``, with a part of its file replaced."""
    source = ROBOTS[name](tmp_path / "source")
    if edit is not None:
        assert edit[0] in source.read_text()
        source.write_text(source.read_text().replace(*edit))
    return import_vehicle(source, tmp_path / "vehicles" / "it", XacroValues(arguments or {}))
