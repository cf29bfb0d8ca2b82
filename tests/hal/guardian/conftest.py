from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.hal.guardian.two_servos import emulated


@pytest.fixture(scope="module")
def sts_bus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    path = tmp_path_factory.mktemp("guardian") / "bus"
    with emulated("twin://bench?servos=STS3215:1-2", "--pty", str(path)):
        yield path
