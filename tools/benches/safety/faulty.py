"""Faults of a program in the middle of a run: in its controller, or in the driver of its IMU."""

import ctypes
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.controller import Controller
from windup.hal.observation import ImuState, Observation
from windup.hal.servo_bus.bus_connection import BusConnection
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.tools.benches.safety.fault_timer import FaultTimer
from windup.tools.robot.robot import Robot

Fault = Callable[[JointCommand], JointCommand]


class FaultyController:
    """A controller that becomes faulty at some time.

    Args:
        controller: The controller that it wraps.
        fault: Replaces the commands from then on.
        begin: Determines when that is.
    """

    def __init__(self, controller: Controller, fault: Fault, begin: FaultTimer) -> None:
        self._controller, self._fault, self._begin = controller, fault, begin

    def __getattr__(self, name: str) -> Any:
        return getattr(self._controller, name)

    def reset(self, observation: Observation) -> None:
        """See `Controller`."""
        self._controller.reset(observation)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """See `Controller`."""
        command = self._controller.step(observation, dt)
        return self._fault(command) if self._begin.due() else command


def _raises(command: JointCommand) -> JointCommand:
    raise ZeroDivisionError("a bug of the controller's own")


def _not_a_number(command: JointCommand) -> JointCommand:
    return JointCommand(np.full_like(command.block, np.nan))


def _wrong_shape(command: JointCommand) -> JointCommand:
    return JointCommand(command.block[:, :-1].copy())


def _blocks_a_while(command: JointCommand) -> JointCommand:
    time.sleep(0.3)
    return command


def _blocks(command: JointCommand) -> JointCommand:
    threading.Event().wait()
    return command


def _blocks_in_c(command: JointCommand) -> JointCommand:
    ctypes.PyDLL(None).pause()  # without releasing the global interpreter lock
    return command


def _spins(command: JointCommand) -> JointCommand:
    while True:
        pass


FAULTS: dict[str, Fault] = {
    "raises": _raises,
    "nan": _not_a_number,
    "wrong shape": _wrong_shape,
    "blocks 0.3 s": _blocks_a_while,
    "blocks": _blocks,
    "blocks in C": _blocks_in_c,
    "spins": _spins,
}


def make_faulty(robot: Robot, fault: Fault, begin: FaultTimer) -> None:
    """Make every controller of a robot faulty when the fault is due."""
    run = robot.run
    robot.run = lambda controller, *given, **more: run(  # type: ignore[method-assign]
        FaultyController(controller, fault, begin), *given, **more
    )


def break_imu(robot: Robot, begin: FaultTimer) -> None:
    """Make the IMU's driver return NaN when the fault is due."""
    servos = robot.backend.backend
    assert isinstance(servos, ServoBackend)
    readings = servos.readings
    state = readings.imu_state

    def broken(now: float, links: Sequence[BusConnection]) -> ImuState | None:
        seen = state(now, links)
        nothing = np.full(3, np.nan)
        if seen is None or not begin.due():
            return seen
        return replace(seen, angular_velocity=nothing, acceleration=nothing)

    readings.imu_state = broken  # type: ignore[method-assign]
