"""A recorded mission as ``uvf up`` leaves it: with the files that say what was run."""

from launch.attachments import attachments
from tests.golden.make import GOLDEN
from tests.services.gcs.scripted import demo_site
from uvf.runtime.log.reading import read_log
from uvf.runtime.log.recording import Recorder


def demo_log(folder):
    """The first seconds of the demo."""
    with Recorder(folder / "log-000.mcap", attachments(demo_site())) as log:
        for sample in read_log(GOLDEN):
            log.write(sample)
    return log.path
