"""A burger with a mast: a lift, on it a head that pans and carries a camera, and beside it a tray on a spring."""

import shutil

import yaml

from uvf.models.scenario import ROOT, load_scenario

MASS = '<inertial><mass value="{m}"/><inertia ixx="{i}" ixy="0" ixz="0" iyy="{i}" iyz="0" izz="{i}"/></inertial>'
BOX = '<{kind}><geometry><box size="0.03 0.03 0.03"/></geometry><material name="signal"><color rgba="0.9 0.1 0.1 1"/></material></{kind}>'
PART = '<link name="{name}">' + MASS + BOX.format(kind="visual") + "</link>"
JOINT = (
    '<joint name="{name}_joint" type="{kind}"><parent link="{parent}"/><child link="{name}"/>'
    '<origin xyz="{at}"/><axis xyz="0 0 1"/>{limit}</joint>'
)
LIFT, PAN = "lift_joint", "head_joint"
RANGE = '<limit lower="0" upper="0.3" velocity="0.1" effort="30"/>'
TRAY = '<limit lower="-0.05" upper="0.05" velocity="1" effort="1"/>'


def mast_urdf(lift=RANGE, pan='<limit velocity="1.0" effort="2"/>', tray_mass=0.2):
    """The text of its URDF."""
    parts = "".join(
        PART.format(name=name, m=m, i=i) for name, m, i in (("lift", 0.3, 1e-4), ("head", 0.1, 1e-4), ("tray", tray_mass, 1e-4))
    )
    joints = (
        JOINT.format(name="lift", kind="prismatic", parent="base_link", at="-0.03 0 0.2", limit=lift)
        + JOINT.format(name="head", kind="continuous", parent="lift", at="0 0 0.05", limit=pan)
        + JOINT.format(name="tray", kind="prismatic", parent="base_link", at="0 0 0.15", limit=TRAY)
    )
    text = (ROOT / "vehicles" / "burger" / "burger.urdf").read_text()
    return text.replace("</robot>", f"{parts}{joints}</robot>")


def arm_urdf(links=4):
    """The text of the URDF of a burger with an arm on joints about z, y, y ..., joint_1 and so on, 0.1 m from one to the next."""
    parts = ""
    for n in range(1, links + 1):
        parts += f'<link name="arm_{n}">{MASS.format(m=0.05, i=2e-5)}</link><joint name="joint_{n}" type="revolute">'
        parts += f'<parent link="{"base_link" if n == 1 else f"arm_{n - 1}"}"/><child link="arm_{n}"/>'
        parts += f'<origin xyz="{"-0.05 0 0.2" if n == 1 else "0.1 0 0"}"/><axis xyz="{"0 0 1" if n == 1 else "0 1 0"}"/>'
        parts += '<limit lower="-2" upper="2" effort="1" velocity="4.8"/></joint>'
    return (ROOT / "vehicles" / "burger" / "burger.urdf").read_text().replace("</robot>", f"{parts}</robot>")


MAST = {
    "variant_of": "burger",
    "about": "test",
    "ground": {"urdf": "mast.urdf", "joints": [LIFT, PAN], "springs": {"tray_joint": {"stiffness": 100.0, "damping": 4.0}}},
    "sensors": {"camera": {"mount": {"xyz": [0.02, 0.0, 0.0], "link": "head"}}},
}


def mast_folder(folder, urdf="", **changed):
    """A folder of vehicles and worlds with the vehicle ``mast``; changed: keys of its file."""
    vehicles = folder / "vehicles"
    if not vehicles.exists():
        folder.mkdir(exist_ok=True)
        (folder / "worlds").symlink_to(ROOT / "worlds")
        shutil.copytree(ROOT / "vehicles" / "burger", vehicles / "burger")
    made = vehicles / "mast"
    made.mkdir(exist_ok=True)
    (made / "mast.urdf").write_text(urdf or mast_urdf())
    (made / "vehicle.yaml").write_text(yaml.safe_dump({**MAST, **changed}))
    return made


def mast_site(folder, start=(6.0, 4.4, 0.0), **entry):
    """A mission in the house with one of them, whose name is ``mast``."""
    mast_folder(folder)
    x, y, yaw = start
    vehicle = {"model": "mast", "system_id": 1, "start": {"x": x, "y": y, "yaw": yaw}, **entry}
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump({"about": "test", "world": "house", "seed": 1, "vehicles": {"mast": vehicle}}))
    return load_scenario(path, folder)
