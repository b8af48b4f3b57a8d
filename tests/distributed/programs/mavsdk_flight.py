"""A user's MAVSDK script: a whole flight, one line of JSON for each step and each change of what the vehicle tells.

``python mavsdk_flight.py PORT SYSTEM_ID VEHICLES [short]``, with MAVSDK 4 or 3: the plugins have the same methods in both. VEHICLES: how
many there are to be found; ``short``: without orbit, mission and parameters.
"""

import asyncio
import inspect
import json
import math
import sys
import time

METRES_PER_DEGREE = 111_320.0
PATIENCE = 200.0  # s; the simulation may be slower than time
POINT = (300.0, 250.0, 60.0)  # m: east, north, up of home
ITEMS = [(250.0, 100.0, 60.0), (50.0, 100.0, 60.0), (50.0, 250.0, 60.0), (250.0, 250.0, 60.0)]
TAKEOFF_ALTITUDE, ORBIT_RADIUS, SPEED = 35.0, 80.0, 21.0
STREAMS = ("armed", "in_air", "landed_state", "flight_mode", "health_all_ok", "status_text", "home", "position", "velocity_ned")
TOLD = STREAMS[:6]
"""Streams whose changes are told."""


class Drone:
    """The plugins of one vehicle, whatever the version."""

    def __init__(self):
        self.found = []

    async def connect(self, port, system_id, vehicles):
        import mavsdk

        if hasattr(mavsdk, "Mavsdk"):
            await self._connect_4(port, system_id, vehicles)
        else:
            await self._connect_3(mavsdk, port)

    async def _connect_4(self, port, system_id, vehicles):
        from mavsdk.asyncio import ComponentType, Configuration, Mavsdk
        from mavsdk.asyncio.plugins.action import ActionAsync, OrbitYawBehavior
        from mavsdk.asyncio.plugins.mission import MissionAsync, MissionItem, MissionPlan
        from mavsdk.asyncio.plugins.param import ParamAsync
        from mavsdk.asyncio.plugins.telemetry import TelemetryAsync

        self._sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        await self._sdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        while len(self.found) < vehicles:
            await asyncio.sleep(0.05)
            systems = {await each.get_system_id(): each for each in await self._sdk.get_systems()}
            self.found = sorted(systems)
        system = systems[system_id]
        self.action, self.mission, self.param = ActionAsync(system), MissionAsync(system), ParamAsync(system)
        self._telemetry, self._prefix = TelemetryAsync(system), "subscribe_"
        self.tangent = OrbitYawBehavior.HOLD_FRONT_TANGENT_TO_CIRCLE
        self._item, self._plan = MissionItem, MissionPlan

    async def _connect_3(self, mavsdk, port):
        """The vehicle that comes first: this version has no other."""
        from mavsdk.action import OrbitYawBehavior
        from mavsdk.mission import MissionItem, MissionPlan

        self._sdk = mavsdk.System(port=port + 1)
        await self._sdk.connect(system_address=f"udpin://127.0.0.1:{port}")
        self.action, self.mission, self.param = self._sdk.action, self._sdk.mission, self._sdk.param
        self._telemetry, self._prefix = self._sdk.telemetry, ""
        self.tangent = OrbitYawBehavior.HOLD_FRONT_TANGENT_TO_CIRCLE
        self._item, self._plan = MissionItem, MissionPlan

    def stream(self, name):
        return getattr(self._telemetry, self._prefix + name)()

    def progress(self):
        return getattr(self.mission, self._prefix + "mission_progress")()

    def plan(self, places):
        return self._plan([self._make(*place) for place in places])

    def _make(self, latitude, longitude, above_home):
        """Version 3 wants every argument."""
        names = [name for name in inspect.signature(self._item.__init__).parameters if name != "self"]
        given = dict.fromkeys(names, math.nan)
        given |= {"latitude_deg": latitude, "longitude_deg": longitude, "relative_altitude_m": above_home, "is_fly_through": True}
        given |= {"camera_action": self._item.CameraAction.NONE, "vehicle_action": self._item.VehicleAction.NONE}
        return self._item(**given)


