"""The wire in front of the MuJoCo twin of the OP3."""

import math
from collections.abc import Iterator

import mujoco
import numpy as np
import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from windup.robots import load_robot
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire.protocols.frames import encode
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.shafts.twin_shaft import TwinPhysics, TwinShaft

IDS = tuple(range(1, 21))
LEFT_KNEE = "l_knee"


@pytest.fixture
def shaft() -> tuple[Twin, TwinShaft, InertiaShaft]:
    robot = load_robot("op3")
    twin = Twin(robot, delay=0.0)
    joint = robot.joints.index(LEFT_KNEE)
    mount = robot.servos[joint]
    assert mount is not None
    bench = InertiaShaft(mount.model.motor(twin.supply), 1.0)
    return twin, TwinShaft(twin, joint, mount), bench


@pytest.mark.parametrize("speed", [0.0, 1.5, -3.0])
@pytest.mark.parametrize(
    ("way", "values"),
    [
        ("hold_goal", (0.3, 18.9, 12.0)),
        ("hold_goal", (3.0, 18.9, 6.0)),  # at its voltage limit
        ("hold_goal", (-3.0, 18.9, 12.0, 1.1)),  # at its current limit
        ("apply_voltage", (7.0,)),
        ("apply_voltage", (-12.0,)),
        ("apply_voltage", (0.0,)),
        ("apply_torque", (1.2, 12.0)),
        ("apply_torque", (-40.0, 9.0)),  # more than its voltage can
        ("release", ()),
    ],
)
def test_a_joint_of_the_twin_makes_the_torque_of_a_bench_motor(
    shaft: tuple[Twin, TwinShaft, InertiaShaft],
    way: str,
    values: tuple[float, ...],
    speed: float,
) -> None:
    twin, joint, bench = shaft
    twin.data.qvel[6 + twin.robot.joints.index(LEFT_KNEE)] = math.copysign(1.0, speed) * abs(speed)
    bench.position, bench.velocity = joint.position, joint.velocity
    for shaft_ in (joint, bench):
        getattr(shaft_, way)(*values)
    mujoco.mj_forward(twin.model, twin.data)
    bench.step(1e-9)
    assert joint.torque == pytest.approx(bench.torque, abs=1e-5)


def test_what_one_way_of_driving_sets_the_next_one_forgets(
    shaft: tuple[Twin, TwinShaft, InertiaShaft],
) -> None:
    twin, joint, _ = shaft
    joint.hold_goal(3.0, 18.9, 12.0, 0.5)
    joint.apply_voltage(12.0)
    mujoco.mj_forward(twin.model, twin.data)
    assert joint.torque == pytest.approx(4.1, rel=1e-6)


@pytest.fixture
def op3() -> Iterator[Host]:
    with open_host("twin://op3?return_delay=0", baud=2_000_000) as host:
        yield host


def switch(host: Host, on: bool, ids: tuple[int, ...] = IDS) -> None:
    body = bytes((64, 0, 1, 0)) + b"".join(bytes((k, on)) for k in ids)
    host.port.write(encode(254, 0x83, body))
    host.wait(0.005)


def twin_of(host: Host) -> Twin:
    (twin,) = host.world.owned
    assert isinstance(twin, Twin)
    return twin


def test_the_robot_is_held_until_its_servos_drive_and_then_stands(op3: Host) -> None:
    twin, physics = twin_of(op3), op3.world.physics
    assert isinstance(physics, TwinPhysics)
    before = twin.data.qpos.copy()
    op3.wait(0.5)
    assert np.array_equal(twin.data.qpos, before)
    switch(op3, True)
    op3.wait(0.01)
    assert not physics.held
    op3.wait(2.0)
    assert not twin.fallen
    switch(op3, False)
    op3.wait(2.0)
    assert twin.fallen


