"""A guardian that does not come to start leaves nothing behind, whatever the reason."""

import fcntl
import os
import resource
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.hal.guardian.two_servos import record
from windup.hal.errors import HardwareError, PortError
from windup.hal.guardian import handle
from windup.hal.guardian.handle import Guardian
from windup.hal.guardian.launch import launch
from windup.hal.guardian.order import GuardianOrder
from windup.hal.port.lock import AdapterLock


def free(path: Path) -> bool:
    lock = AdapterLock(str(path))
    try:
        return lock.try_acquire()
    finally:
        lock.close()


@contextmanager
def files(most: int) -> Iterator[None]:
    """Allow no descriptor of this number or above."""
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)


def test_ctrl_c_that_the_program_catches_ends_the_one_that_starts(
    sts_bus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    launched: list[subprocess.Popen[bytes]] = []
    start = Guardian._start

    def remember(locks: Sequence[int]) -> "subprocess.Popen[bytes]":
        launched.append(launch(locks))
        return launched[0]

    def interrupted(guardian: Guardian, order: GuardianOrder) -> None:
        start(guardian, order)
        raise KeyboardInterrupt

    monkeypatch.setattr(handle, "launch", remember)
    monkeypatch.setattr(Guardian, "_start", interrupted)
    with pytest.raises(KeyboardInterrupt):
        Guardian([record(sts_bus)], "limp")
    assert launched[0].returncode is not None
    assert free(sts_bus)


def test_of_two_adapters_one_that_is_taken_leaves_the_other_free(
    sts_bus: Path, tmp_path: Path
) -> None:
    taken = AdapterLock(str(tmp_path / "taken"))
    taken.acquire()
    with pytest.raises(PortError, match="another armed run"):
        Guardian([record(sts_bus), record(tmp_path / "taken")], "limp")
    assert free(sts_bus)
    taken.close()


def test_too_many_open_files_are_said_in_words_and_are_no_harm_later(sts_bus: Path) -> None:
    lowest = os.dup(0)
    os.close(lowest)
    failed = 0
    for more in range(7):
        try:
            with files(lowest + more):
                Guardian([record(sts_bus)], "limp").release()
        except HardwareError as error:
            assert "too many open files: close some" in str(error)
            failed += 1
        assert free(sts_bus)
    assert failed > 2


def test_a_program_with_more_than_1024_open_files_has_one_too(sts_bus: Path) -> None:
    with files(1200):
        held = [os.dup(0) for _ in range(1100)]
        try:
            guardian = Guardian([record(sts_bus)], "limp")
            assert guardian._descriptor >= 1024
            guardian.tick()
            guardian.release()
        finally:
            for each in held:
                os.close(each)


def test_a_guardian_is_given_no_file_that_took_the_number_of_standard_error(
    sts_bus: Path,
) -> None:
    kept = fcntl.fcntl(2, fcntl.F_DUPFD_CLOEXEC, 3)
    strange = os.open("/dev/zero", os.O_RDONLY)
    os.dup2(strange, 2, inheritable=False)
    try:
        guardian = Guardian([record(sts_bus)], "limp")
        assert os.readlink(f"/proc/{guardian.pid}/fd/2") == os.devnull
        guardian.release()
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(strange)
