"""Packs a MAVLink 2 heartbeat as a vehicle sends it and reads it back as a ground station does."""

from uvf.mavlink import dialect
from uvf.mavlink.codec import Codec

vehicle, station = Codec(), Codec()
kind, autopilot = dialect.MAV_TYPE_GROUND_ROVER, dialect.MAV_AUTOPILOT_PX4
heartbeat = dialect.MAVLink_heartbeat_message(kind, autopilot, base_mode=0, custom_mode=0, system_status=4, mavlink_version=3)
((packet, peer),) = vehicle.packets(1, heartbeat, to=[(("127.0.0.1", 14550), None)])
print(f"{len(packet)} bytes for {peer}")
for message in station.parse(packet):
    print(f"{message.get_type()} of system {message.get_srcSystem()}, type {message.type}")
