"""Reads a vehicle, a world and a mission as data; what is wrong in a file is told in one line."""

from uvf.models import BadInput, load_scenario, load_vehicle, load_world
from uvf.models.scenario import ROOT

burger = load_vehicle(ROOT / "vehicles", "burger")
house = load_world(ROOT / "worlds", "house")
print(f"burger: radius {burger.ground.radius} m, lidar {burger.sensors.lidar.hz} Hz; house: {len(house.walls)} walls")
print("demo:", ", ".join(load_scenario(ROOT / "missions" / "demo.yaml").members))
try:
    load_vehicle(ROOT / "vehicles", "burgr")
except BadInput as error:
    print(error)
