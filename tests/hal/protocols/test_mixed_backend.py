"""`ServoBackend` on Feetech and protocol 1, alone and mixed; X alone is in test_servo_backend."""

from math import pi

import numpy as np
import pytest

from tests.hal.fake_bus1 import AX, MX, SCS, STS
from tests.hal.mixed_robot import Wires, mount, robot, ticks
from windup.hal.command import JointCommand
from windup.hal.errors import ConfigError, HardwareError
from windup.hal.families import servo_model
from windup.hal.protocols.protocol1 import Instruction
from windup.hal.servo_bus.coupling import Coupling
from windup.hal.servos.servo_model import ServoModel

XM = servo_model("XM430-W350")
STS12 = servo_model("STS3215-12V")
FAMILIES = [STS, SCS, AX, MX]
names = [model.name for model in FAMILIES]


def wire(models: dict[int, ServoModel]) -> Wires:
    wires = Wires()
    wires.add("body", models)
    return wires


@pytest.mark.parametrize("model", FAMILIES, ids=names)
def test_counts_become_si_and_goals_become_counts(model: ServoModel) -> None:
    wires = wire({1: model, 2: model})
    backend = robot(wires, [mount(model, "body", 1), mount(model, "body", 2, sign=-1)])
    backend.connect()
    backend.configure()
    for id in (1, 2):
        wires["body"].set(id, "present_position", model.middle + 5)
        wires["body"].set(id, "present_velocity", -7)
    state = backend.read().joints
    count = 2 * pi / model.counts_per_rev
    assert state.position == pytest.approx([5 * count, -5 * count])
    unit = backend.readouts[0].bus.family.table(model.name)["present_velocity"].unit
    assert state.velocity == pytest.approx([-7 * unit, 7 * unit])
    assert np.isnan(state.torque).all() and state.age.tolist() == [0.0, 0.0]
    assert state.voltage == pytest.approx([7.4] * 2) and state.temperature.tolist() == [35.0] * 2
    assert backend.set_torque(True).all_on
    backend.write(JointCommand.hold(backend.joints, np.full(2, 0.5)))
    goals = [wires["body"].show(id, "goal_position") for id in (1, 2)]
    assert goals == [model.middle + s * round(0.5 / count) for s in (1, -1)]
    assert backend.set_torque(False).all_off


@pytest.mark.parametrize("model", FAMILIES, ids=names)
def test_what_configure_asserts_is_found_asserted_the_second_time(model: ServoModel) -> None:
    wires = wire({1: model})
    backend = robot(wires, [mount(model, "body", 1)])
    backend.connect()
    backend.configure()
    assert wires["body"].show(1, "return_delay") == 0
    wires["body"].written.clear()
    backend.configure()
    assert wires["body"].written == []


def test_the_phase_is_set_bit_by_bit() -> None:
    wires = wire({1: STS})
    wires["body"].set(1, "phase", 0b1001_1001)
    backend = robot(wires, [mount(STS, "body", 1)])
    backend.connect()
    backend.configure()
    assert wires["body"].show(1, "phase") == 0b1000_1101


def test_sts_torque_comes_from_current_where_the_data_sheet_has_a_constant() -> None:
    wires = wire({1: STS12})
    wires["body"].set(1, "present_current", -100)
    backend = robot(wires, [mount(STS12, "body", 1)], supply=12.0)
    backend.connect()
    backend.configure()
    constant = STS12.torque_constant
    assert constant is not None
    assert backend.read().joints.torque[0] == pytest.approx(-0.65 * constant)


def test_a_linkage_slows_the_joint_and_strengthens_it_by_its_ratio() -> None:
    wires = wire({1: STS12, 2: STS12})
    mounts = [mount(STS12, "body", 1), mount(STS12, "body", 2, sign=-1, ratio=2.0)]
    backend = robot(wires, mounts, supply=12.0)
    backend.connect()
    backend.configure()
    for id in (1, 2):
        wires["body"].set(id, "present_velocity", 40)
        wires["body"].set(id, "present_current", 100)
    state = backend.read().joints
    assert state.velocity[0] > 0.0 and state.torque[0] > 0.0
    assert state.velocity[1] == pytest.approx(-state.velocity[0] / 2.0)
    assert state.torque[1] == pytest.approx(-2.0 * state.torque[0])


