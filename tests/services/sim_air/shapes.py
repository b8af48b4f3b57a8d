"""The shape of an aircraft for tests that need any."""

from uvf.models.aircraft.shape import aircraft_shape
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.sensors.surroundings import aircraft_tree

MILVUS_TREE = aircraft_tree(aircraft_shape(ROOT / "vehicles" / "milvus", load_vehicle(ROOT / "vehicles", "milvus")))
