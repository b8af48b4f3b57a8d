"""One demo for all tests of this folder."""

from contextlib import closing

import pytest

from tests.distributed.system import System
from tests.second_try import Shared


@pytest.fixture(scope="package")
def systems(tmp_path_factory):
    with closing(Shared(lambda: System(tmp_path_factory.mktemp("runs")))) as shared:
        yield shared


@pytest.fixture
def system(systems, request):
    return systems.for_test(request)