class Flight:
    def __init__(self, drone):
        self.drone, self.now, self.begun = drone, {}, time.monotonic()
        self.progress = (0, 0)
        self._watching = []

    def note(self, what, **facts):
        sys.stdout.write(json.dumps({"t": round(time.monotonic() - self.begun, 3), "what": what, **facts}) + "\n")
        sys.stdout.flush()

    def watch(self):
        self._watching = [asyncio.ensure_future(self._follow(name, self.drone.stream(name))) for name in STREAMS]
        self._watching.append(asyncio.ensure_future(self._follow_progress()))

    async def _follow(self, name, stream):
        async for value in stream:
            if name in TOLD and self.now.get(name) != value:
                self.note(name, now=text_of(value))
            self.now[name] = value

    async def _follow_progress(self):
        async for value in self.drone.progress():
            if self.progress != (value.current, value.total):
                self.progress = (value.current, value.total)
                self.note("progress", now=list(self.progress))

    async def do(self, what, action):
        """Awaits one order; how long it took is told, and what was wrong."""
        before = time.monotonic()
        try:
            await action
        except Exception as wrong:  # noqa: BLE001 - each version has its own
            self.note(what, took=round(time.monotonic() - before, 3), failed=f"{type(wrong).__name__}: {wrong}")
            return False
        self.note(what, took=round(time.monotonic() - before, 3))
        return True

    async def until(self, what, condition):
        end = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > end:
                self.note(what, failed="not in time")
                sys.exit(1)
            await asyncio.sleep(0.02)
        self.note(what)

    def says(self, name, value):
        """Whether a stream's newest value is of that name."""
        return lambda: text_of(self.now.get(name)) == value

    def place(self, east, north, up):
        """Degrees, and metres above the sea."""
        home = self.now["home"]
        longitude = home.longitude_deg + east / METRES_PER_DEGREE / math.cos(math.radians(home.latitude_deg))
        return home.latitude_deg + north / METRES_PER_DEGREE, longitude, home.absolute_altitude_m + up

    def distance(self, east, north):
        """To a place relative to home, over ground [m]."""
        latitude, longitude, _ = self.place(east, north, 0.0)
        here = self.now["position"]
        dx = (here.longitude_deg - longitude) * METRES_PER_DEGREE * math.cos(math.radians(latitude))
        return math.hypot(dx, (here.latitude_deg - latitude) * METRES_PER_DEGREE)

    def speed(self):
        v = self.now["velocity_ned"]
        return math.hypot(v.north_m_s, v.east_m_s)

    async def stays(self, what, condition, seconds=1.5):
        """Becomes so, and stays so for a while."""
        since = [time.monotonic()]

        def steady():
            if not condition():
                since[0] = time.monotonic()
            return time.monotonic() - since[0] > seconds

        await self.until(what, steady)

    async def fly(self, short):
        drone = self.drone
        await self.until("ready", lambda: {"home", "position", "velocity_ned"} <= set(self.now) and self.now.get("health_all_ok"))
        if not short:
            await self.parameters()
        await self.do("arm", drone.action.arm())
        await self.until("is armed", lambda: self.now["armed"])
        await self.do("takeoff altitude", drone.action.set_takeoff_altitude(TAKEOFF_ALTITUDE))
        await self.do("takeoff", drone.action.takeoff())
        await self.until("taking off", self.says("flight_mode", "TAKEOFF"))
        await self.until("holds after take-off", self.says("flight_mode", "HOLD"))
        await self.do("goto", drone.action.goto_location(*self.place(*POINT), 0.0))
        await self.until("is there", lambda: self.distance(*POINT[:2]) < 150.0)
        if not short:
            await self.circle()
            await self.mission()
        await self.do("return", drone.action.return_to_launch())
        await self.until("returns", self.says("flight_mode", "RETURN_TO_LAUNCH"))
        await self.until("is near home", lambda: self.distance(0.0, 0.0) < 250.0)
        await self.do("land", drone.action.land())
        await self.until("lands", self.says("flight_mode", "LAND"))
        await self.until("stands", self.says("landed_state", "ON_GROUND"))
        if self.now["armed"]:
            await self.do("disarm", drone.action.disarm())
        await self.until("is disarmed", lambda: not self.now["armed"])
        await self.until("is not in the air", lambda: not self.now["in_air"])

    async def parameters(self):
        await self.do("a parameter that is none", self.drone.param.set_param_float("NOPE", 1.0))
        await self.do("a parameter that is one", self.drone.param.set_param_float("NAV_LOITER_RAD", 85.0))
        value = await self.drone.param.get_param_float("NAV_LOITER_RAD")
        self.note("read back", value=value, system_id=await self.drone.param.get_param_int("MAV_SYS_ID"))

    async def circle(self):
        drone = self.drone
        await self.do("orbit", drone.action.do_orbit(ORBIT_RADIUS, 25.0, drone.tangent, *self.place(*POINT)))
        await self.stays("circles", lambda: abs(self.distance(*POINT[:2]) - ORBIT_RADIUS) < 0.1 * ORBIT_RADIUS)
        await self.do("speed", drone.action.set_current_speed(SPEED))
        await self.stays("has the speed", lambda: abs(self.speed() - SPEED) < 1.0)

    async def mission(self):
        drone = self.drone
        above = self.now["home"].absolute_altitude_m
        places = [(latitude, longitude, altitude - above) for latitude, longitude, altitude in (self.place(*item) for item in ITEMS)]
        await self.do("upload", drone.mission.upload_mission(drone.plan(places)))
        back = (await drone.mission.download_mission()).mission_items
        self.note("download", off=max(abs(b.latitude_deg - p[0]) + abs(b.longitude_deg - p[1]) for b, p in zip(back, places, strict=True)))
        await self.do("start", drone.mission.start_mission())
        await self.until("flies the mission", self.says("flight_mode", "MISSION"))
        await self.until("has reached the first item", lambda: self.progress == (1, len(ITEMS)))
        await self.do("pause", drone.mission.pause_mission())
        await self.until("is paused", self.says("flight_mode", "HOLD"))
        await self.do("jump", drone.mission.set_current_mission_item(3))
        await self.do("go on", drone.mission.start_mission())
        await self.until("has flown the mission", lambda: self.progress == (len(ITEMS), len(ITEMS)))
        self.note("finished", now=await drone.mission.is_mission_finished())
        await self.until("holds after the mission", self.says("flight_mode", "HOLD"))


def text_of(value):
    """Enumerations by name, messages by their text."""
    if hasattr(value, "text"):
        return value.text
    return value.name if hasattr(value, "name") else value


async def main(port, system_id, vehicles, short):
    drone = Drone()
    flight = Flight(drone)
    await drone.connect(port, system_id, vehicles)
    flight.note("connected", found=drone.found)
    flight.watch()
    await flight.fly(short)
    flight.note("end")


if __name__ == "__main__":
    asyncio.run(main(int(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]), "short" in sys.argv))
