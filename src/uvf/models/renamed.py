"""Names that were others once: who still writes the old one is told the new one."""

RENAMED = {
    "comfort": "inflation_radius",
    "left_joint": "drive: left",
    "right_joint": "drive: right",
    "wheel_radius": "drive: wheel_radius",
    "track": "drive: track",
    "dislike": "cost_scaling_factor",
    "least_frontier": "min_frontier_size",
    "frontier_worth": "frontier_gain",
    "nav/fix": "nav/map_pose",
    "srv/order": "srv/vehicle_command",
    "state/guest": "state/external_vehicle",
}
"""Old -> new, of parameters, keys of files (with the section that they are in now) and topics (without their owner)."""


def new_name(name: str) -> str:
    """New name of a parameter, key or topic (also of a topic with its owner); empty where it was never renamed."""
    owner, _, rest = name.partition("/")
    return RENAMED.get(name) or (f"{owner}/{RENAMED[rest]}" if rest in RENAMED else "")
