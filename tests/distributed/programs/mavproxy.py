"""MAVProxy without a window: lines go in, and what it prints is waited for."""

import re
import subprocess
import time

HOME = (40.77, 14.79, 300.0)  # deg, deg, m
WAYPOINTS = [
    (0, 16, HOME),  # the place of home, as every file of MAVProxy begins
    (3, 22, (40.77, 14.791, 40.0)),
    (3, 16, (40.7705, 14.7935, 60.0)),
    (3, 16, (40.7715, 14.7935, 60.0)),
    (3, 16, (40.7715, 14.788, 60.0)),
    (3, 16, (40.7705, 14.788, 60.0)),
    (3, 16, (40.77, 14.7885, 60.0)),
    (3, 16, (40.7695, 14.7895, 60.0)),
]
FENCE = [(3, 5001, (40.77 + dy, 14.79 + dx, 0.0)) for dx, dy in ((-0.01, -0.01), (-0.01, 0.01), (0.01, 0.01), (0.01, -0.01))]
RALLY = [(3, 5100, (40.7705, 14.7905, 60.0))]
PATIENCE, AGAIN_AFTER = 30.0, 4.0  # s
CONVERSATION = [
    ("param show FW_AIRSPD_TRIM", r"FW_AIRSPD_TRIM +25\.0"),
    ("param set NAV_LOITER_RAD 95", ""),
    ("param show NAV_LOITER_RAD", r"NAV_LOITER_RAD +95\.0"),
    ("wp load waypoints.txt", r"TYPE_MISSION: ACCEPTED"),
    ("wp list", r"(?s)Requesting 8 waypoints.*16 3 40\.7695000000 14\.7895000000 60\.000000"),
    ("fence load fence.txt", r"TYPE_FENCE: ACCEPTED"),
    ("fence list", r"(?s)(5001 3 40\.7[68]0* 14\.[78]+0* .*?){4}"),
    ("rally load rally.txt", r"TYPE_RALLY: ACCEPTED"),
    ("rally list", r"5100 3 40\.7705000000 14\.7905000000 60\.000000"),
    ("arm throttle", r"COMPONENT_ARM_DISARM: ACCEPTED"),
    ("long MAV_CMD_DO_SET_MODE 1 4 3", r"DO_SET_MODE: ACCEPTED"),
    ("wp set 2", r"DO_SET_MISSION_CURRENT: ACCEPTED"),
    ("rc 3 1500", ""),
    ("disarm", r"DISARMED"),
    ("rally clear", r"TYPE_RALLY: ACCEPTED"),
    ("fence clear", r"TYPE_FENCE: ACCEPTED"),
    ("wp clear", r"TYPE_MISSION: ACCEPTED"),
]
"""What is typed, and what is printed then."""


def waypoint_file(items):
    """The text of a file of items (frame, command, place); a vertex of a fence names how many there are."""
    lines = ["QGC WPL 110"]
    for seq, (frame, command, place) in enumerate(items):
        count = len(items) if command == 5001 else 0
        lines.append("\t".join(map(str, (seq, 0, frame, command, count, 0, 0, 0, *place, 1))))
    return "\n".join(lines) + "\n"


class MavProxy:
    """For one vehicle; runs in ``folder``, where its transcript stays."""

    def __init__(self, python, port, system_id, folder):
        for name, items in (("waypoints", WAYPOINTS), ("fence", FENCE), ("rally", RALLY)):
            (folder / f"{name}.txt").write_text(waypoint_file(items))
        self._output = folder / "mavproxy.txt"
        self._read = 0
        program = [str(python), "-u", str(python.parent / "mavproxy.py"), f"--master=udpin:127.0.0.1:{port}"]
        options = [f"--target-system={system_id}", "--no-state", "--force-connected"]
        with self._output.open("wb") as out:
            self._process = subprocess.Popen([*program, *options], cwd=folder, stdin=subprocess.PIPE, stdout=out, stderr=out)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.stdin.close()
        self._process.terminate()
        self._process.wait(30.0)

    def said(self):
        return self._output.read_text(errors="replace")

    def waits(self, pattern, seconds=PATIENCE):
        """Whether it has printed that since the last time that it was waited for."""
        end = time.monotonic() + seconds
        while (found := re.search(pattern, self.said()[self._read :])) is None:
            if time.monotonic() > end or self._process.poll() is not None:
                return False
            time.sleep(0.05)
        self._read += found.end()
        return True

    def types(self, line):
        self._process.stdin.write(f"{line}\n".encode())
        self._process.stdin.flush()

    def converse(self):
        """The lines that were not answered as they should be."""
        if not self.waits(r"Received \d+ parameters", 60.0):
            return ["it has no parameters"]
        return [line for line, answer in CONVERSATION if not self._is_answered(line, answer)]

    def _is_answered(self, line, answer):
        """What is only looked at is asked for again: a setting may still be on its way."""
        self.types(line)
        if not answer or not line.startswith("param show"):
            return not answer or self.waits(answer)
        end = time.monotonic() + PATIENCE
        while not self.waits(answer, AGAIN_AFTER):
            if time.monotonic() > end:
                return False
            self.types(line)
        return True
