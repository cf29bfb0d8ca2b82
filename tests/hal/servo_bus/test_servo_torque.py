"""Torque comes on one servo after the other, goes off at once, and somebody hears of it."""

import numpy as np
import pytest

from tests.hal.fake_bus1 import AX, MX, SCS, STS
from tests.hal.mixed_robot import Wires, mount, robot, ticks
from windup.hal.command import JointCommand
from windup.hal.errors import HardwareError
from windup.hal.families import family_of, servo_model
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.hal.servo_bus.servo_torque import INRUSH, OFF_TIME
from windup.hal.servos.servo_model import ServoModel

XM = servo_model("XM430-W350")
MAKES = [XM, STS, SCS, AX, MX]
every_make = pytest.mark.parametrize("model", MAKES, ids=[model.name for model in MAKES])
BEAT = 0.05
"""Longest time without a heartbeat, s."""


def bench(model: ServoModel, servos: int = 4) -> tuple[Wires, ServoBackend]:
    wires, ids = Wires(), range(1, servos + 1)
    wires.add("body", dict.fromkeys(ids, model), 2 if model is XM else 1)
    backend = robot(wires, [mount(model, "body", id) for id in ids])
    backend.connect()
    return wires, backend


def written(wires: Wires, model: ServoModel, name: str) -> list[int]:
    """Return the ids to which a register was written, in the order of the frames."""
    at = family_of(model.name).registers[name].address
    return [id for id, start, _ in wires["body"].written if start == at]


def deaf(wires: Wires, model: ServoModel, deaf_id: int) -> None:
    """Let a servo ignore that its torque is switched on, be it by a goal."""
    at = family_of(model.name).registers["torque_enable"].address
    store = wires["body"]._store

    def ignore(id: int, start: int, data: bytes) -> None:
        if (id, start) != (deaf_id, at):
            store(id, start, data)

    wires["body"]._store = ignore


@every_make
def test_torque_comes_on_one_servo_after_the_other_where_each_is(model: ServoModel) -> None:
    wires, backend = bench(model)
    backend.configure()
    wires["body"].written.clear()
    began = backend.clock.now()
    assert backend.set_torque(True).all_on
    assert written(wires, model, "torque_enable") == [1, 2, 3, 4]
    goals = written(wires, model, "goal_position")
    assert goals[-4:] == [1, 2, 3, 4]
    if family_of(model.name).goal_enables_torque:
        assert len(goals) == 4  # none before its turn
    assert backend.clock.now() - began > 4 * INRUSH


def test_a_goal_is_where_the_servo_is_when_its_turn_comes() -> None:
    wires, backend = bench(STS)
    backend.configure()
    store = wires["body"]._store

    def sag(id: int, start: int, data: bytes) -> None:
        store(id, start, data)
        if (id, start) == (1, 40):  # with the first leg stiff the third one gives way
            wires["body"].set(3, "present_position", 2100)

    wires["body"]._store = sag
    backend.set_torque(True)
    assert [wires["body"].show(id, "goal_position") for id in (1, 3)] == [2048, 2100]


@every_make
def test_if_one_does_not_come_on_all_go_off_and_it_is_named(model: ServoModel) -> None:
    wires, backend = bench(model)
    backend.configure()
    deaf(wires, model, 3)
    with pytest.raises(HardwareError, match=r"torque does not come on at j2 \(id 3\); .* is off$"):
        backend.set_torque(True)
    enable = family_of(model.name).registers["torque_enable"].address
    assert [memory[enable] for memory in wires["body"].memory.values()] == [0] * 4


def test_what_keeps_the_torque_off_is_said() -> None:
    wires, backend = bench(XM)
    backend.configure()
    deaf(wires, XM, 3)
    wires["body"].put(3, 63, 0x34, 1)
    wires["body"].put(3, 70, 0x20, 1)
    said = r"on at j2 \(id 3\): its servo shut down: overload; remove the cause, .*; torque is off$"
    with pytest.raises(HardwareError, match=said):
        backend.set_torque(True)


@every_make
@pytest.mark.parametrize("dead", [1, 10, 20])
def test_a_dead_servo_does_not_keep_the_others_from_going_off(model: ServoModel, dead: int) -> None:
    wires, backend = bench(model, servos=20)
    backend.configure()
    backend.set_torque(True)
    wires["body"].silent.add(dead)
    (link,) = backend.links
    began = backend.clock.now()
    state = link.switch_off()
    assert np.flatnonzero(~state.off).tolist() == [dead - 1]
    assert not state.on.any()
    assert backend.clock.now() - began < OFF_TIME + 0.03
    assert backend.set_torque(False).unknown.sum() == 1


def test_no_bus_waits_for_a_dead_servo_of_another_before_it_is_told_to_go_off() -> None:
    wires = Wires()
    for name in ("left", "right"):
        wires.add(name, {1: STS, 2: STS})
    backend = robot(wires, [mount(STS, name, id) for name in ("left", "right") for id in (1, 2)])
    backend.connect()
    backend.configure()
    backend.set_torque(True)
    wires["left"].silent.add(1)
    left, right = (len(wires[name].requests) for name in ("left", "right"))
    told: list[float] = []
    write = wires["right"].write

    def note(data: bytes) -> int:
        told.append(wires.clock.now())
        return int(write(data))

    wires["right"].write = note
    began = wires.clock.now()
    backend.set_torque(False)
    assert told[0] == began
    assert len(wires["left"].requests) > left and len(wires["right"].requests) > right


def test_a_servo_that_boots_is_waited_for_and_read_as_off() -> None:
    wires, backend = bench(STS)
    backend.configure()
    backend.set_torque(True)
    wires["body"].silent.add(2)
    boots = backend.clock.now() + 0.4

    def boot() -> None:
        if backend.clock.now() > boots:
            wires["body"].silent.clear()

    backend.heartbeat = boot
    assert backend.set_torque(False).all_off


@every_make
def test_there_is_a_heartbeat_at_least_every_50_ms_while_it_takes_long(model: ServoModel) -> None:
    wires, backend = bench(model, servos=20)
    beats: list[float] = []
    backend.heartbeat = lambda: beats.append(backend.clock.now())

    def gap() -> float:
        times = [*beats, backend.clock.now()]
        beats.clear()
        return max(np.diff(times))

    beats.append(backend.clock.now())
    backend.configure()
    assert gap() < BEAT
    beats.append(backend.clock.now())
    backend.set_torque(True)
    assert gap() < BEAT
    wires["body"].silent.add(7)
    beats.append(backend.clock.now())
    backend.set_torque(False)
    assert gap() < BEAT


@every_make
def test_reading_and_commanding_are_the_loops_own_signs_of_life(model: ServoModel) -> None:
    wires, backend = bench(model)
    backend.configure()
    backend.set_torque(True)
    beats: list[int] = []
    backend.heartbeat = lambda: beats.append(1)
    wires["body"].silent.add(2)
    ticks(backend, 10)
    wires["body"].silent.clear()
    ticks(backend, 10)  # and read back
    backend.write(JointCommand.hold(backend.joints, np.zeros(4)))
    assert beats == []
