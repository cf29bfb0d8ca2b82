"""The predictor: rolls a batch policy out on copies of the twin, in several threads.

Rollouts start from an observation, never from the live twin, so the same code runs on a robot. An
observation is as old as the sensor latency. The copies therefore apply the whole latency (sensor
plus command) between command and joint, and their policy reads its state without latency: both
arrangements give the same commands at the same instants of the observed time.
"""

import time as wall
from math import ceil

import mujoco
import numpy as np
import numpy.typing as npt
from mujoco.batch import Batch

from windup.hal.controller import BatchPolicy, Outcomes, Plane, PolicyInput, RolloutStart, Stopwatch
from windup.hal.geometry.up_axis import UP_AXIS
from windup.hal.joints import Array, Mask
from windup.robots.completion import COM_VELOCITY
from windup.robots.description import RobotDescription
from windup.robots.fallen import has_fallen
from windup.sim_twin.environment import Environment, build_model
from windup.sim_twin.ground.foot_level import FootLevel
from windup.sim_twin.ground.terrain import Ground

KNOWN: Plane = (0.0, 0.0, 0.0)
STAGE = int(mujoco.mjtStage.mjSTAGE_VEL)


class RolloutPredictor:
    """Runs rollouts of one robot.

    Args:
        robot: The robot.
        delay: Latency from sensing a state until its command acts, s; by default the robot's own.
        supply: Supply voltage of the servos, V; by default the robot's own.
        threads: Number of threads that share the rollouts.
        ground: The known terrain; by default the ground is taken as flat, at the height of the
            stance foot.

    Attributes:
        delay: Latency from sensing a state until its command acts, s.
    """

    def __init__(
        self,
        robot: RobotDescription,
        *,
        delay: float | None = None,
        supply: float | None = None,
        threads: int = 1,
        ground: Ground | None = None,
    ) -> None:
        self.robot = robot
        self.ground = ground or Ground()
        self._level = FootLevel(robot)
        if delay is None:
            delay = robot.drive.command_delay + robot.drive.sensor_delay
        self.delay = delay
        self.model = build_model(
            robot, delay=delay, supply=supply, bare=True, world=Environment(self.ground)
        )
        self._let_tilt(self.model)
        self.threads = threads
        self.stopwatch = Stopwatch()
        self._worlds: dict[int, _Worlds] = {}

    def predict(self, start: RolloutStart, policy: BatchPolicy, horizon: float) -> Outcomes:
        """Return the outcomes of `policy.size` rollouts of at most `horizon` s."""
        began = wall.perf_counter()
        if policy.size not in self._worlds:
            self._worlds[policy.size] = _Worlds(
                self.robot,
                self.model,
                policy.size,
                min(self.threads, policy.size),
                self.ground,
            )
        outcomes = self._worlds[policy.size].play(start, policy, horizon, self._felt(start))
        self.stopwatch.add(policy.size, wall.perf_counter() - began)
        return outcomes

    def _felt(self, start: RolloutStart) -> Plane:
        """Return the ground plane: zero for known terrain, else that of `start`, else level."""
        if not self.ground.flat:
            return KNOWN
        if start.ground is not None:
            return start.ground
        return self._level.of(start.observation), 0.0, 0.0

    def _let_tilt(self, model: mujoco.MjModel) -> None:
        """Make later rotations of the floor plane effective, which MuJoCo compiled as aligned.

        Otherwise the plane keeps the world's frame, and the midphase searches for contacts there.
        """
        if self.ground.flat:
            model.geom_sameframe[model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE] = 0
            model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_MIDPHASE)


