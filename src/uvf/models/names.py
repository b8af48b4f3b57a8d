"""What vehicles, maps, and folders of vehicles and worlds may be called: names that are safe as keys on the bus, in paths, in frames."""

VEHICLE = r"[a-z][a-z0-9_]{0,39}"
FOLDER = r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,79}"
MAP = r"[A-Za-z0-9_][A-Za-z0-9_-]{0,79}"
SYSTEM = "sys"
"""Stands for the system itself; no vehicle is called so."""
