"""Colours of SDF visuals: written out, or one of the scripts that come with Gazebo."""

from typing import Any

import numpy as np

from uvf.models.importing.sdf.poses import numbers
from uvf.models.world.file import Colour
from uvf.models.yaml_data import BadInput

SCRIPTS: dict[str, Colour] = {
    "black": (0.05, 0.05, 0.05),
    "blue": (0.1, 0.2, 0.8),
    "bricks": (0.62, 0.35, 0.27),
    "carpet": (0.5, 0.4, 0.35),
    "ceilingtiled": (0.85, 0.85, 0.82),
    "cloudysky": (0.6, 0.7, 0.85),
    "darkgray": (0.25, 0.25, 0.25),
    "darkgrey": (0.25, 0.25, 0.25),
    "darkyellow": (0.6, 0.6, 0.1),
    "flatblack": (0.1, 0.1, 0.1),
    "gold": (0.8, 0.65, 0.25),
    "grass": (0.3, 0.5, 0.2),
    "gray": (0.6, 0.6, 0.6),
    "green": (0.1, 0.7, 0.15),
    "grey": (0.6, 0.6, 0.6),
    "indigo": (0.33, 0.0, 0.5),
    "marble": (0.88, 0.86, 0.84),
    "motorway": (0.35, 0.35, 0.37),
    "orange": (0.95, 0.5, 0.1),
    "pioneerbody": (0.75, 0.1, 0.1),
    "purple": (0.6, 0.1, 0.7),
    "red": (0.8, 0.1, 0.1),
    "residential": (0.45, 0.45, 0.45),
    "road": (0.35, 0.35, 0.37),
    "skyblue": (0.5, 0.7, 0.9),
    "turquoise": (0.2, 0.75, 0.75),
    "white": (0.95, 0.95, 0.95),
    "wood": (0.6, 0.42, 0.25),
    "woodfloor": (0.62, 0.47, 0.32),
    "woodpallet": (0.7, 0.55, 0.35),
    "yellow": (0.9, 0.85, 0.1),
    "zincyellow": (0.95, 0.9, 0.2),
}


def visual_colour(visual: Any) -> Colour | None:
    """Colour of a <visual>: by the name of its script or picture, else diffuse, else ambient; None when it tells none. Raises BadInput."""
    material = visual.find("material")
    if material is None:
        return None
    painted = _known((material.findtext("pbr/metal/albedo_map") or material.findtext("script/name") or "").rpartition("/")[2])
    for tag in () if painted else ("diffuse", "ambient"):
        element = material.find(tag)
        if element is not None and (element.text or "").strip():
            values = numbers(element)
            if len(values) < 3:
                raise BadInput(f"a <{tag}> needs red, green and blue")
            r, g, b = (float(v) for v in np.clip(values[:3], 0.0, 1.0))
            return r, g, b
    return painted


def _known(name: str) -> Colour | None:
    """The colour of a script, or of a picture that is called like one."""
    plain = name.partition(".")[0].lower().replace("_", "")
    return SCRIPTS.get(plain) or next((SCRIPTS[known] for known in sorted(SCRIPTS, key=len, reverse=True) if known in plain), None)
