"""What every backend promises, whatever is behind it; a new one is one more line of BACKENDS."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from tests.contract.bench_robots import ROBOTS
from tests.contract.probing import TICK, free, resolution, wired
from windup.hal.backend import Backend
from windup.hal.command import JointCommand, joint_torque
from windup.hal.errors import UnsafeCommandError
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.robots import load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.twin import Twin

Opener = Callable[[], Backend]
BACKENDS: dict[str, Opener] = {
    "twin of op3": lambda: TwinBackend(Twin(load_robot("op3"))),
    "twin of human": lambda: TwinBackend(Twin(load_robot("human"))),
    "op3 on a Dynamixel wire": lambda: wired("op3"),
    "duck on a Feetech wire": lambda: wired("duck"),
    **ROBOTS,
}


RAMP = 0.6  # rad/s


@pytest.fixture(params=BACKENDS)
def backend(request: pytest.FixtureRequest) -> Iterator[Backend]:
    opened = BACKENDS[request.param]()
    opened.connect()
    opened.configure()
    opened.set_torque(True)
    yield opened
    opened.disconnect()


def wait(backend: Backend, seconds: float) -> None:
    """Let time pass, reading as a loop would."""
    began = backend.clock.now()
    for tick in range(1, round(seconds / TICK) + 1):
        backend.clock.wait_until(began + tick * TICK)
        backend.read()


def arrays(observation: Observation) -> dict[str, Array]:
    joints = observation.joints
    found = {name: getattr(joints, name) for name in type(joints).__dataclass_fields__}
    return {**found, "contacts": observation.contacts}


def test_every_joint_has_a_number_for_everything(backend: Backend) -> None:
    seen, n = backend.read(), len(backend.joints)
    for name, values in arrays(seen).items():
        assert values.dtype == np.float64, name
        # A servo that measures no current has no torque to tell.
        assert np.isfinite(values).all() or name == "torque", name
        if name != "contacts":
            assert values.shape == (n,), name
    assert seen.contacts.ndim == 1
    assert (seen.contacts >= 0.0).all()


def test_imu_and_base_have_their_shapes_where_they_are(backend: Backend) -> None:
    seen = backend.read()
    if (imu := seen.imu) is not None:
        assert imu.angular_velocity.shape == imu.acceleration.shape == (3,)
        assert imu.age >= 0.0
        if imu.orientation is not None:
            assert np.linalg.norm(imu.orientation) == pytest.approx(1.0, abs=1e-3)
    if (base := seen.base) is not None:
        assert base.position.shape == base.linear_velocity.shape == (3,)
        assert base.angular_velocity.shape == (3,)
        assert np.linalg.norm(base.orientation) == pytest.approx(1.0, abs=1e-6)
        assert 0.0 <= base.confidence <= 1.0
    assert not isinstance(backend, TwinBackend) or seen.imu is not None


def test_joints_are_in_order_each_moves_the_one_it_names(backend: Backend) -> None:
    start = backend.read().joints.position
    for name in free(backend):
        j = backend.joints.index(name)
        goal = start.copy()
        goal[j] += 0.2
        backend.write(JointCommand.hold(backend.joints, goal))
        wait(backend, 0.24)
        moved = backend.read().joints.position - start
        assert int(np.argmax(moved)) == j, name
        backend.write(JointCommand.hold(backend.joints, start))
        wait(backend, 0.24)


def test_a_read_after_a_write_is_nearer_to_the_goal(backend: Backend) -> None:
    start = backend.read().joints.position
    goal = np.clip(start + 0.1, backend.joints.lower, backend.joints.upper)
    backend.write(JointCommand.hold(backend.joints, goal))
    wait(backend, 0.08)
    now = backend.read().joints
    moved = (now.position - start) * np.sign(goal - start)
    assert np.mean(moved) > 0.02
    assert np.abs(goal - now.position).sum() < np.abs(goal - start).sum()
    assert np.abs(now.velocity).max() > 0.0


def test_velocity_is_how_fast_the_position_changes(backend: Backend) -> None:
    joints, start, began = backend.joints, backend.read().joints.position, backend.clock.now()
    middle, seen = 0.5 * (joints.lower + joints.upper), []
    ramp = np.where(start < middle, RAMP, -RAMP)
    for tick in range(1, 51):
        backend.write(JointCommand.hold(joints, start + ramp * tick * TICK))
        backend.clock.wait_until(began + tick * TICK)
        seen.append((backend.clock.now(), backend.read().joints))
    late = seen[20:]
    passed = late[-1][0] - late[0][0]
    travel = late[-1][1].position - late[0][1].position
    mean = np.trapezoid([s.velocity for _, s in late], [t for t, _ in late], axis=0) / passed
    assert np.abs(travel).max() > 0.1
    speed = np.abs(travel) / passed
    slack = 2.0 * resolution(backend) / passed + 0.15 * speed + 0.02
    assert (np.abs(mean - travel / passed) <= slack).all()


def test_torque_that_is_measured_pushes_towards_the_goal(backend: Backend) -> None:
    for name in free(backend):
        j, before = backend.joints.index(name), backend.read().joints
        goal = before.position.copy()
        goal[j] += 0.2
        backend.write(JointCommand.hold(backend.joints, goal))
        wait(backend, 3 * TICK)
        torque = backend.read().joints.torque
        assert np.isfinite(torque[j]) == np.isfinite(before.torque[j]), name
        assert not torque[j] - before.torque[j] <= 0.0, name
        backend.write(JointCommand.hold(backend.joints, before.position))
        wait(backend, 0.24)


def test_a_write_returns_what_the_joints_really_got(backend: Backend) -> None:
    joints, seen = backend.joints, backend.read().joints
    torque = 0.01 * np.minimum(joints.torque, 20.0)
    asked = JointCommand.of(joints, position=seen.position + 0.03, velocity=0.05, torque=torque)
    before = asked.block.copy()
    real = backend.write(asked)
    np.testing.assert_array_equal(asked.block, before)
    assert real.block.shape == asked.block.shape
    assert np.isfinite(real.block).all()
    # Whatever it was turned into, a joint at rest feels the torque that was asked for, but for
    # the rounding of goals to counts and of gains to registers.
    free, still = np.full(len(joints), np.inf), np.zeros(len(joints))
    wanted = joint_torque(asked, seen.position, still, free)
    got = joint_torque(real, seen.position, still, free)
    rounding = real.stiffness * resolution(backend) + 0.01 * np.abs(wanted)
    assert (np.abs(got - wanted) <= rounding).all()
    assert (real.damping >= 0.0).all()


def test_what_was_realised_does_not_change_afterwards(backend: Backend) -> None:
    start = backend.read().joints.position
    first = backend.write(JointCommand.hold(backend.joints, start))
    kept = first.block.copy()
    backend.write(JointCommand.hold(backend.joints, start + 0.1))
    np.testing.assert_array_equal(first.block, kept)


def test_torque_that_is_switched_is_read_back(backend: Backend) -> None:
    n = len(backend.joints)
    off = backend.set_torque(False)
    for mask in (off.on, off.unknown, off.off):
        assert mask.shape == (n,)
        assert mask.dtype == np.bool_
    assert off.all_off
    assert backend.set_torque(True).all_on


def test_joints_without_torque_do_not_go_where_they_are_told(backend: Backend) -> None:
    start = backend.read().joints.position
    backend.set_torque(False)
    backend.write(JointCommand.hold(backend.joints, start - 0.3))
    wait(backend, 0.4)
    seen = backend.read().joints
    assert np.abs(start - 0.3 - seen.position).max() > 0.2
    assert not (np.abs(seen.torque) >= 0.05).any()


def test_states_are_fresh_and_their_age_is_known(backend: Backend) -> None:
    wait(backend, 0.08)
    age = backend.read().joints.age
    assert (age >= 0.0).all()
    assert age.max() < 0.05
    assert backend.read().time == pytest.approx(backend.clock.now(), abs=0.05)


def test_time_passes_by_the_clock_alone(backend: Backend) -> None:
    before = backend.clock.now()
    backend.clock.wait_until(before + 10 * TICK)
    assert backend.clock.now() == pytest.approx(before + 10 * TICK, abs=1e-4)
    backend.clock.wait_until(before)
    assert backend.clock.now() >= before + 10 * TICK - 1e-4, "time does not go back"


def test_observations_are_dated_and_later_ones_are_later(backend: Backend) -> None:
    times = []
    for _ in range(5):
        times.append(backend.read().time)
        backend.clock.wait_until(backend.clock.now() + TICK)
    assert (np.diff(times) > 0.5 * TICK).all()


def test_request_and_collect_are_a_read(backend: Backend) -> None:
    wait(backend, 0.5)
    whole = backend.read()
    backend.request()
    halves = backend.collect()
    exact = isinstance(backend, TwinBackend)  # elsewhere a read takes time of its own
    for name, values in arrays(whole).items():
        if name == "health_age":  # it is another servo's turn in the second read
            assert (arrays(halves)[name] <= values + 0.05).all()
            continue
        close = 0.0 if exact else 0.05
        np.testing.assert_allclose(arrays(halves)[name], values, atol=close, err_msg=name)
    assert halves.time >= whole.time


def test_an_observation_is_not_changed_by_the_next(backend: Backend) -> None:
    first = backend.read()
    kept = {name: values.copy() for name, values in arrays(first).items()}
    backend.write(JointCommand.hold(backend.joints, first.joints.position + 0.2))
    wait(backend, 0.2)
    for name, values in arrays(first).items():
        np.testing.assert_array_equal(values, kept[name], err_msg=name)


@pytest.mark.parametrize("extra", [-1, 1])
def test_a_guard_before_it_refuses_what_has_another_shape(backend: Backend, extra: int) -> None:
    guard = GuardedBackend(backend, SafetyLimits.of(backend.joints))
    before = backend.read().joints.position
    n = len(backend.joints)
    with pytest.raises(UnsafeCommandError) as error:
        guard.write(JointCommand(np.ones((5, n + extra))))
    assert str(error.value) == (
        f"a command of shape (5, {n + extra}) for {n} joints; its shape has to be (5, {n})"
    )
    np.testing.assert_allclose(backend.read().joints.position, before, atol=0.01)


def test_a_guard_before_it_stops_it(backend: Backend) -> None:
    guard = GuardedBackend(backend, SafetyLimits.of(backend.joints), "limp")
    guard.read()
    assert guard.stop().all_off
    guard.stop_policy = "hold"
    backend.set_torque(True)
    assert guard.stop().all_on
