"""Brings a robot up: opens it, starts its broker, and owns it until it goes down."""

import os
from collections.abc import Callable
from typing import Any

from windup.hal.clock import objects_kept
from windup.robots import load_robot
from windup.tools.command_line.version import installed_version
from windup.tools.remote.messages import Welcome
from windup.tools.remote.place import Note, Place, RuntimeLock
from windup.tools.robot.robot import Robot
from windup.tools.runtime.board import Board
from windup.tools.runtime.follow_goals import DEADMAN
from windup.tools.runtime.known_behaviours import import_all
from windup.tools.runtime.owner import Owner
from windup.tools.runtime.start_broker import BrokerProcess


def serve(
    name: str, port: str | None, *, arm: bool, ready: Callable[[], None], **more: Any
) -> None:
    """Own a robot until a client wants it to go down.

    Args:
        name: Name of the robot, or path of its folder.
        port: URL of its bus; None for its twin, in real time.
        arm: Allow torque on a port that is not twin://.
        ready: Called once clients may come.
        **more: Further arguments of `Robot.open`.

    Raises:
        UsageError: The robot is up already, or cannot be.
        HardwareError: Something on the bus is not as it should be, or the broker has died.
        RunInterruptedError: A signal has ended the runtime; the robot has stopped.
    """
    import_all()
    place, version = Place.of(load_robot(name).name), installed_version()
    lock = RuntimeLock(place, Note(os.getpid(), port, version))
    try:
        with Robot.open(name, port=port, arm=arm, realtime=True, **more) as robot:
            board = Board.create(len(robot.joints))
            broker = BrokerProcess(place, board, _welcome(robot, port, version))
            try:
                ready()
                with objects_kept():
                    Owner(robot, board, broker).serve()
                robot.close()  # before the broker ends: clients wait for that
            finally:
                broker.end()
    finally:
        lock.release()


def _welcome(robot: Robot, port: str | None, version: str) -> Welcome:
    return Welcome(
        robot=robot.description.name,
        port=port,
        may_arm=not robot.stack.wired or robot.stack.may_arm,
        pid=os.getpid(),
        version=version,
        joints=robot.joints.names,
        rate_hz=1.0 / robot.period,
        deadman=DEADMAN,
    )
