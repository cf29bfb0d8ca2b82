"""The MuJoCo twin of a robot: a world with one robot on a floor."""

from collections.abc import Callable
from dataclasses import dataclass
from math import radians

import mujoco
import numpy as np

from windup.hal.errors import DivergedError, UnknownNameError, UsageError
from windup.hal.geometry.up_axis import UP_AXIS
from windup.hal.joints import Array
from windup.hal.observation import BaseState
from windup.robots.couplings import satisfy_couplings
from windup.robots.description import RobotDescription
from windup.robots.fallen import has_fallen
from windup.sim_twin.environment import Environment, build_model
from windup.sim_twin.joint_indices import JointIndices
from windup.sim_twin.lowest import lowest_point
from windup.sim_twin.push import Push
from windup.sim_twin.runaway import WILD, fastest_dof

STATE = mujoco.mjtState.mjSTATE_INTEGRATION
LOST = 1e6  # sum of positions that only a diverged simulation reaches


@dataclass(frozen=True)
class TwinState:
    """The complete state of a twin, which determines its future.

    Attributes:
        physics: MuJoCo's integration state, with the commands in flight.
        pushes: Pushes that act now or later.
    """

    physics: Array
    pushes: tuple[Push, ...]


class Twin:
    """A simulated robot: its physics, its pushes and its complete state.

    Args:
        robot: The robot.
        delay: Latency from a write until the joint acts on it, s; by default the robot's own.
        supply: Supply voltage of the servos, V; by default the robot's own.
        world: Ground, plant and self-collision; its plant's delay and supply take precedence.

    Attributes:
        world: The environment, as given.
        model: MuJoCo's model, with actuators.
        data: MuJoCo's state.
        indices: Indices of the joints in MuJoCo's state.
        up: (3,) the torso's up axis in the world frame, a live view.
        on_step: Called after every physics step, if set.
        on_jump: Called after a reset or a restore, if set, so that callers can clear history.
    """

    def __init__(
        self,
        robot: RobotDescription,
        *,
        delay: float | None = None,
        supply: float | None = None,
        world: Environment | None = None,
    ) -> None:
        self.robot = robot
        self.world = world or Environment()
        plant = self.world.plant
        supply = supply if plant.supply is None else plant.supply
        delay = delay if plant.delay is None else plant.delay
        self.supply = robot.drive.supply if supply is None else supply
        self.delay = robot.drive.command_delay if delay is None else delay
        self.model = build_model(robot, delay=self.delay, supply=self.supply, world=self.world)
        self.data = mujoco.MjData(self.model)
        self.timestep = float(self.model.opt.timestep)
        self.on_step: Callable[[], None] | None = None
        self.on_jump: Callable[[], None] | None = None
        self._suspect: int | None = None
        self._pushes: list[Push] = []
        self._torso = self.model.body(robot.torso).id
        self.indices = JointIndices(self.model, robot.joints.names)
        self.up = self.data.xmat[self._torso, UP_AXIS]
        self._qpos, self._qvel = self.data.qpos, self.data.qvel
        self._before = np.empty(self.model.nq + self.model.nv)
        self.reset()

    def reset(self, pose: Array | None = None, *, noise: float = 0.0, seed: int = 0) -> None:
        """Put the robot at rest on the floor in `pose` (n,) rad, by default its stance.

        Args:
            pose: Joint positions, rad.
            noise: Standard deviation of noise on every joint position, degrees.
            seed: Seed of that noise.
        """
        pose = self.robot.stance if pose is None else pose
        jitter = np.random.default_rng(seed).normal(0.0, 1.0, len(pose)) * radians(noise)
        mujoco.mj_resetData(self.model, self.data)
        self._pushes.clear()
        self.data.qpos[self.indices.position] = pose + jitter
        satisfy_couplings(self.model, self.data.qpos, self.robot.joints.names)
        self._drop_to_floor()
        self.set_goals(pose)
        self._jumped()

    def lay_down(self, front: bool, pose: Array, *, noise: float = 0.0, seed: int = 0) -> None:
        """Put the robot on the floor, lying on its front or its back, with a random heading.

        Args:
            front: True to lie on its front.
            pose: (n,) joint positions, rad.
            noise: Standard deviation of noise on every joint position, degrees.
            seed: Seed of that noise and of the heading.

        Raises:
            UsageError: The robot is fixed to the ground.
        """
        if self.robot.fixed:
            raise UsageError(f"{self.robot.name} is fixed to the ground and cannot be laid down")
        self.reset(pose, noise=noise, seed=seed)
        turn = np.random.default_rng([1, seed]).uniform(-np.pi, np.pi)
        level, around = np.empty(4), np.empty(4)
        mujoco.mju_axisAngle2Quat(
            level, np.array([0.0, 1.0, 0.0]), np.pi / 2 * (1 if front else -1)
        )
        mujoco.mju_axisAngle2Quat(around, np.array([0.0, 0.0, 1.0]), turn)
        mujoco.mju_mulQuat(self.data.qpos[3:7], around, level)
        mujoco.mj_forward(self.model, self.data)
        solid = np.flatnonzero((self.model.geom_conaffinity > 0) & (self.model.geom_bodyid > 0))
        lowest = self.data.geom_xpos[solid, 2] - self.model.geom_rbound[solid]
        self.data.qpos[2] -= lowest.min()
        self._jumped()

    def set_goals(self, pose: Array) -> None:
        """Make `pose` (n,) rad the target, including all commands still in flight."""
        width = self.model.nu // len(pose)
        ctrl = np.zeros((len(pose), width))
        ctrl[:, 0] = pose
        self.data.ctrl[:] = ctrl.ravel()
        if self.model.nhistory:
            for index, row in enumerate(ctrl):
                samples = int(self.model.actuator_history[index, 0])
                values = np.repeat(row[None], samples, axis=0)
                mujoco.mj_initCtrlHistory(self.model, self.data, index, None, values)

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return float(self.data.time)

    @property
    def base(self) -> BaseState:
        """The true state of the floating base."""
        qpos, qvel = self.data.qpos, self.data.qvel
        if self.robot.fixed:
            return self.fixed_base()
        return BaseState(qpos[:3].copy(), qpos[3:7].copy(), qvel[:3].copy(), qvel[3:6].copy())

    def fixed_base(self) -> BaseState:
        """Return the state of a base that is fixed to the world."""
        base = self.data.body(self.robot.base)
        return BaseState(base.xpos.copy(), base.xquat.copy(), np.zeros(3), np.zeros(3))

    @property
    def fallen(self) -> bool:
        """True when the base is low or the torso tilted beyond the limits in the robot's file."""
        if self.robot.fixed:
            return False
        height = self._qpos[2]
        if not self.world.ground.flat:
            height -= self.world.ground.height(float(self._qpos[0]), float(self._qpos[1]))
        return bool(has_fallen(self.robot.fall, height, self.up[2]))

    @property
    def powered(self) -> bool:
        """False when all actuators are switched off and the joints are limp."""
        return not self.model.opt.disableactuator

    @powered.setter
    def powered(self, on: bool) -> None:
        self.model.opt.disableactuator = 0 if on else 1

    def push(self, push: Push) -> None:
        """Schedule a push; it acts from its start time on.

        Raises:
            UnknownNameError: The robot has no such body.
        """
        if push.body:
            self.check_body(push.body)
        self._pushes.append(push)

    def check_body(self, name: str) -> None:
        """Check that the robot has a body of this name.

        Raises:
            UnknownNameError: The robot has no such body.
        """
        names = [self.model.body(i).name for i in range(1, self.model.nbody)]
        if name not in names:
            raise UnknownNameError("body", name, names)

    def step(self, steps: int) -> None:
        """Advance the physics by `steps` of its time steps.

        Raises:
            DivergedError: The physics diverged.
        """
        self._before[: self.model.nq] = self._qpos
        self._before[self.model.nq :] = self._qvel
        if self._pushes or self.on_step is not None:
            for _ in range(steps):
                self._apply_pushes()
                mujoco.mj_step(self.model, self.data)
                if self.on_step is not None:
                    self.on_step()
        else:
            mujoco.mj_step(self.model, self.data, steps)
        if not self._qvel.dot(self._qvel) < WILD:
            self._look_closer(steps)

    def save(self) -> TwinState:
        """Return the complete physical state, with commands in flight and pushes to come."""
        state = np.empty(mujoco.mj_stateSize(self.model, STATE))
        mujoco.mj_getState(self.model, self.data, state, STATE)
        return TwinState(state, tuple(self._pushes))

    def restore(self, state: TwinState) -> None:
        """Restore a state from `save`."""
        mujoco.mj_setState(self.model, self.data, state.physics, STATE)
        self._pushes[:] = state.pushes
        self._jumped()

    def _jumped(self) -> None:
        """Update derived quantities after a jump in time."""
        self._suspect = None
        mujoco.mj_forward(self.model, self.data)
        if self.on_jump is not None:
            self.on_jump()

    def _drop_to_floor(self) -> None:
        """Set the base height so that the lowest sole, or else the lowest geom, is on the floor."""
        if self.robot.fixed:
            return
        self.data.qpos[3:7] = [1.0, 0.0, 0.0, 0.0]
        self.data.qpos[2] = 1.0
        mujoco.mj_kinematics(self.model, self.data)
        soles = [self.data.site(foot.site).xpos[2] for foot in self.robot.feet]
        self.data.qpos[2] -= min(soles) if soles else lowest_point(self.model, self.data)

    def _apply_pushes(self) -> None:
        self.data.xfrc_applied[:] = 0.0
        for push in self._pushes:
            share = push.active_fraction(self.time, self.timestep)
            if share > 1e-6:  # smaller shares are rounding errors of the time
                self._apply(push, share * push.force)
        if all(self.time >= push.start + push.duration for push in self._pushes):
            self._pushes.clear()

    def _apply(self, push: Push, force: Array) -> None:
        if not push.body:
            part = self.model.body_mass / self.model.body_mass.sum()
            self.data.xfrc_applied[:, :3] += part[:, None] * force
            return
        body = self.model.body(push.body).id
        self.data.xfrc_applied[body, :3] += force
        if push.height is not None:
            point = self.data.xpos[body] + [0.0, 0.0, push.height]
            self.data.xfrc_applied[body, 3:] += np.cross(point - self.data.xipos[body], force)

    def _look_closer(self, steps: int) -> None:
        """Remember which joint got too fast first; raise when the state is no longer usable.

        Raises:
            DivergedError: The positions are beyond `LOST`, or not numbers.
        """
        if self._suspect is None:
            self._suspect = fastest_dof(self.model, self.data, self._before, steps)
        if abs(self._qpos.sum()) < LOST:
            return
        joint = "the base"
        index = int(self.model.dof_jntid[self._suspect])
        if self.model.jnt_type[index] != mujoco.mjtJoint.mjJNT_FREE:
            joint = f"joint {self.model.joint(index).name!r}"
        raise DivergedError(
            f"the twin diverged at {self.time:.3f} s, first at {joint}; "
            "lower its stiffness or the physics time step"
        )
