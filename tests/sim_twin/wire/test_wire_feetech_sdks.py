"""Every call of Feetech's two unmodified SDKs on emulated STS and SCS servos.

In real time, under a path; and on a virtual clock.
"""

import json
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from tests.sim_twin.wire.clients.run import run_client
from tests.sim_twin.wire.emulator_process import emulator
from windup.tools.testing.bus_options import bus_url

SERVOS = {"sts": ("STS3215:1-2", 777, 2048), "scs": ("SCS0009:1-2", 1284, 512)}
SUPPLY = {"sts": 7.4, "scs": 6.0}  # V
SDKS = {"feetech-servo-sdk": None, "ftservo-python-sdk": "ftservo"}
NEAR = 8  # counts of a goal, which a servo without an integral gain does not reach


@pytest.fixture(scope="module", params=product(SERVOS, SDKS, ("path", "virtual clock")))
def said(
    tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest
) -> Iterator[dict[str, Any]]:
    family, sdk, time = request.param
    servos, model, middle = SERVOS[family]
    expected = {"should": (model, middle), "new": SDKS[sdk] is not None}
    options = {"servos": servos, "return_delay": 0, "supply": SUPPLY[family]}
    if time == "virtual clock":
        yield expected | run_client("feetech", family, json.dumps(options), package=SDKS[sdk])
        return
    path: Path = tmp_path_factory.mktemp("feetech") / "servos"
    with emulator(bus_url("bench", options), path) as name:
        yield expected | run_client("feetech", family, name, package=SDKS[sdk])


def test_it_makes_every_call(said: dict[str, Any]) -> None:
    assert said["uncalled"] == said["group_uncalled"] == []


def test_it_opens_the_port_and_pings(said: dict[str, Any]) -> None:
    assert said["opened"] == [True, True, 1_000_000]
    assert (said["idle"], said["late"], said["version"]) == (0, True, 1.0)
    assert said["model"] == said["should"][0]
    assert said["words"][0].endswith("Communication success!")
    assert said["words"][1].endswith("Overload error!")


def test_it_reads_the_same_in_each_way(said: dict[str, Any]) -> None:
    middle = said["should"][1]
    assert said["read1"] == [0, 0, [0, 0]]
    assert said["read2"] == said["read4"] == [middle, middle, [0, 0]]
    low_first = [middle & 255, middle >> 8]
    assert said["bytes"] == [low_first if middle == 2048 else low_first[::-1]] * 2
    assert said["sync"] == 2


def test_it_writes_in_each_way(said: dict[str, Any]) -> None:
    assert said["torque"] == [[0, 0], 0]
    assert said["speeds"] == [700, 800]
    assert said["goals"] == pytest.approx([400, 600, 450, 550, 500, 600], abs=NEAR)
    assert said["waits"] == [True, True]
    assert said["both"] == pytest.approx([550, 550], abs=NEAR)


def test_it_reads_and_writes_in_groups(said: dict[str, Any]) -> None:
    assert said["group_write"] == 0
    assert said["group_read"][0] == 0
    assert said["group_read"][1:] == pytest.approx([500, 500], abs=NEAR)
    assert said["available"]


def test_the_newer_one_moves_servos_by_calls_of_its_own(said: dict[str, Any]) -> None:
    if not said["new"]:
        assert "places" not in said
        return
    assert said["moving"] == [1, 0, 0]
    assert said["places"] == pytest.approx([700, 600, 500], abs=NEAR)
    assert said["place"] == pytest.approx([500, 500], abs=NEAR)
    assert said["locks"] == [[0, 0], [0, 0]]
    assert said["backward"] < -300
