"""`windup estimate`: how far the estimated base is from the twin's true one."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import perf_counter
from typing import Annotated, Any

import numpy as np
import tyro

from windup.control.kinematics.rotation import heading
from windup.control.loop import Estimator
from windup.hal.errors import UsageError
from windup.hal.geometry.angles import wrapped
from windup.hal.geometry.quaternion import roll_pitch_yaw
from windup.hal.joints import Array
from windup.hal.observation import BaseState, Observation
from windup.robots import load_robot
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.imu_errors import ImuErrors, imu_on_twin
from windup.sim_twin.sensors import Sensors
from windup.sim_twin.twin_state_source import TwinStateSource
from windup.tools.assembly.build import build_estimator, build_walk
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.options.faults import with_faults
from windup.tools.robot.port_urls import TWIN, check_port
from windup.tools.robot.robot import Robot
from windup.tools.terminal.command import Command
from windup.tools.terminal.output import console, write_json
from windup.tools.terminal.quantities import Count, Delay, Impulse, Rate, Seed, Some

ATTITUDE_LIMIT = 1.0  # degrees rms
VELOCITY_LIMIT = 0.03  # m/s rms
SETTLE = 1.0  # s of standing before anything is judged, as on a robot that has been armed
PUSH_EVERY = 1.5  # s
TRIALS = ("stand", "pushed", "walk", "walk pushed")


@dataclass
class Referee:
    """An estimator under test: it never sees the truth, and is judged by it.

    Attributes:
        estimator: The one that is judged.
        truth: Fills in the true base, where observations come without.
        listen: Hand on the true base, so that the robot does not depend on the estimate.
        rows: For each tick: roll, pitch and yaw error, rad; velocity error, m/s (3); height
            error, m; confidence; cost, s.
    """

    estimator: Estimator
    truth: Estimator | None
    listen: bool
    rows: list[Array] = field(default_factory=list)

    def update(self, observation: Observation, dt: float) -> Observation:
        """Estimate, judge, and return what the robot shall go by."""
        seen = observation if self.truth is None else self.truth.update(observation, dt)
        truth = seen.base
        assert truth is not None, "the twin knows"
        began = perf_counter()
        result = self.estimator.update(replace(observation, base=None), dt)
        cost = perf_counter() - began
        assert result.base is not None, "the estimator fills it in"
        self.rows.append(np.append(_errors(result.base, truth), cost))
        return replace(result, base=truth) if self.listen else result

    def begin(self) -> None:
        """Judge from here on."""
        self.rows.clear()

    def verdict(self) -> dict[str, float]:
        """Return the errors since `begin`."""
        rows = np.array(self.rows)
        velocity = np.linalg.norm(rows[:, 3:6], axis=1)
        yaw = np.degrees(np.unwrap(rows[:, 2]))
        return {
            "attitude_rms_deg": _rms(np.degrees(np.linalg.norm(rows[:, :2], axis=1))),
            "attitude_max_deg": float(np.degrees(np.abs(rows[:, :2]).max())),
            "yaw_drift_deg": float(yaw[-1] - yaw[0]),
            "velocity_rms_m_s": _rms(velocity),
            "velocity_max_m_s": float(velocity.max()),
            "height_rms_m": _rms(rows[:, 6]),
            "confidence_min": float(rows[:, 7].min()),
            "tick_p50_ms": float(1e3 * np.median(rows[:, 8])),
        }


@dataclass(frozen=True, kw_only=True)
class Estimate(Command):
    """Measure the estimated state against the twin's truth: standing, pushed, walking, and both.

    Behind a port the truth is that of the tick, so the time that the wire takes counts as error.
    """

    robot: Annotated[str, tyro.conf.Positional]
    """A robot's name (`windup robots` lists them), or the path of a folder with your own."""
    port: str | None = None
    """Emulated servo bus to measure through: twin://ROBOT. Only a twin knows the truth."""
    faults: str = ""
    """What goes wrong on that port, as of `windup walk`."""
    steps: Count = 40
    """How many steps to walk."""
    pushes: Some = 6
    """How many times to push."""
    impulse: Impulse | None = None
    """Impulse of the pushes, N s; by default 0.2 m/s times the robot's mass."""
    switches: bool = True
    """Use the contact sensors; without, and on a port, the soles' heights tell who stands."""
    rate: Rate | None = None
    """Rate of the control loop, Hz; the robot's own by default."""
    delay: Delay | None = None
    """Delay of the servos, s; on a port it is what it is."""
    seed: Seed = 0
    """Seed of pushes, start pose, and of the IMU's noise and bias."""
    json: Path | None = None
    """Write the result as JSON to a file, or to standard output with '-'."""

    def run(self) -> int:
        """Measure; returns the exit status."""
        rows = list(self._trials())
        good = [_good(row) for row in rows]
        write_json(
            self.json,
            "estimate",
            {
                "robot": self.robot,
                "port": self.port,
                "faults": self.faults,
                "seed": self.seed,
                "attitude_limit_deg": ATTITUDE_LIMIT,
                "velocity_limit_m_s": VELOCITY_LIMIT,
                "rows": rows,
                "passed": all(good),
            },
        )
        return 0 if all(good) else 1

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        url, robot = with_faults(self.port, self.faults), load_robot(self.robot)
        build_walk(robot, WalkOptions(), None)
        if url is None or self.port is None:
            return
        if not self.port.startswith(TWIN):
            raise UsageError(f"--port {self.port}: only a twin knows the truth; give {TWIN}ROBOT")
        if self.delay is not None:
            raise UsageError("--delay is that of a twin without a wire; leave it or --port away")
        check_port(robot, url)

    def _trials(self) -> Iterable[dict[str, Any]]:
        """Run every trial under both states; yield a row for each."""
        for trial in TRIALS:
            for listen in (True, False):
                row = self._trial(trial, listen)
                console.print(_line(row))
                yield row

    def _trial(self, trial: str, listen: bool) -> dict[str, Any]:
        with Robot.open(
            self.robot,
            port=with_faults(self.port, self.faults),
            rate=self.rate,
            delay=self.delay,
            seed=self.seed,
            noise=0.2,
        ) as robot:
            referee = self._referee(robot, listen)
            robot.start_at(None)
            robot.stand(SETTLE)
            referee.begin()
            pushed = self._push(robot) if "pushed" in trial else 0.0
            if "walk" in trial:
                robot.walk(steps=self.steps)
            else:
                robot.stand(3.0 + pushed)
            return {
                "trial": trial,
                "state": "true" if listen else "estimated",
                "seconds": robot.loop.sim_time,
                "end": robot.loop.reason,
                **referee.verdict(),
            }

    def _referee(self, robot: Robot, listen: bool) -> Referee:
        """Give the robot real sensors, and an estimator that is judged."""
        estimator = robot.stack.estimator
        if estimator is not None:  # behind a port, where the sensors are real ones already
            referee = Referee(estimator, TwinStateSource(Sensors(robot.twin)), listen)
            robot.stack = replace(robot.stack, estimator=referee)
            return referee
        felt = imu_on_twin(robot.description)
        errors = ImuErrors(felt, robot.twin.timestep, self.seed)
        backend = TwinBackend(robot.twin, imu_errors=errors)
        estimator = build_estimator(robot.description, felt.lag, switches=self.switches)
        referee = Referee(estimator, None, listen)
        guarded = replace(robot.backend, backend=backend)
        robot.stack = replace(robot.stack, backend=guarded, estimator=referee)
        return referee

    def _push(self, robot: Robot) -> float:
        """Order the pushes; return the time that they take, s."""
        random = np.random.default_rng(self.seed)
        body = robot.twin.model.body(robot.description.base).id
        mass = float(robot.twin.model.body_subtreemass[body])
        impulse = 0.2 * mass if self.impulse is None else self.impulse
        for number in range(self.pushes):
            robot.push(
                impulse * random.uniform(0.5, 1.0),
                random.uniform(-np.pi, np.pi),
                duration=random.uniform(0.05, 0.2),
                delay=PUSH_EVERY * (number + 1.0),
            )
        return PUSH_EVERY * (self.pushes + 1.0)


