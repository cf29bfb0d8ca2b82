"""A servo that may have lost its torque gets no goal until that has been read, on every make."""

import numpy as np
import pytest

from tests.hal.fake_bus1 import AX, MX, SCS, STS
from tests.hal.mixed_robot import Wires, mount, robot, ticks
from windup.hal.command import JointCommand
from windup.hal.errors import HardwareError
from windup.hal.families import family_of, servo_model
from windup.hal.servo_bus.torque_check import MISSES
from windup.hal.servos.servo_model import ServoModel

XM = servo_model("XM430-W350")
MAKES = [XM, STS, SCS, AX, MX]
names = [model.name for model in MAKES]
every_make = pytest.mark.parametrize("model", MAKES, ids=names)
GOAL, OTHER = 0.2, -0.2


class Bench:
    """Three servos with torque on; the second is the one that something happens to."""

    def __init__(self, model: ServoModel) -> None:
        self.model, self.wires = model, Wires()
        protocol = 2 if model is XM else 1
        self.wires.add("body", dict.fromkeys([1, 2, 3], model), protocol)
        self.backend = robot(self.wires, [mount(model, "body", id) for id in (1, 2, 3)])
        self.backend.connect()
        self.backend.configure()
        assert self.backend.set_torque(True).all_on

    def put(self, id: int, name: str, value: int) -> None:
        register = family_of(self.model.name).table(self.model.name)[name]
        data = register.encode(value)
        self.wires["body"].memory[id][register.address : register.address + len(data)] = data

    def goal(self, id: int) -> int:
        register = family_of(self.model.name).registers["goal_position"]
        memory = self.wires["body"].memory[id]
        return register.decode(bytes(memory[register.address : register.address + register.size]))

    def cycles(self, count: int, angle: float = GOAL) -> None:
        for _ in range(count):
            ticks(self.backend, 1)
            self.backend.write(JointCommand.hold(self.backend.joints, np.full(3, angle)))

    def restart(self, id: int) -> None:
        self.put(id, "torque_enable", 0)
        mark = family_of(self.model.name).restart_mark
        if mark is not None:
            self.put(id, mark.name, mark.restarted)

    def silence(self, cycles: int) -> None:
        self.wires["body"].silent.add(2)
        self.cycles(cycles)
        self.wires["body"].silent.clear()

    def gets_goals(self) -> list[bool]:
        before = [self.goal(id) for id in (1, 2, 3)]
        self.cycles(1, OTHER if before[0] == self._at(GOAL) else GOAL)
        return [self.goal(id) != old for id, old in zip((1, 2, 3), before, strict=True)]

    def _at(self, angle: float) -> int:
        return round(float(self.backend.units.counts(np.full(3, angle))[0]))


@every_make
def test_a_servo_that_was_silent_and_has_restarted_gets_no_goal_and_the_others_do(
    model: ServoModel,
) -> None:
    bench = Bench(model)
    bench.cycles(5)
    bench.silence(MISSES)
    bench.restart(2)
    bench.cycles(1)
    assert list(bench.backend.lost_joints) == ["j1"]
    assert str(bench.backend.lost_joints["j1"]).startswith("its servo restarted")
    assert bench.gets_goals() == [True, False, True]
    assert bench.backend.clamps["lost"] > 0
    assert bench.backend.clamp_bits is not None
    assert bench.backend.clamp_bits.tolist() == [0, 0b1000, 0]


@pytest.mark.parametrize("model", [STS, SCS, AX, MX], ids=names[1:])
def test_goals_stop_after_a_few_silent_cycles_and_go_on_when_torque_was_read_as_on(
    model: ServoModel,
) -> None:
    bench = Bench(model)
    bench.cycles(5)
    before = bench.backend.clamps["lost"]
    bench.silence(MISSES - 1)
    assert bench.backend.clamps["lost"] == before
    bench.silence(MISSES)
    assert bench.backend.clamps["lost"] > before
    assert bench.gets_goals() == [True, True, True]
    assert bench.backend.lost_joints == {} and bench.backend.doubtful_joints == {}


def test_a_silent_servo_that_no_goal_can_switch_on_goes_on_getting_them() -> None:
    bench = Bench(XM)
    bench.cycles(5)
    bench.silence(MISSES + 1)
    assert bench.backend.clamps["lost"] == 0