class _Worlds:
    """A batch of m copies of the model (worlds)."""

    def __init__(
        self,
        robot: RobotDescription,
        model: mujoco.MjModel,
        size: int,
        threads: int,
        ground: Ground,
    ) -> None:
        self.robot, self.model, self.size, self.ground = robot, model, size, ground
        self.batch = Batch(model, size, nthread=threads, persistent=True)
        bind = self.batch.bind
        self.qpos, self.qvel = bind("qpos"), bind("qvel")
        self.ctrl, self.time, self.history = bind("ctrl"), bind("time"), bind("history")
        self.sensors, self.com, self.sites = (
            bind("sensordata"),
            bind("subtree_com"),
            bind("site_xpos"),
        )
        self.xmat = bind("xmat")
        self.base = model.body(robot.base).id
        self.torso = model.body(robot.torso).id
        self.soles = np.array([model.site(foot.site).id for foot in robot.feet])
        planes = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE)
        self.floor, self.slope = planes, (0.0, 0.0)
        self.touch = np.array([model.sensor(name).adr[0] for name in robot.contacts.names])
        velocity = model.sensor(COM_VELOCITY).adr[0]
        self.com_velocity = slice(velocity, velocity + 3)
        self.width = model.nu // len(robot.joints)
        self.flight = _Flight(model)
        self.ids = np.arange(size, dtype=np.int32)
        scratch = mujoco.MjData(model)
        spec = mujoco.mjtState.mjSTATE_INTEGRATION
        self.fresh = np.empty(mujoco.mj_stateSize(model, spec))
        mujoco.mj_getState(model, scratch, self.fresh, spec)

    def play(
        self, start: RolloutStart, policy: BatchPolicy, horizon: float, felt: Plane
    ) -> Outcomes:
        """Roll `policy` out on the plane `felt` (height, slopes); see `RolloutPredictor`."""
        self._place(start)
        level = felt[0]
        self._tilt(felt[1:])
        self.qpos[:, 2] -= level
        outcomes = self._run(start, policy, horizon)
        for heights in (outcomes.base_position, outcomes.com, outcomes.feet):
            heights[..., 2] += level
        return outcomes

    def _tilt(self, slope: tuple[float, float]) -> None:
        """Rotate the flat ground to the gradient `slope`."""
        if slope == self.slope or not self.ground.flat:
            return
        self.slope = slope
        normal = np.array([-slope[0], -slope[1], 1.0])
        quat = np.empty(4)
        mujoco.mju_quatZ2Vec(quat, normal / np.linalg.norm(normal))
        self.batch.expand("geom_quat")[:, self.floor] = quat

    def _run(self, start: RolloutStart, policy: BatchPolicy, horizon: float) -> Outcomes:
        substeps = round(start.dt / self.model.opt.timestep)
        view = self._first_view(start)
        result = self._empty()
        alive = np.ones(self.size, dtype=bool)
        ids: npt.NDArray[np.int32] | None = None
        for tick in range(ceil(horizon / start.dt)):
            goals = policy.step(view, start.dt)
            if tick:
                ended = alive & (policy.done | self._fallen())
                if ended.any():
                    self._capture(result, ended, tick * start.dt, policy.done)
                    alive &= ~ended
                    if not alive.any():
                        return result
                    ids = self.ids[alive]
            self.ctrl[:, :: self.width] = goals
            self.batch.step(ids, nstep=substeps, stage=STAGE)
            if not tick:
                view = self._view()
            view.contacts = self.sensors[:, self.touch]
        self._capture(result, alive, horizon, policy.done)
        return result

    def _place(self, start: RolloutStart) -> None:
        """Set every world to the observed state, with the commands in flight."""
        observation = start.observation
        base, joints = observation.base, observation.joints
        assert base is not None, "the balancer has checked"
        self.batch.state[:] = self.fresh
        self.qpos[:, :3] = base.position
        self.qpos[:, 3:7] = base.orientation
        self.qpos[:, 7:] = joints.position
        self.qvel[:, :3] = base.linear_velocity
        self.qvel[:, 3:6] = base.angular_velocity
        self.qvel[:, 6:] = joints.velocity
        if self.model.nhistory:
            self.history[:] = self.flight.history(start)

    def _first_view(self, start: RolloutStart) -> PolicyInput:
        """Return the policy's input before the first step, with the observed contacts."""
        view = self._view()
        view.contacts = np.repeat(start.observation.contacts[None], self.size, axis=0)
        return view

    def _view(self) -> PolicyInput:
        return PolicyInput(
            self.qpos[:, 7:],
            self.qvel[:, 6:],
            self.qpos[:, 3:7],
            self.qvel[:, 3:6],
            self.sensors[:, self.touch],
        )

    def _fallen(self) -> Mask:
        height = self.qpos[:, 2]
        if any(self.slope):
            height = height - self.qpos[:, :2] @ np.array(self.slope)
        elif not self.ground.flat:
            ground = [self.ground.height(float(x), float(y)) for x, y in self.qpos[:, :2]]
            height = height - ground
        up = self.xmat[:, self.torso, UP_AXIS]
        return np.asarray(has_fallen(self.robot.fall, height, up[:, 2]))

    def _empty(self) -> Outcomes:
        m, n = self.size, len(self.robot.joints)
        return Outcomes(
            duration=np.zeros(m),
            base_position=np.zeros((m, 3)),
            base_orientation=np.zeros((m, 4)),
            base_velocity=np.zeros((m, 6)),
            joint_position=np.zeros((m, n)),
            com=np.zeros((m, 3)),
            com_velocity=np.zeros((m, 3)),
            feet=np.zeros((m, len(self.soles), 3)),
            torso=np.zeros((m, 3)),
            contacts=np.zeros((m, len(self.touch))),
            fell=np.zeros(m, dtype=bool),
        )

    def _capture(self, result: Outcomes, rows: Mask, time: float, done: Mask) -> None:
        """Copy the state of the worlds `rows` into `result`."""
        result.duration[rows] = time
        result.base_position[rows] = self.qpos[rows, :3]
        result.base_orientation[rows] = self.qpos[rows, 3:7]
        result.base_velocity[rows] = self.qvel[rows, :6]
        result.joint_position[rows] = self.qpos[rows, 7:]
        result.com[rows] = self.com[rows, self.base]
        result.com_velocity[rows] = self.sensors[rows, self.com_velocity]
        result.feet[rows] = self.sites[rows][:, self.soles]
        result.torso[rows] = self.xmat[rows, self.torso, UP_AXIS]
        result.contacts[rows] = self.sensors[rows][:, self.touch]
        result.fell[rows] = ~done[rows]


class _Flight:
    """Locates the commands in flight (sent but not yet acting) in MuJoCo's history rows.

    A row holds, for each actuator, [user, cursor, n times, n values of each input]. Only the
    values change here, since every rollout begins at time 0.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self.row = mujoco.MjData(model).history.copy()
        samples = model.actuator_history[:, 0] if model.nhistory else np.zeros(model.na)
        self.samples = int(samples[0]) if len(samples) else 0
        width = model.nu // len(model.actuator_historyadr)
        first = model.actuator_historyadr + 2 + self.samples
        # (samples, n): index of each sample's position input
        self.places = first[None, :] + width * np.arange(self.samples)[:, None]

    def history(self, start: RolloutStart) -> Array:
        """Return a history row with the commands in flight of `start`, each held for one tick."""
        row = self.row.copy()
        sent = start.in_flight
        if not len(sent):
            sent = start.observation.joints.position[None]
        step = self.model.opt.timestep
        ages = np.arange(self.samples, 0, -1) * step
        ticks_ago = np.ceil(ages / start.dt - 1e-9).astype(int)
        row[self.places] = sent[np.maximum(len(sent) - ticks_ago, 0)]
        return row