def _errors(base: BaseState, truth: BaseState) -> Array:
    """Return roll, pitch, yaw, velocity (3), height errors and the confidence."""
    angles = np.array([_angles(base.orientation), _angles(truth.orientation)])
    turn = wrapped(angles[0] - angles[1])
    velocity = base.linear_velocity - truth.linear_velocity
    height = base.position[2] - truth.position[2]
    return np.concatenate([turn, velocity, [height, base.confidence]])


def _angles(orientation: Array) -> Array:
    """Return roll, pitch and heading, rad."""
    roll, pitch, _ = roll_pitch_yaw(orientation)
    return np.array([roll, pitch, float(heading(orientation))])


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _good(row: dict[str, Any]) -> bool:
    attitude, velocity = row["attitude_rms_deg"], row["velocity_rms_m_s"]
    return row["end"] == "done" and attitude <= ATTITUDE_LIMIT and velocity <= VELOCITY_LIMIT


def _line(row: dict[str, Any]) -> str:
    mark = "ok  " if _good(row) else "OVER"
    fell = "" if row["end"] == "done" else f", {row['end']}"
    return (
        f"{mark} {row['trial']:11} on {row['state']:9} state: "
        f"attitude {row['attitude_rms_deg']:.2f} degrees rms, "
        f"velocity {100.0 * row['velocity_rms_m_s']:.1f} cm/s rms "
        f"(peak {100.0 * row['velocity_max_m_s']:.0f}), "
        f"height {1e3 * row['height_rms_m']:.1f} mm rms, yaw {row['yaw_drift_deg']:+.1f} degrees "
        f"in {row['seconds']:.0f} s, {1e3 * row['tick_p50_ms']:.0f} us a tick{fell}"
    )
