"""Prototype stack."""

import numpy as np
from math import atan2, hypot
from uvf.maths.se2 import Pose2, transform, inverse, compose
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation, cost_factors, INSCRIBED
from uvf.planning.costmap.obstacle_layer import ObstacleLayer, Observation
from uvf.planning.costmap.own_ground import with_way_out, LEAVING
from uvf.planning.local.window import local_window, WindowSettings, UNREACHED
from uvf.planning.local.rollout import Limits, State
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.local.dwa import Dwa, DwaSettings
from uvf.planning.local.swept_stop import safe_share
from uvf.planning.local import rollout
from uvf.planning.search.grid_search import GridSearch
from uvf.planning.moving.tracks import MovingObjects
from uvf.planning.smoothing import resample


class Stack:
    def __init__(self, briefing, local="mppi", **kw):
        r = briefing.robot
        self.robot = r
        self.fp = RobotFootprint.polygon(r.footprint)
        self.soft = self.fp.padded(kw.get("pad", 0.02))
        self.layer = ObstacleLayer(kw.get("size", 24.0), 0.05, kw.get("life", 5.0))
        self.infl = Inflation(kw.get("infl", 0.55), kw.get("k", 4.0))
        self.factors = cost_factors(kw.get("mult", 4.0), 1.0)
        self.factors[LEAVING] = 30.0
        vmax = kw.get("vmax", 2.0)
        self.limits = Limits(kw.get("vmin", -0.5), vmax, kw.get("wmax", 2.0), kw.get("acc", 2.5), kw.get("wacc", 6.0), kw.get("alat", 2.0))
        if local == "mppi":
            self.local = Mppi(self.limits, self.soft, MppiSettings(**kw.get("mppi", {})), briefing.seed)
        else:
            self.local = Dwa(self.limits, self.soft, DwaSettings(**kw.get("dwa", {})))
        s = r.scanner
        a = s.angle_min + s.angle_increment * np.arange(s.beams)
        self.rays = np.stack((np.cos(a), np.sin(a)), axis=1)
        self.moving = MovingObjects()
        self.path = None
        self.planned = -9.0
        self.every = kw.get("every", 0.2)
        self.brake = (0.1, kw.get("brake", 4.0), kw.get("wbrake", 10.0))
        self.stopped = 0
        self.last = (0.0, 0.0)
        self.delay = kw.get("delay", 0.05)

    def reset(self, goal):
        self.goal = np.array(goal[:2])

    def command(self, t, ranges, pose, velocity):
        s = self.robot.scanner
        hit = ranges > 0
        rr = np.where(hit, np.minimum(ranges, 10.0), 10.0)
        body = self.rays * rr[:, None] + np.array((s.forward, 0.0))
        self.layer.recentre(pose[:2])
        ends = transform(pose, body)
        eye = transform(pose, np.array([[s.forward, 0.0]]))[0]
        moves = self.moving.observe(t, (float(eye[0]), float(eye[1])), ends, np.where(hit, ranges, 0.0))
        self.layer.observe(Observation(t, (float(eye[0]), float(eye[1])), ends, hit & (ranges < 10.0) & ~moves))
        obstacles = self.moving.moving()
        self.layer.forget(t)
        costs = self.layer.costmap(self.soft, self.infl, 7.0)
        if t - self.planned >= self.every - 1e-9 or self.path is None:
            self.planned = t
            self.plan(self.layer.costmap(self.soft, self.infl), pose)
        self.costs = costs
        if self.path is None:
            return 0.0, 0.0
        grids = local_window(costs, pose[:2], self.path, self.factors, WindowSettings())
        self.grids = grids
        # state at the time the command counts
        d = self.delay
        mv, mw = velocity
        v = min(max(self.last[0], mv - self.limits.acceleration * 0.15), mv + self.limits.acceleration * 0.15)
        w = min(max(self.last[1], mw - self.limits.angular_acceleration * 0.15), mw + self.limits.angular_acceleration * 0.15)
        m = pose[2] + w * d / 2
        st = State(pose[0] + v * d * np.cos(m), pose[1] + v * d * np.sin(m), pose[2] + w * d, v, w)
        v, w = self.local.command(st, grids, obstacles)
        near = body[hit & (ranges < 4.0)]
        # the speed it has counts as well as the one it is to have
        share = safe_share(near, (v if abs(v) > abs(mv) else mv, w if abs(w) > abs(mw) else mw), self.fp, 0.01, self.brake)
        share = min(share, safe_share(near, (v, w), self.fp, 0.01, self.brake))
        if share < 1.0:
            self.stopped += 1
        self.last = (v * share, w * share)
        return self.last

    def plan(self, costs, pose):
        here = costs.cell(*pose[:2])
        n = costs.values.shape[0]
        g = costs.cell(*self.goal)
        if not costs.holds(g):
            d = self.goal - np.array(pose[:2])
            d *= (n * 0.05 / 2 - 0.3) / np.abs(d).max()
            g = costs.cell(*(np.array(pose[:2]) + d))
        opened = with_way_out(costs, here, 0.3)
        found = GridSearch(opened.values, self.factors).astar(here, g)
        if found is None:
            return
        p = costs.points(found.cells)
        p[0] = pose[:2]
        self.path = resample(p, 0.1)
