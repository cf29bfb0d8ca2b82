"""A button of OP3 ends a run as Ctrl-C does, with its own words."""

import os
import termios
from collections.abc import Callable, Iterator

import pytest

from tests.tools.conftest import Windup
from windup.hal.errors import UsageError
from windup.hal.observation import Observation
from windup.sim_twin.wire.boards.opencr import MODE_BUTTON, USER_BUTTON, OpenCr
from windup.tools.robot.stack import Stack
from windup.tools.stopping import stop_keys, stop_request
from windup.tools.stopping.interrupts import forget_interruption
from windup.tools.testing.servo_bus import ServoBus


@pytest.fixture(autouse=True)
def may_arm_again() -> Iterator[None]:
    yield
    forget_interruption()


def board(bus: ServoBus) -> OpenCr:
    device = bus.servo(200)
    assert isinstance(device, OpenCr)
    return device


def pressing(bus: ServoBus, after: float) -> Callable[[Observation], None]:
    """Return what presses a button so long after it was first asked, s."""
    began: list[float] = []

    def watch(observation: Observation) -> None:
        began.append(observation.time)
        if observation.time >= began[0] + after:
            board(bus).buttons = USER_BUTTON

    return watch


def test_a_button_ends_a_run_and_the_torque_goes_off() -> None:
    with ServoBus("op3") as bus, bus.robot() as robot:
        robot.watch.append(pressing(bus, 0.5))
        with pytest.raises(KeyboardInterrupt, match="stopped by the user button"):
            robot.stand(2.0)
        assert robot.loop.reason == "interrupted" and not robot.armed
        assert not any(device.driving for device in bus.world.devices)


def test_a_button_that_is_held_down_keeps_torque_off_and_is_told() -> None:
    with ServoBus("op3") as bus, bus.robot() as robot:
        board(bus).buttons = MODE_BUTTON
        with pytest.raises(UsageError, match="the mode button of the robot is held down"):
            robot.stand(0.5)
        assert not robot.armed and not any(device.driving for device in bus.world.devices)
        board(bus).buttons = 0
        assert robot.stand(0.5).reason == "done"


@pytest.mark.parametrize(
    ("command", "after"),
    [
        (("stand",), 1.5),
        (("play", "wave"), 3.0),
        (("rise",), 1.5),
        (("step", "--foot", "left", "--to", "0.05", "0.1"), 5.0),
        (("stride",), 5.0),
        (("walk", "--open-loop"), 3.5),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else None,
)
def test_a_command_that_a_button_stops_has_status_130_and_says_so(
    shell: Windup,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    command: tuple[str, ...],
    after: float,
) -> None:
    read = OpenCr.read

    def pressed(self: OpenCr, address: int, count: int, now: float) -> tuple[int, bytes]:
        self.buttons = MODE_BUTTON if now > after else 0
        return read(self, address, count, now)

    monkeypatch.setattr(OpenCr, "read", pressed)
    name, *options = command
    ran = shell(name, "op3", *options, "--port", "twin://op3", "--json", "-")
    assert ran.status == 130
    assert ran.json["reason"] == "interrupted"
    assert "stopped by the mode button" in caplog.text


def test_a_key_of_the_terminal_ends_a_run_on_a_real_port_and_the_lines_say_so(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ours, theirs = os.openpty()
    monkeypatch.setattr(stop_keys, "_in_foreground", lambda descriptor: True)
    monkeypatch.setattr(stop_request, "keyboard", lambda: theirs)
    monkeypatch.setattr(Stack, "real", property(lambda stack: True))

    def press(observation: Observation) -> None:
        os.write(ours, b" ")

    with ServoBus("duck") as bus, bus.robot() as robot:
        robot.watch.append(press)
        with pytest.raises(KeyboardInterrupt, match="stopped by the space bar"):
            robot.stand(60.0)
        assert not robot.armed
    assert termios.tcgetattr(theirs)[3] & termios.ICANON
    assert capsys.readouterr().err == (
        "arming duck: space, q or Ctrl-C stops it\n"
        "duck: torque is off at all 14 joints, read back\n"
    )
    os.close(ours)
    os.close(theirs)
