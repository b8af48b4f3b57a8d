"""Records the golden log anew: ``python -m tests.golden.make``. Do it only when behaviour was meant to change, and say so."""

import tempfile
from pathlib import Path

from launch.run import run_lockstep
from schemas.topics import IMAGE
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import matches
from uvf.runtime.log.reading import read_log
from uvf.runtime.log.recording import Recorder

GOLDEN = Path(__file__).with_name("demo.mcap")
SECONDS = 8.0


def main() -> None:
    """The first seconds of the demo, without pictures."""
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder, "log.mcap")
        run_lockstep(load_scenario(ROOT / "missions" / "demo.yaml"), SECONDS, whole)
        with Recorder(GOLDEN) as recorder:
            for sample in read_log(whole):
                if not matches(IMAGE.at("*"), sample.key):
                    recorder.write(sample)


if __name__ == "__main__":
    main()