def test_a_joint_that_is_driven_moves_while_the_rest_is_held(op3: Host) -> None:
    before = twin_of(op3).data.qpos.copy()
    switch(op3, True, (19,))
    op3.ask(19, 3, bytes((116, 0, *(2500).to_bytes(4, "little"))))
    op3.wait(2.0)
    pan = 7 + twin_of(op3).robot.joints.index("head_pan")
    moved = np.flatnonzero(np.abs(twin_of(op3).data.qpos - before) > 1e-9)
    assert moved.tolist() == [pan]
    assert op3.read(19, "present_position") == pytest.approx(2500, abs=2)


def test_a_robot_that_hangs_keeps_its_base_whatever_its_servos_do(op3: Host) -> None:
    twin, physics = twin_of(op3), op3.world.physics
    assert isinstance(physics, TwinPhysics)
    twin.data.qpos[2] += 0.2
    physics.store_held_pose()
    physics.stays_held = True
    before = twin.data.qpos[:7].copy()
    switch(op3, True)
    op3.wait(0.5)
    assert physics.held and np.array_equal(twin.data.qpos[:7], before)


def test_a_jammed_joint_does_not_move_and_the_others_do(op3: Host) -> None:
    twin, physics = twin_of(op3), op3.world.physics
    assert isinstance(physics, TwinPhysics)
    joints = twin.robot.joints
    physics.jammed[joints.index("head_pan")] = True
    before = twin.data.qpos.copy()
    switch(op3, True, (19, 20))
    for id in (19, 20):
        op3.ask(id, 3, bytes((116, 0, *(2500).to_bytes(4, "little"))))
    op3.wait(1.0)
    moved = np.abs(twin.data.qpos - before)[7:]
    assert moved[joints.index("head_pan")] == 0.0 and moved[joints.index("head_tilt")] > 0.5


def test_a_motor_that_is_miswired_runs_away_from_its_goal(op3: Host) -> None:
    twin, physics = twin_of(op3), op3.world.physics
    assert isinstance(physics, TwinPhysics)
    pan = twin.robot.joints.index("head_pan")
    (shaft,) = (shaft for shaft in physics.shafts if shaft.joint == pan)
    shaft.miswired = True
    switch(op3, True, (19,))
    op3.ask(19, 3, bytes((116, 0, *(2200).to_bytes(4, "little"))))
    op3.wait(0.3)
    assert twin.data.qpos[7 + pan] < -0.3


def test_servos_report_the_joints_with_their_signs_and_zeros(op3: Host) -> None:
    twin = twin_of(op3)
    for joint, mount in enumerate(twin.robot.servos):
        assert mount is not None
        angle = twin.data.qpos[7 + joint]
        counts = mount.zero + mount.sign * mount.ratio * angle * 4096 / (2.0 * math.pi)
        assert op3.read(mount.id, "present_position") == pytest.approx(counts, abs=0.5)


def test_the_opencr_feels_the_twin(op3: Host) -> None:
    switch(op3, True)
    op3.wait(1.0)
    data = op3.ask(200, 2, bytes((30, 0, 20, 0)))[0].parameters[1:]
    assert data[1] == 120
    values = np.frombuffer(data[2:], "<i2")
    assert values[5] * 2.0 / 32768 == pytest.approx(1.0, abs=0.05)
    assert np.abs(values[6:8]).max() < 100  # 10 degrees


def test_the_same_bytes_come_back_every_time() -> None:
    runs = []
    for _ in range(2):
        with open_host("twin://op3?return_delay=0&faults=drop:0.05", baud=2_000_000) as host:
            switch(host, True)
            runs.append([host.sync_read(126, 10, *IDS) for _ in range(40)])
    assert runs[0] == runs[1]
    assert len({bytes(answer) for answer in runs[0]}) > 1


def test_the_board_may_start_with_the_servo_power_off() -> None:
    with open_host("twin://op3?power=off", baud=2_000_000) as host:
        assert host.ask(1, 1) == []
        host.ask(200, 3, bytes((24, 0, 1)))
        host.wait(0.5)
        assert len(host.ask(1, 1)) == 1
