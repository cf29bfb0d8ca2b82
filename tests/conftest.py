from collections.abc import Iterator

import pytest
from hypothesis import settings

from robots import RobotDescription, load_robot

pytest_plugins = ["pytester"]

# The same examples on every machine, and no clock in them.
settings.register_profile("windup", deadline=None, database=None, derandomize=True, max_examples=40)
settings.load_profile("windup")


@pytest.fixture(scope="session", autouse=True)
def runtime_folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Let no ring and no lock of a test stay in the user's runtime folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_RUNTIME_DIR", str(tmp_path_factory.mktemp("runtime")))
        yield


@pytest.fixture(scope="session")
def op3() -> RobotDescription:
    return load_robot("op3")


@pytest.fixture(scope="session")
def human() -> RobotDescription:
    return load_robot("human")
