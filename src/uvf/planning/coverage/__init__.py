"""Coverage planning: swaths over a field with holes, in order, for an aircraft with a camera or a ground vehicle with a tool."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.planning.coverage.camera import SurveyCamera as SurveyCamera
    from uvf.planning.coverage.field import CoverageField as CoverageField
    from uvf.planning.coverage.field import make_field as make_field
    from uvf.planning.coverage.ground_speed import GroundSpeed as GroundSpeed
    from uvf.planning.coverage.plan import CoveragePlan as CoveragePlan
    from uvf.planning.coverage.planner import plan_coverage as plan_coverage
    from uvf.planning.coverage.task import CoverageTask as CoverageTask
    from uvf.planning.coverage.task import End as End
    from uvf.planning.coverage.vehicles import GroundVehicle as GroundVehicle
    from uvf.planning.coverage.vehicles import SurveyAircraft as SurveyAircraft

OFFERED = {
    "plan_coverage": "uvf.planning.coverage.planner:plan_coverage",
    "CoverageTask": "uvf.planning.coverage.task:CoverageTask",
    "CoveragePlan": "uvf.planning.coverage.plan:CoveragePlan",
    "CoverageField": "uvf.planning.coverage.field:CoverageField",
    "make_field": "uvf.planning.coverage.field:make_field",
    "SurveyAircraft": "uvf.planning.coverage.vehicles:SurveyAircraft",
    "GroundVehicle": "uvf.planning.coverage.vehicles:GroundVehicle",
    "GroundSpeed": "uvf.planning.coverage.ground_speed:GroundSpeed",
    "SurveyCamera": "uvf.planning.coverage.camera:SurveyCamera",
    "End": "uvf.planning.coverage.task:End",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
