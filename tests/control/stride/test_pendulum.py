"""The planner of the inverted pendulum, against the pendulum itself."""

import numpy as np
import pytest

from windup.control.kinematics.places import seen_from
from windup.control.stride.pendulum import (
    PressureSegment,
    StepTiming,
    VelocityCommand,
    capture_on_way,
    future,
    next_place,
)
from windup.hal.joints import Array

PACE = StepTiming(
    single=0.35, double=0.1, width=0.12, longest=0.1, narrowest=0.09, widest=0.2, turn=0.3
)
OMEGA = 6.3
LEFT, RIGHT = np.array([0.0, 0.06, 0.0]), np.array([0.0, -0.06, 0.0])


def swing(way: list[PressureSegment], place: Array, point: Array) -> tuple[Array, Array]:
    """Let the weight and the capture point of a pendulum go along a way of the pressure."""
    dt = 1e-3
    for stretch in way:
        for tick in range(round(stretch.duration / dt)):
            pressure = stretch.pressure((tick + 0.5) * dt)
            place = place + (point - place) * (1.0 - np.exp(-OMEGA * dt))
            point = pressure + (point - pressure) * np.exp(OMEGA * dt)
    return place, point


def walk(order: VelocityCommand, steps: int) -> tuple[list[Array], list[PressureSegment]]:
    """Return where the feet go, and the way of the pressure, from a swing of the left foot on."""
    landing = next_place(RIGHT, 0, order, PACE)
    ahead = future(RIGHT, 0, landing, order, PACE, steps)
    return [landing], [PressureSegment(RIGHT[:2], RIGHT[:2], PACE.single), *ahead]


@pytest.mark.parametrize("heading", [0.0, 0.5 * np.pi, -2.5])
def test_a_pendulum_that_begins_with_the_planned_capture_point_comes_to_rest(
    heading: float,
) -> None:
    _, way = walk(VelocityCommand(0.1, heading, heading), 2)
    start = np.array([0.0, -0.02])
    place, point = swing(way, start, capture_on_way(way, OMEGA, 0.0))
    assert point == pytest.approx(way[-1].end, abs=2e-3)
    assert place == pytest.approx(way[-1].end, abs=0.015)  # it is about to get there
    _, astray = swing(way, start, capture_on_way(way, OMEGA, 0.0) + 0.001)
    assert np.linalg.norm(astray - way[-1].end) > 1.0


def test_the_capture_point_moves_as_a_pendulum_has_it() -> None:
    _, way = walk(VelocityCommand(0.1), 3)
    for time, stretch in ((0.1, way[0]), (0.3, way[0])):
        now, soon = (capture_on_way(way, OMEGA, time + more) for more in (0.0, 1e-5))
        assert (soon - now) / 1e-5 == pytest.approx(
            OMEGA * (now - stretch.pressure(time)), rel=1e-3, abs=1e-4
        )


def test_who_stands_has_its_capture_point_over_the_pressure() -> None:
    middle = np.array([0.1, 0.2])
    assert capture_on_way([PressureSegment(middle, middle, 1.0)], OMEGA, 0.3) == pytest.approx(
        middle
    )


def test_two_steps_carry_the_body_by_two_periods_of_its_speed() -> None:
    order = VelocityCommand(0.1, 0.6)
    left = next_place(RIGHT, 0, order, PACE)
    right = next_place(left, 1, order, PACE)
    way = 2.0 * 0.1 * PACE.period * np.array([np.cos(0.6), np.sin(0.6)])
    assert right[:2] - RIGHT[:2] == pytest.approx(way)
    assert next_place(RIGHT, 0, VelocityCommand(), PACE) == pytest.approx(LEFT)


def test_a_foot_goes_no_farther_than_it_reaches_and_crosses_nothing() -> None:
    far = next_place(RIGHT, 0, VelocityCommand(3.0, 0.0), PACE)
    assert far[:2] == pytest.approx([0.1, 0.06])
    inward = next_place(RIGHT, 0, VelocityCommand(3.0, -0.5 * np.pi), PACE)
    assert inward[1] - RIGHT[1] == pytest.approx(0.09)
    outward = next_place(RIGHT, 0, VelocityCommand(3.0, 0.5 * np.pi), PACE)
    assert outward[1] - RIGHT[1] == pytest.approx(0.2)


def test_the_outer_foot_turns_first_and_the_other_one_follows() -> None:
    order = VelocityCommand(0.0, 0.0, 0.5)
    left = next_place(RIGHT, 0, order, PACE)
    assert left[2] == pytest.approx(0.3)
    right = next_place(left, 1, order, PACE)
    assert right[2] == pytest.approx(left[2])
    assert seen_from(left, right)[:2] == pytest.approx([0.0, -0.12])
    assert next_place(right, 0, order, PACE)[2] == pytest.approx(0.5)
    assert next_place(LEFT, 1, order, PACE)[2] == pytest.approx(0.0)
