import struct
from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
import pytest

from tests.hal.fake_bus import VirtualClock
from windup.hal.errors import PortError, UsageError
from windup.hal.imu.bno055 import (
    AXIS_MAP_CONFIG,
    AXIS_MAP_SIGN,
    BNO055_ID,
    CHIP_ID,
    CONFIG,
    DATA,
    IMU_MODE,
    OPR_MODE,
    STRAIGHT_AXES,
    UNIT_SEL,
    UNITS,
    Bno055,
    Bno055Link,
)
from windup.hal.imu.i2c import open_i2c
from windup.hal.imu.mounting import Mounting
from windup.hal.imu.open_duck import OPEN_DUCK
from windup.hal.port.open_port import open_port

NDOF = 0x0C


class FakeChip:
    """The registers of a BNO055, and whether its wires hold."""

    def __init__(self, mode: int = CONFIG) -> None:
        self.clock = VirtualClock()
        self.memory = bytearray(0x80)
        self.memory[CHIP_ID], self.memory[OPR_MODE], self.memory[UNIT_SEL] = BNO055_ID, mode, 0x80
        self.memory[AXIS_MAP_CONFIG : AXIS_MAP_SIGN + 1] = bytes(STRAIGHT_AXES)
        self.written: list[tuple[float, int, int]] = []
        self.there, self.stuck = True, False
        self.closed = 0

    def opener(self, url: str, address: int) -> "FakeChip":
        assert (url, address) == ("/dev/i2c-1", 0x28)
        return self

    def read(self, register: int, count: int) -> bytes:
        self._answer()
        return bytes(self.memory[register : register + count])

    def write(self, register: int, value: int) -> None:
        self._answer()
        self.memory[register] = self.memory[register] if self.stuck else value
        self.written.append((self.clock.now(), register, value))

    def close(self) -> None:
        self.closed += 1

    def feel(
        self,
        acceleration: Sequence[int] = (0, 0, 981),
        rates: Sequence[int] = (0, 0, 0),
        orientation: Sequence[int] = (1 << 14, 0, 0, 0),
    ) -> None:
        counts = *acceleration, 0, 0, 0, *rates, 0, 0, 0, *orientation
        self.memory[DATA : DATA + 32] = struct.pack("<16h", *counts)

    def _answer(self) -> None:
        if not self.there:
            raise OSError(121, "Remote I/O error")


def listening(chip: FakeChip, mounting: Mounting | None = None) -> tuple[Bno055, Bno055Link]:
    imu = Bno055("/dev/i2c-1", mounting, chip.opener)
    return imu, imu.connect(open_port)


def test_the_counts_of_the_data_sheet_become_si_units() -> None:
    chip = FakeChip()
    imu, link = listening(chip)
    chip.feel((100, -200, 981), (900, 0, -450), (0, 0, 0, 1 << 14))
    link.poll()
    state = imu.state(chip.clock.now())
    assert state is not None and state.orientation is not None
    assert state.acceleration == pytest.approx([1.0, -2.0, 9.81])
    assert state.angular_velocity == pytest.approx([1.0, 0.0, -0.5])
    assert state.orientation == pytest.approx([0, 0, 0, 1])
    assert state.age == pytest.approx(0.005), "between two samples a read is half a period late"


def test_a_chip_in_another_mode_is_set_with_the_waits_of_the_data_sheet() -> None:
    chip = FakeChip(mode=NDOF)
    listening(chip)
    assert [(register, value) for _, register, value in chip.written] == [
        (OPR_MODE, CONFIG),
        (0x07, 0),
        (UNIT_SEL, UNITS),
        (AXIS_MAP_CONFIG, 0x24),
        (AXIS_MAP_SIGN, 0x00),
        (OPR_MODE, IMU_MODE),
    ]
    began = chip.written[0][0]
    assert chip.written[1][0] - began == pytest.approx(0.019)
    assert chip.clock.now() - began == pytest.approx(0.019 + 0.007)


def test_a_chip_that_measures_already_is_left_alone() -> None:
    chip = FakeChip(mode=0x10 | IMU_MODE)
    chip.memory[UNIT_SEL] = UNITS
    listening(chip)
    assert chip.written == []


def test_axes_that_another_program_has_left_in_the_chip_are_reset() -> None:
    chip = FakeChip(mode=IMU_MODE)
    chip.memory[UNIT_SEL] = UNITS
    chip.memory[AXIS_MAP_CONFIG], chip.memory[AXIS_MAP_SIGN] = 0x21, 0x07
    listening(chip)
    assert bytes(chip.memory[AXIS_MAP_CONFIG : AXIS_MAP_SIGN + 1]) == b"\x24\x00"
    assert chip.memory[OPR_MODE] == IMU_MODE


