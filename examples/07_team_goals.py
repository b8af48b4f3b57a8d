"""Places are shared among all ground vehicles that run, so that the last one is visited early. Start ``./uvf up team`` first.

    .venv/bin/python examples/07_team_goals.py 2.5,1.5 8.0,4.0 6.0,1.2

Each vehicle's planner says how long it would take from where it stands to each place, and from each place to each other one.
"""

import math
import sys

import numpy as np

import uvf
from schemas import topics
from schemas.messages import Kind, PreviewRequest, RouteRequest, Vector3
from uvf.planning.assignment import assign

places = [Vector3(x=float(x), y=float(y)) for x, y in (text.split(",") for text in sys.argv[1:])]

if not places:
    sys.exit("name the places, as 2.5,1.5 8.0,4.0 [m, world]")

with uvf.connect() as run:
    team = [name for name in run.vehicles() if run.read(name, topics.STATUS).kind == Kind.KIND_GROUND]

    def takes(rover: str, goal: Vector3, start: Vector3 | None = None) -> float:
        way = run.ask(rover, topics.PREVIEW, PreviewRequest(position=goal, start=start, source="client"))
        return way.duration if way.accepted else math.inf

    to_goals = np.array([[takes(rover, goal) for goal in places] for rover in team])
    between = np.array([[[takes(rover, goal, start) for goal in places] for start in places] for rover in team])
    found = assign(to_goals, between)
    for rover, tour, time in zip(team, found.tours, found.times, strict=True):
        if tour:
            route = RouteRequest(places=[places[goal] for goal in tour], kind=RouteRequest.WAYPOINTS, source="client")
            reply = run.ask(rover, topics.ROUTE, route)
            print(f"{rover} goes to {len(tour)} places in {time:.0f} s" if reply.accepted else f"{rover}: {reply.reason}")
    for goal in found.unreachable:
        print(f"nobody goes to ({places[goal].x:g}, {places[goal].y:g})")