def test_an_ax_has_its_stiffness_in_slopes_of_powers_of_two() -> None:
    wires = wire({1: AX, 2: MX})
    backend = robot(wires, [mount(AX, "body", 1), mount(MX, "body", 2)], supply=12.0)
    backend.connect()
    backend.configure()
    stiffness = np.array([AX.stiffness(60, 12.0), MX.stiffness(60, 12.0)])
    command = JointCommand.of(backend.joints, position=0.0, stiffness=stiffness)
    real = backend.write(command)
    assert wires["body"].show(1, "compliance_slopes") == 16 * 257
    assert wires["body"].show(2, "position_p_gain") == 60
    assert real.stiffness == pytest.approx([AX.stiffness(64, 12.0), MX.stiffness(60, 12.0)])


def test_feed_forward_counts_on_the_stiffness_that_the_slopes_really_make() -> None:
    wires = wire({1: AX})
    backend = robot(wires, [mount(AX, "body", 1)], supply=12.0)
    backend.connect()
    backend.configure()
    backend.set_torque(True)
    stiffness = AX.stiffness(50, 12.0)  # the next slope makes 64 of it
    command = JointCommand.of(backend.joints, position=0.0, torque=0.3, stiffness=stiffness)
    real = backend.write(command)
    assert real.stiffness[0] == pytest.approx(AX.stiffness(64, 12.0))
    count = 2 * pi / AX.counts_per_rev
    assert real.position[0] == pytest.approx(0.3 / real.stiffness[0], abs=count / 2)


@pytest.mark.parametrize("model", FAMILIES, ids=names)
def test_no_goal_is_sent_before_torque_is_on_since_a_goal_may_switch_it_on(
    model: ServoModel,
) -> None:
    wires = wire({1: model})
    backend = robot(wires, [mount(model, "body", 1)])
    backend.connect()
    backend.configure()
    wires["body"].set(1, "goal_position", 3)
    backend.write(JointCommand.hold(backend.joints, np.zeros(1)))
    assert wires["body"].show(1, "goal_position") == 3
    assert backend.clamps["unarmed"] == 1
    backend.set_torque(True)
    assert wires["body"].show(1, "goal_position") == model.middle


@pytest.mark.parametrize("model", FAMILIES, ids=names)
def test_an_error_in_the_answers_is_told_by_joint_name_while_it_lasts(model: ServoModel) -> None:
    wires = wire({1: model, 2: model})
    backend = robot(wires, [mount(model, "body", id) for id in (1, 2)])
    backend.connect()
    backend.configure()
    wires["body"].error[2] = 0x24
    backend.read()
    assert backend.alerts == {"j1": ("overheating", "overload")}
    wires["body"].error[2] = 0
    backend.read()
    assert backend.alerts == {}


def test_a_missing_mx_silences_those_behind_it_for_one_cycle_only() -> None:
    wires = wire(dict.fromkeys([1, 2, 3], MX))
    backend = robot(wires, [mount(MX, "body", id) for id in (1, 2, 3)])
    backend.connect()
    backend.configure()
    wires["body"].requests.clear()
    backend.read()
    assert [request[4] for request in wires["body"].requests] == [Instruction.BULK_READ]
    wires["body"].silent.add(1)
    ticks(backend, 30)
    age = backend.read().joints.age
    assert age[0] > 0.2 and age[1:].max() < 2e-3
    wires["body"].silent.clear()
    ticks(backend, 2)
    wires["body"].requests.clear()
    backend.read()
    assert [request[4] for request in wires["body"].requests] == [Instruction.BULK_READ]


def test_voltage_and_temperature_come_along_every_so_often() -> None:
    wires = wire({1: STS, 2: STS})
    backend = robot(wires, [mount(STS, "body", id) for id in (1, 2)])
    backend.connect()
    backend.configure()
    for id in (1, 2):
        wires["body"].set(id, "present_voltage", 60 + id)
        wires["body"].set(id, "present_temperature", 40 + id)
    ticks(backend, 10)
    state = backend.read().joints
    assert state.voltage == pytest.approx([6.1, 6.2]) and state.temperature.tolist() == [41, 42]


