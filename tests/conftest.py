import os
import tempfile

import pytest
from hypothesis import settings

from windup.robots import RobotDescription, load_robot

pytest_plugins = ["pytester"]

# No ring and no lock of a test comes into the user's own folder.
RUNTIME = tempfile.TemporaryDirectory(prefix="windup-tests-", ignore_cleanup_errors=True)
os.environ["XDG_RUNTIME_DIR"] = RUNTIME.name

# The same examples on every machine, and no clock in them.
settings.register_profile("windup", deadline=None, database=None, derandomize=True, max_examples=40)
settings.load_profile("windup")


def pytest_unconfigure() -> None:
    RUNTIME.cleanup()


@pytest.fixture(scope="session")
def op3() -> RobotDescription:
    return load_robot("op3")


@pytest.fixture(scope="session")
def human() -> RobotDescription:
    return load_robot("human")
