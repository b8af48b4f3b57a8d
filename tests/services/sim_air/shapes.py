"""The shape of an aircraft for tests that need any."""

from uvf.runtime.aircraft_shape import aircraft_shape
from uvf.runtime.site import ROOT
from uvf.runtime.surroundings import aircraft_tree
from uvf.runtime.vehicle_file import load_vehicle

MILVUS_TREE = aircraft_tree(aircraft_shape(ROOT / "vehicles" / "milvus", load_vehicle(ROOT / "vehicles", "milvus")))
