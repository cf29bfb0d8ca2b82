"""What a walk was like: the numbers of `windup walk --json`."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from windup.control.limit_cycle.balancer import Balancer
from windup.control.limit_cycle.planner import StepPlanner
from windup.control.steering.navigation import PathFollower, PointFollower
from windup.hal.controller import Stopwatch
from windup.hal.joints import Array
from windup.hal.observation import Observation
from windup.sim_twin.ground.clearance import FootClearance
from windup.tools.assembly.walk_options import WalkOptions
from windup.tools.measures.gauges import Gauges
from windup.tools.measures.walk_text import format_walk
from windup.tools.reports.run_data import Results, RunData
from windup.tools.reports.run_report import RunReport
from windup.tools.robot.session import Session

if TYPE_CHECKING:
    from windup.control.stepping.supervisor import Supervisor

SETTLED = 10  # steps left out of the mean speed


@dataclass
class WalkReport(Results):
    """A walk, finished or broken off.

    Attributes:
        robot: The session of the robot that walked.
        walker: Its controller, with a record of each step.
        options: What was asked for.
        requested: Steps asked for.
        rollouts: Counts the rollouts, and their time.
        seed: Seed of everything random.
        gauges: What is measured at every tick.
        feet: How close the feet of a twin come; None on a port.
        supervisor: Who has the robot; None where nothing is to catch it.
        loop: How its loop went.
    """

    robot: Session
    walker: Balancer
    options: WalkOptions
    requested: int
    rollouts: Stopwatch
    seed: int
    gauges: Gauges
    feet: FootClearance | None = None
    supervisor: "Supervisor | None" = None
    loop: RunReport = field(default_factory=RunReport)

    def __post_init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Measure ways from where the robot is now."""
        self._origin = self._end = self._position()

    def note_place(self) -> None:
        """Note how far the robot has come by now: once it is limp, it falls anywhere."""
        self._end = self._position()

    def update(self, observation: Observation) -> None:
        """Measure what there is to measure at a tick."""
        self.note_place()
        self.gauges.update(observation)
        if self.feet is not None:
            self.feet.update()

    def __str__(self) -> str:
        return format_walk(self.result())

    @property
    def fell(self) -> bool:
        """True when the robot has fallen."""
        return self.loop.reason == "fell"

    @property
    def fallen(self) -> bool:
        """True when the robot lay at the end, also after a stand that followed the walk."""
        return self.loop.fallen

    @property
    def data(self) -> RunData:
        """The arrays of the walk with the names of their columns.

        Raises:
            UsageError: The walk was not recorded.
        """
        return self.loop.data

    @property
    def done(self) -> bool:
        """True when the goal was reached, or all steps were walked."""
        return self.loop.reason == "done"

    @property
    def path(self) -> Array:
        """Base positions (steps, 3) at the ends of the steps, m."""
        return np.array([record.position for record in self.walker.records]).reshape(-1, 3)

    @property
    def speed(self) -> float | None:
        """Mean speed along the path over steps 11 to the end, m/s; None for a shorter walk."""
        return self._mean("speed")

    @property
    def side(self) -> float | None:
        """Mean speed to the left of the path over whole strides from step 11 on, m/s."""
        return self._mean("side", whole_strides=True)

    @property
    def turn(self) -> float | None:
        """Mean turn rate over whole strides from step 11 on, rad/s."""
        records = self.walker.records[SETTLED:]
        records = records[(len(records) + 1) % 2 :]
        if len(records) < 3:
            return None
        return (records[-1].heading - records[0].heading) / (records[-1].time - records[0].time)

    @property
    def counters(self) -> dict[str, int]:
        """How often the step model was sampled, used again, retried and so on."""
        planner = self.walker.planner
        return dict(planner.model.counters) if isinstance(planner, StepPlanner) else {}

    @property
    def clearance(self) -> float | None:
        """Smallest distance between the feet, mm; negative where they crossed."""
        return None if self.feet is None else 1e3 * self.feet.smallest

    def motion(self) -> dict[str, Any]:
        """Return what was measured at every tick: flights, work, how much the base shook."""
        gauges = self.gauges
        way = float(np.linalg.norm((self._end - self._origin)[:2]))
        return {
            "flights": gauges.flights,
            "flight_time_s": gauges.flight_time,
            "touches": "".join(
                self.robot.description.feet[foot].side[:1] for foot in gauges.touchdowns
            ),
            "skips": gauges.skips,
            "work_j": gauges.work,
            "cost_of_transport": gauges.cost_of_transport(self.walker.state.mass, way),
            "shake_rad_s": gauges.angular_velocity_rms,
        }

    def _mean(self, name: str, *, whole_strides: bool = False) -> float | None:
        """Return the mean over time of a speed in the records, m/s."""
        records = self.walker.records[SETTLED:]
        if whole_strides:
            records = records[len(records) % 2 :]
        if len(records) < 2:
            return None
        ways = [getattr(record, name) * record.duration for record in records]
        return float(sum(ways) / sum(record.duration for record in records))

    def _position(self) -> Array:
        """Return where the base is: the truth on a twin, an estimate on a robot."""
        twin, seen = self.robot.stack.twin, self.robot.base
        base = seen if twin is None else twin.base
        return np.zeros(3) if base is None else base.position.copy()

    def result(self) -> dict[str, Any]:
        """Return the numbers of this walk."""
        robot, walker, loop = self.robot, self.walker, self.loop
        end = self._end - self._origin
        records = walker.records
        slip = walker.steering.slip
        return {
            "robot": robot.description.name,
            "gait": walker.gait.name,
            "seed": self.seed,
            "steps_requested": self.requested,
            "steps": walker.steps,
            "fell": self.fell,
            "fell_at_step": walker.steps + 1 if self.fell else None,
            "reason": loop.reason,
            "distance_m": float(end[0]),
            "lateral_m": float(end[1]),
            "heading_deg": float(np.degrees(records[-1].heading)) if records else 0.0,
            "speed_m_s": self.speed,
            "side_m_s": self.side,
            "turn_deg_s": None if self.turn is None else float(np.degrees(self.turn)),
            "foot_clearance_mm": self.clearance,
            **self.motion(),
            **self.route(),
            "sim_time_s": loop.sim_time,
            "wall_time_s": loop.wall_time,
            "rollouts": self.rollouts.count,
            "rollout_time_s": self.rollouts.seconds,
            "rollouts_a_step": self.rollouts.count / max(walker.begun, 1),
            "replans": walker.replans,
            "catches": self.catches(),
            "slipped": slip is not None and slip.felt,
            "step_model": self.counters,
            "tick_ms": loop.tick_ms(),
            "missed": loop.missed if robot.paced else None,
            "late_plans": walker.late if robot.paced else None,
            "clamps": {name: count for name, count in robot.backend.clamps.items() if count},
            "regulation": self.regulation(),
        }

    def catches(self) -> list[dict[str, Any]]:
        """Return what the stepper was called for."""
        if self.supervisor is None:
            return []
        return [catch.record(self.walker.steps) for catch in self.supervisor.catches]

    def route(self) -> dict[str, Any]:
        """Return whether a goal was reached and how near the corners were passed; or nothing."""
        goal = self.walker.steering.guide
        if not isinstance(goal, PathFollower | PointFollower) or not self.walker.records:
            return {}
        near = goal.passed(self.path[:, :2])
        return {"reached": goal.done, "nearest_m": list(near), "farthest_corner_m": near.max()}

    def regulation(self) -> list[dict[str, Any]]:
        """Return target, mean and standard deviation of each regulation variable."""
        records = self.walker.records
        values = np.array([record.regulation for record in records])
        rows = []
        for column, variable in enumerate(self.walker.regulation):
            row: dict[str, Any] = {"name": variable.name, "unit": variable.unit}
            row["target"] = float(records[-1].target[column]) if records else None
            row["mean"] = float(values[:, column].mean()) if records else None
            row["sd"] = float(values[:, column].std()) if records else None
            rows.append(row)
        return rows


def summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Return what several seeds have in common."""
    speeds = [row["speed_m_s"] for row in rows if row["speed_m_s"] is not None]
    done = [row for row in rows if row["reason"] == "done"]
    headings = [abs(row["heading_deg"]) for row in rows]
    return {
        "runs": len(rows),
        "walked": len(done),
        "speed_mean_m_s": float(np.mean(speeds)) if speeds else None,
        "speed_min_m_s": float(np.min(speeds)) if speeds else None,
        "heading_max_deg": float(np.max(headings)) if headings else None,
        "side_mean_m_s": _mean_of(rows, "side_m_s"),
        "turn_mean_deg_s": _mean_of(rows, "turn_deg_s"),
        "flights_min": min((row["flights"] for row in rows), default=0),
        "cost_of_transport_mean": _mean_of(rows, "cost_of_transport"),
        "foot_clearance_min_mm": min((clear(row) for row in rows), default=None),
        "crossed": sum(clear(row) < 0.0 for row in rows),
        "steps_min": min(row["steps"] for row in rows),
    }


def clear(row: dict[str, Any]) -> float:
    """Return the smallest distance between the feet of a run, mm."""
    value = row.get("foot_clearance_mm")
    return float("inf") if value is None else float(value)


def _mean_of(rows: list[dict[str, Any]], key: str) -> float | None:
    values = [row[key] for row in rows if row.get(key) is not None]
    return float(np.mean(values)) if values else None
