"""Trims an aircraft for level flight and linearizes it: JSBSim's model, the equations of Beard & McLain, chapter 5."""

from services.sim_air.analysis.linear import linearize
from services.sim_air.engine.airframe import Airframe
from uvf.maths.geodesy import LocalTangent
from uvf.models import load_vehicle
from uvf.models.scenario import ROOT

folder = ROOT / "vehicles" / "milvus"
milvus = load_vehicle(folder.parent, folder.name)
airframe = Airframe(folder, milvus.air, LocalTangent.from_degrees(47.0, 0.0, 0.0))
models = linearize(airframe, airspeed=25.0, altitude=1000.0, path=folder)
for mode in models.modes:
    print(mode)