def test_a_wrong_model_and_a_torque_that_is_on_are_named_and_nothing_is_written() -> None:
    wires = wire({1: servo_model("STS3250"), 2: STS})
    wires["body"].set(2, "torque_enable", 1)
    backend = robot(wires, [mount(STS, "body", 1), mount(STS, "body", 2)])
    backend.connect()
    with pytest.raises(HardwareError) as caught:
        backend.configure()
    assert "id 1: is a STS3250 where a STS3215-7.4V should be" in str(caught.value)
    said = "id 2: cannot correct return_delay 250 instead of 0"
    assert said in str(caught.value)
    assert wires["body"].written == []


def test_two_families_on_one_bus_are_refused() -> None:
    with pytest.raises(ConfigError, match="a SCS0009 is Feetech SCS, the other servos on bus"):
        robot(wire({}), [mount(STS, "body", 1), mount(SCS, "body", 2)])


def mixed() -> tuple[Wires, list[ServoModel]]:
    wires = Wires()
    models = [STS, XM, SCS, AX]
    wires.add("legs", {1: STS, 2: STS})
    wires.add("arms", {1: XM}, protocol=2)
    wires.add("head", {1: SCS})
    wires.add("tail", {1: AX})
    return wires, models


def test_four_makes_move_in_one_robot_with_a_linkage_ratio() -> None:
    wires, _ = mixed()
    mounts = [
        mount(SCS, "head", 1),
        mount(STS, "legs", 2, sign=-1, ratio=2.0),
        mount(XM, "arms", 1),
        mount(AX, "tail", 1),
        mount(STS, "legs", 1),
    ]
    backend = robot(wires, mounts, reach=0.5, supply=12.0)
    backend.connect()
    backend.configure()
    assert backend.set_torque(True).all_on
    wires["legs"].set(2, "present_position", 2048 + 60)
    wires["head"].set(1, "present_position", 520)
    state = backend.read().joints
    count = 2 * pi / 4096
    assert state.position[[1, 2, 4]] == pytest.approx([-30 * count, 0.0, 0.0])
    assert state.position[0] == pytest.approx(8 * 300 / 1024 * pi / 180)
    backend.write(JointCommand.hold(backend.joints, np.full(5, 0.1)))
    assert wires["head"].show(1, "goal_position") == 512 + round(0.1 * 1228.8 / 2 / pi)
    assert wires["legs"].show(2, "goal_position") == 2048 - round(0.2 / count)
    assert wires["arms"].get(1, 116, 4) == 2048 + round(0.1 / count)
    wires["legs"].silent.add(1)
    ticks(backend, 5)
    assert np.flatnonzero(backend.read().joints.age > 0.02).tolist() == [4]


def test_two_servos_move_two_joints_together() -> None:
    wires = wire({1: STS, 2: STS})
    ankle = Coupling("j0", "j1", ((1.0, 1.0), (1.0, -1.0)))
    backend = robot(wires, [mount(STS, "body", id) for id in (1, 2)], couplings=[ankle])
    backend.connect()
    backend.configure()
    backend.set_torque(True)
    command = JointCommand.hold(backend.joints, np.array([0.3, 0.1]))
    real = backend.write(command)
    count = 2 * pi / 4096
    goals = [wires["body"].show(id, "goal_position") for id in (1, 2)]
    assert goals == [2048 + round(0.4 / count), 2048 + round(0.2 / count)]
    assert real.position == pytest.approx([0.3, 0.1], abs=count)
    # Both servos carry each joint: half the stiffness at each makes the whole at the joint.
    assert wires["body"].show(1, "position_p_gain") == 10
    assert real.stiffness == pytest.approx(command.stiffness, rel=1e-6)
    wires["body"].set(1, "present_position", 2048 + 30)
    wires["body"].set(2, "present_position", 2048 + 10)
    assert backend.read().joints.position == pytest.approx([20 * count, 10 * count])
    wires["body"].silent.add(1)
    ticks(backend, 5)
    assert (backend.read().joints.age > 0.02).all()


def test_a_coupled_range_past_the_encoder_is_refused() -> None:
    ankle = Coupling("j0", "j1", ((1.0, 1.0), (1.0, -1.0)))
    wires = wire({1: STS, 2: STS})
    mounts = [mount(STS, "body", id) for id in (1, 2)]
    with pytest.raises(ConfigError, match=r"joint 'j0'.*its range is -560 to 4656 counts"):
        robot(wires, mounts, reach=2.0, couplings=[ankle])
