"""Lockstep: the demo mission in this process, as fast as it goes, and what became of it.

    .venv/bin/python examples/02_lockstep.py

Every sensor, filter, map and controller runs as it does in real time; two runs give the same bytes.
"""

import tempfile
from pathlib import Path

from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario

site = load_scenario(ROOT / "missions" / "demo.yaml")
with tempfile.TemporaryDirectory() as folder:
    result = run_lockstep(site, until=10.0, log=Path(folder, "log.mcap"))

for verdict in result.verdicts:
    print(f"{verdict.subject:8} {verdict.criterion.measure:16} {verdict.found.value:8.3g}   wanted {verdict.limits}")
print(f"{result.messages} messages, {result.factor:.1f} times real time, hash {result.log_hash[:16]}")
