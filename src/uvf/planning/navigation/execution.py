"""The local controller under the navigator's directives: follows, turns, backs up, stops, and says how it fares."""

from math import hypot

from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.planning.costmap.bumps import Bump
from uvf.planning.local.controller import Drive, LocalController
from uvf.planning.local.planner import STOP
from uvf.planning.navigation.directive import Action, Directive, Report
from uvf.planning.navigation.retreat import Retreat

SPIN_RATE = 1.2  # rad/s
BACK_UP_SPEED = 0.15  # m/s
MOST_BACKED = 5.0
"""Times the distance asked for that it backs up at most, to where it has room to turn."""
ROLLING = 0.02  # m/s, rad/s
BLOCKED_FOR = 1.0  # s of standing after which a recovery counts as impossible


class Executor:
    """Carries out one directive at a time."""

    def __init__(self, controller: LocalController) -> None:
        self.controller = controller
        self.report = Report(-1)
        self._begun: Pose2 = Pose2(0.0, 0.0, 0.0)
        self._turned, self._yaw = 0.0, 0.0
        self._stood_since: float | None = None
        self._retreat: Retreat | None = None

    @property
    def _turns_on_the_spot(self) -> bool:
        return self.controller.limits.turning_radius == 0.0

    def draw_back(self, t: float, pose: Pose2, bump: Bump) -> None:
        """Draws back from a touch at ``t`` [s], whatever it was doing, and goes on with that."""
        if self._retreat is None:
            self._retreat = Retreat(t, pose, bump, self._turns_on_the_spot)

    def step(self, t: float, pose: Pose2, velocity: Twist, directive: Directive) -> Twist:
        """Velocity at ``t`` [s]; the stop before obstacles has the last word in all that is done."""
        if directive.number != self.report.number:
            self._begin(pose, directive)
        if self._retreat is not None:
            return self._draw_back_on(t, pose, velocity, directive, self._retreat)
        if directive.action == Action.FOLLOW:
            result = self.controller.drive(pose, velocity, directive.path, directive.heading)
            self.report = Report(directive.number, result.how)
            return result.velocity
        if directive.action == Action.STOP:
            self.report = Report(directive.number, Drive.NO_PATH, done=True)
            return self.controller.hold(pose, velocity)
        return self._move(t, pose, velocity, directive)

    def _draw_back_on(self, t: float, pose: Pose2, velocity: Twist, directive: Directive, retreat: Retreat) -> Twist:
        self.report = Report(directive.number)
        if not retreat.is_over(t, pose):
            rolls_on = any(w * v < 0.0 and abs(v) > ROLLING for w, v in zip(retreat.wanted(), velocity, strict=True))
            return self.controller.halt() if rolls_on else self.controller.move(pose, velocity, retreat.wanted())
        self._retreat = None
        self.controller.hidden.bump(self.controller.age, retreat.bump)
        return self.controller.halt()

    def _begin(self, pose: Pose2, directive: Directive) -> None:
        self.report = Report(directive.number)
        self._begun, self._turned, self._yaw, self._stood_since = pose, 0.0, pose[2], None
        self.controller.planner.reset()
        if directive.clear_beyond is not None:
            self.controller.layer.clear(directive.clear_beyond, (pose[0], pose[1]))
            self.controller.hidden.clear(directive.clear_beyond, (pose[0], pose[1]))

    def _move(self, t: float, pose: Pose2, velocity: Twist, directive: Directive) -> Twist:
        self._turned += wrap(pose[2] - self._yaw)
        self._yaw = pose[2]
        if directive.action == Action.SPIN:
            done = abs(self._turned) >= abs(directive.amount)
            wanted = Twist(0.0, SPIN_RATE if directive.amount > 0 else -SPIN_RATE)
        else:
            backed = hypot(pose[0] - self._begun[0], pose[1] - self._begun[1])
            has_room = not self._turns_on_the_spot or self.controller.has_room_to_turn(pose)
            done = backed >= directive.amount and (has_room or backed >= MOST_BACKED * directive.amount)
            wanted = Twist(-BACK_UP_SPEED, 0.0)
        if done:
            self.report = Report(directive.number, done=True)
            return self.controller.halt()
        blind = directive.action == Action.BACK_UP and not self.controller.knows_behind(pose)
        found = self.controller.halt() if blind else self.controller.move(pose, velocity, wanted)
        if found != STOP:
            self._stood_since = None
        elif self._stood_since is None:
            self._stood_since = t
        impossible = self._stood_since is not None and t - self._stood_since >= BLOCKED_FOR
        self.report = Report(directive.number, Drive.STOPPED if found == STOP else Drive.DRIVING, impossible=impossible)
        return found
