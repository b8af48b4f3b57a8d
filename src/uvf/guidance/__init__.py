"""Guidance of fixed-wing aircraft after Beard & McLain (2012): paths, vector fields, corners, Dubins routes, landings, formation slots."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.guidance.clothoid_dubins import smooth_dubins_path as smooth_dubins_path
    from uvf.guidance.vector_field import LateralGuidance as LateralGuidance
    from uvf.guidance.vector_field import line_reference as line_reference
    from uvf.guidance.vector_field import orbit_reference as orbit_reference
    from uvf.guidance.vector_field import turn_radius as turn_radius
    from uvf.maths.curves.dubins import DubinsPath as DubinsPath
    from uvf.maths.curves.dubins import dubins_path as dubins_path

OFFERED = {
    "dubins_path": "uvf.maths.curves.dubins:dubins_path",
    "DubinsPath": "uvf.maths.curves.dubins:DubinsPath",
    "smooth_dubins_path": "uvf.guidance.clothoid_dubins:smooth_dubins_path",
    "line_reference": "uvf.guidance.vector_field:line_reference",
    "orbit_reference": "uvf.guidance.vector_field:orbit_reference",
    "LateralGuidance": "uvf.guidance.vector_field:LateralGuidance",
    "turn_radius": "uvf.guidance.vector_field:turn_radius",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