@every_make
def test_a_silent_servo_is_doubtful_and_not_lost(model: ServoModel) -> None:
    bench = Bench(model)
    bench.wires["body"].silent.add(2)
    bench.cycles(30)
    assert bench.backend.lost_joints == {} and list(bench.backend.doubtful_joints) == ["j1"]


@every_make
def test_torque_that_somebody_switches_off_is_seen_within_a_second(model: ServoModel) -> None:
    bench = Bench(model)
    bench.cycles(3)
    bench.put(2, "torque_enable", 0)
    bench.cycles(125)
    assert "switched it off" in str(bench.backend.lost_joints["j1"])
    assert bench.gets_goals() == [True, False, True]


@pytest.mark.parametrize("model", [STS, AX, MX], ids=["STS", "AX", "MX"])
def test_a_servo_that_a_goal_woke_after_a_restart_is_seen_by_its_torque_limit(
    model: ServoModel,
) -> None:
    bench = Bench(model)
    bench.cycles(3)
    bench.restart(2)
    bench.put(2, "torque_enable", 1)
    bench.cycles(125)
    assert str(bench.backend.lost_joints["j1"]).startswith("its servo restarted")


@every_make
def test_a_pause_of_the_loop_has_everybody_read_back_before_the_next_goal(
    model: ServoModel,
) -> None:
    bench = Bench(model)
    bench.cycles(3)
    bench.restart(2)
    bench.backend.clock.wait_until(bench.backend.clock.now() + 1.0)
    assert bench.gets_goals() == [True, False, True]
    assert list(bench.backend.lost_joints) == ["j1"]


@every_make
def test_an_alert_is_told_and_takes_nothing_away(model: ServoModel) -> None:
    bench = Bench(model)
    bench.cycles(3)
    bench.wires["body"].error[2] = 0x80 if model is XM else 0x04
    if model is XM:
        bench.put(2, "hardware_error", 0x04)
    bench.put(2, family_of(model.name).shutdown, 0x24)
    assert bench.gets_goals() == [True, True, True]
    assert bench.backend.alerts == {"j1": ("overheating",)}
    assert bench.backend.lost_joints == {}


@every_make
def test_a_shutdown_is_told_from_an_alert_at_once(model: ServoModel) -> None:
    bench = Bench(model)
    bench.cycles(3)
    bench.wires["body"].error[2] = 0x80 if model is XM else 0x04
    if model is XM:
        bench.put(2, "hardware_error", 0x04)
    bench.put(2, family_of(model.name).shutdown, 0x24)
    bench.put(2, "torque_limit" if model in (AX, MX) else "torque_enable", 0)
    assert bench.gets_goals() == [True, False, True]
    assert str(bench.backend.lost_joints["j1"]) == "its servo shut down: overheating"


@every_make
def test_it_gets_goals_again_once_it_is_armed_again_from_where_it_is(model: ServoModel) -> None:
    bench = Bench(model)
    bench.silence(MISSES)
    bench.restart(2)
    bench.cycles(1)
    bench.backend.set_torque(False)
    with pytest.raises(HardwareError, match=r"j1 lost torque after arming; .*; torque is off"):
        bench.backend.set_torque(True)
    bench.put(2, "present_position", model.middle + 3)
    assert bench.backend.rearm().all_on
    assert bench.goal(2) == model.middle + 3 and bench.backend.lost_joints == {}
    assert bench.gets_goals() == [True, True, True]


def test_a_broken_frame_with_a_good_checksum_takes_no_torque_away() -> None:
    bench = Bench(STS)
    bench.cycles(3)
    lies = [b"\0" * 10]

    def spoil(id: int, frame: bytes) -> bytes:
        if id == 2 and lies and len(frame) == 16:  # the torque registers that are read back
            data = frame[:5] + lies.pop()
            return data + bytes([~sum(data[2:]) & 0xFF])
        return frame

    bench.wires["body"].spoil = spoil
    bench.silence(MISSES)
    assert bench.gets_goals() == [True, True, True]
    assert not lies and bench.backend.lost_joints == {}


def test_a_joint_without_a_goal_has_no_stiffness() -> None:
    bench = Bench(STS)
    bench.wires["body"].silent.add(2)
    bench.cycles(MISSES)
    real = bench.backend.write(JointCommand.hold(bench.backend.joints, np.zeros(3)))
    assert (real.stiffness > 0.0).tolist() == [True, False, True]
