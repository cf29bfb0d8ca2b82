"""A host that does not see `windup stop` in its flag is stopped by its guardian."""

import os
import subprocess
from pathlib import Path

from tests.hal.guardian.two_servos import record
from windup.hal.guardian.handle import Guardian
from windup.hal.guardian.host import Host
from windup.hal.guardian.order import IDLE, TICK, GuardianOrder
from windup.hal.guardian.process import StopReason, watch
from windup.hal.guardian.takeover import OFF, Takeover
from windup.hal.stopping.stop_flag import Outcome, StopFlag


def test_a_host_that_beats_but_does_not_see_the_request_is_silent(tmp_path: Path) -> None:
    flag = StopFlag.create("op3", None, tmp_path)
    reading, writing = os.pipe()
    with subprocess.Popen(["sleep", "60"]) as program:
        os.write(writing, TICK + IDLE)
        flag.request()
        assert watch(reading, Host(program.pid), flag) == (StopReason.IGNORED_STOP, True)
        program.kill()
    os.close(reading)
    os.close(writing)
    flag.remove()


def test_the_guardian_is_known_to_who_asks_while_torque_may_be_on(
    sts_bus: Path, tmp_path: Path
) -> None:
    flag = StopFlag.create("op3", None, tmp_path)
    guardian = Guardian([record(sts_bus)], "limp", flag=flag)
    assert flag.guardian == guardian.pid
    guardian.release()
    assert flag.guardian == 0
    flag.remove()


def test_who_asks_is_told_what_the_guardian_has_read(sts_bus: Path, tmp_path: Path) -> None:
    flag = StopFlag.create("op3", None, tmp_path)
    order = GuardianOrder(host=os.getpid(), policy="limp", buses=(record(sts_bus),))
    stamp = flag.request()
    Takeover(order, lambda text: None, flag).carry_out("its program hangs")
    assert flag.done(stamp)
    assert flag.outcome == Outcome(said=OFF, by="guardian")
    flag.remove()