def test_a_sample_that_was_read_before_ages() -> None:
    chip = FakeChip()
    imu, link = listening(chip)
    chip.feel()
    link.poll()
    chip.clock.time += 0.3
    link.poll()
    state = imu.state(chip.clock.now())
    assert state is not None and state.age == pytest.approx(0.305)


@pytest.mark.parametrize(
    ("rates", "orientation"),
    [((0, 0, 0), (-1, -1, -1, -1)), ((0, 0, 0), (0, 0, 0, 0)), ((32767, 0, 0), (16384, 0, 0, 0))],
    ids=["open line", "no quaternion", "too fast"],
)
def test_a_sample_that_cannot_be_is_refused(
    rates: tuple[int, ...], orientation: tuple[int, ...]
) -> None:
    chip = FakeChip()
    imu, link = listening(chip)
    chip.feel(rates=rates, orientation=orientation)
    link.poll()
    assert imu.state(chip.clock.now()) is None and imu.implausible == 1


def test_a_chip_that_lost_its_power_is_set_again_without_a_wait_in_the_loop() -> None:
    chip = FakeChip()
    imu, link = listening(chip)
    chip.there = False
    link.poll()
    chip.there, chip.memory[OPR_MODE], chip.memory[UNIT_SEL] = True, CONFIG, 0x80
    chip.written.clear()
    before = chip.clock.now()
    link.poll()
    assert chip.written == [], "the next try comes a while later"
    assert chip.clock.now() == before
    for number in range(3):
        chip.clock.time += 0.25
        chip.feel(rates=(number, 0, 0))
        link.poll()
    state = imu.state(chip.clock.now())
    assert state is not None and state.age < 0.01


def test_a_chip_that_never_measures_is_refused() -> None:
    chip = FakeChip()
    chip.stuck = True
    with pytest.raises(PortError, match="does not enter its IMU mode: switch its power off and on"):
        listening(chip)


@pytest.mark.parametrize(
    ("there", "identity", "says"),
    [(False, 0, "nothing answers where a BNO055"), (True, 0x55, "a chip with id 0x55 is where")],
)
def test_what_is_no_bno055_is_refused(there: bool, identity: int, says: str) -> None:
    chip = FakeChip()
    chip.there, chip.memory[CHIP_ID] = there, identity
    with pytest.raises(PortError, match=says):
        listening(chip)
    assert chip.closed == 1


def test_a_chip_whose_power_came_a_moment_ago_is_waited_for() -> None:
    chip = FakeChip()
    chip.memory[CHIP_ID] = 0
    wait = chip.clock.wait_until

    def wake(time: float) -> None:
        wait(time)
        chip.memory[CHIP_ID] = BNO055_ID if chip.clock.time > 100.4 else 0

    chip.clock.wait_until = wake  # type: ignore[method-assign]
    listening(chip)
    assert chip.memory[OPR_MODE] == IMU_MODE


def test_an_open_ducks_chip_lies_on_its_back() -> None:
    chip = FakeChip()
    imu, link = listening(chip, OPEN_DUCK.mounting)
    # Upright, it feels gravity along its own -z; a turn to the left is one about its own -z too.
    half = np.sqrt(0.5)
    upright = np.rint([0.0, half * 16384, -half * 16384, 0.0]).astype(int).tolist()
    chip.feel((0, 0, -981), (0, 0, -900), upright)
    link.poll()
    state = imu.state(chip.clock.now())
    assert state is not None and state.orientation is not None
    assert state.acceleration == pytest.approx([0, 0, 9.81])
    assert state.angular_velocity == pytest.approx([0, 0, 1])
    assert np.abs(state.orientation) == pytest.approx([1, 0, 0, 0], abs=1e-4)


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("/dev/i2c-1?address=0x99", "after the ? give the address of the chip"),
        ("socket://host:3000", "no I2C bus; give one such as /dev/i2c-1"),
    ],
)
def test_a_url_of_no_i2c_bus_is_refused(url: str, says: str) -> None:
    with pytest.raises(UsageError) as error:
        open_i2c(url, 0x28)
    assert says in str(error.value)


def test_a_bus_that_is_not_there_says_which_are() -> None:
    with pytest.raises(PortError, match="no I2C bus /dev/i2c-99; buses there are: "):
        open_i2c("/dev/i2c-99", 0x28)


def test_a_wire_that_is_held_low_does_not_stop_the_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[int, int, int]] = []
    monkeypatch.setattr("smbus2.SMBus", lambda path: SimpleNamespace(fd=7, close=lambda: None))
    monkeypatch.setattr("fcntl.ioctl", lambda *request: asked.append(request))
    open_i2c("/dev/i2c-3", 0x28).close()
    assert asked == [(7, 0x0701, 0), (7, 0x0702, 2)]  # no retry, 20 ms
