"""Putting a walking controller together from a robot, a gait and what the user asked for."""

from dataclasses import replace

import msgspec
import numpy as np

from windup.control.estimation.estimator import BaseEstimator
from windup.control.estimation.foot_load import FootLoad
from windup.control.estimation.tilt_filter import ImuNoise
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.soles import Soles
from windup.control.limit_cycle.balancer import Balancer
from windup.control.limit_cycle.planner import StepPlanner
from windup.control.limit_cycle.step_memory import Memory
from windup.control.limit_cycle.step_model import StepModel
from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.gait_file import Balance, Sampling
from windup.control.pose_graph.torso_servo import TorsoServo
from windup.control.regulation.disturbance_detector import DisturbanceDetector
from windup.control.regulation.footfalls import Footfalls
from windup.control.regulation.variables import (
    RegulationVariable,
    regulation_variables,
    unmatched,
)
from windup.hal.controller import Predictor
from windup.hal.errors import StateMissingError, UnknownNameError, UsageError
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.ranges import Range, read_number
from windup.robots import RobotDescription
from windup.tools.assembly.gaits import find_gait
from windup.tools.assembly.shape import can_estimate, check_walks
from windup.tools.assembly.state import state_of
from windup.tools.assembly.steer import steering_of
from windup.tools.assembly.step_models import memory_for
from windup.tools.assembly.style_intervals import blended
from windup.tools.assembly.walk_options import WalkOptions

TARGET = Range(-1_000.0, 1_000.0)


def build_estimator(
    robot: RobotDescription,
    lag: float,
    *,
    switches: bool = True,
    attitude: bool = False,
    apart: bool = False,
) -> BaseEstimator:
    """Return what estimates the base of `robot` from its sensors.

    Args:
        robot: The robot.
        lag: Delay of its IMU's own filter, s.
        switches: Its contact sensors exist; without them the soles' heights tell who stands.
        attitude: Its IMU tells its attitude and has no gyroscope.
        apart: Its IMU is on no servo bus: it is not read with the joints.

    Raises:
        StateMissingError: The robot has no IMU or no feet, is fixed, or has passive joints.
    """
    if robot.imu is None or not can_estimate(robot):
        how = "give it an [imu] and a [[foot]] in robot.toml"
        if robot.fixed or robot.passive:
            how = "it is fixed" if robot.fixed else f"{robot.passive[0]!r} is passive"
        raise StateMissingError(f"the base of {robot.name} cannot be estimated; {how}")
    model = robot.model
    soles = Soles(model, [foot.body for foot in robot.feet], robot.contacts)
    weight = float(model.body_subtreemass[model.body(robot.base).id]) * GRAVITY
    load = FootLoad(soles, robot.contacts, weight, sensed=switches)
    return BaseEstimator(
        load,
        model.site(robot.imu.site).pos.copy(),
        lag=lag,
        noise=ImuNoise(start_bias=0.0, drift=0.0) if attitude else None,  # no gyroscope, no bias
        fused=attitude,
        read=robot.drive.wire_delay if apart else 0.0,
    )


def build_walk(
    robot: RobotDescription,
    options: WalkOptions,
    predictor: Predictor | None,
    *,
    latency: float = 0.0,
) -> Balancer:
    """Return the controller that walks `robot` as `options` say.

    Args:
        robot: The robot.
        options: How to walk.
        predictor: Plays rollouts in the controller's own time.
        latency: From the start of a step to its scalings acting, where the predictor plays, s.

    Raises:
        UsageError: The options do not fit the gait, or the robot cannot walk.
    """
    check_walks(robot)
    gait = blended(robot, find_gait(robot, options.gait), options)
    balance = _balance(robot, gait, options.sampling)
    variables = regulation_variables(list(options.rv or balance.regulation))
    names = _perturbations(gait, balance, variables, options.rv is not None)
    torso_servo = _torso_servo(robot, gait, options.torso_servo)
    if torso_servo is not None:
        variables = [_on_the_pelvis(variable) for variable in variables]
    state = state_of(robot)
    memory = memory_for(robot, options, variables, names)
    # Models learnt on level soles do not hold on tilted ones.
    one_rollout = memory is not None and memory.complete
    walker = Balancer(
        gait=gait,
        joints=robot.joints,
        contacts=robot.contacts,
        state=state,
        regulation=variables,
        perturbations=names,
        planner=None,
        steering=steering_of(robot, gait, options, [] if one_rollout else variables),
        targets=dict(balance.targets),
        fixed_targets=_targets(options.target, variables),
        torso_servo=torso_servo,
        footfalls=_footfalls(robot, state, balance, options),
        shaken=_shaken(balance, options, one_rollout),
    )
    if predictor is not None and not options.open_loop:
        model = _step_model(gait, balance, variables, names, options, memory)
        walker.planner = _planner(walker, model, predictor, balance.horizon, latency)
    return walker


def _planner(
    walker: Balancer, model: StepModel, predictor: Predictor, horizon: float, latency: float
) -> StepPlanner:
    """Return who plans the steps of `walker` in its own time."""
    return StepPlanner(
        gait=walker.gait,
        joints=walker.joints,
        contacts=walker.contacts,
        state=walker.state,
        regulation=walker.regulation,
        perturbations=walker.perturbations,
        model=model,
        predictor=predictor,
        torso_servo=walker.torso_servo,
        horizon=horizon,
        latency=latency,
    )


def _balance(robot: RobotDescription, gait: Gait, sampling: Sampling | None) -> Balance:
    """Return how a gait is balanced, sampled as the user says.

    Raises:
        UsageError: It has no steps to balance.
    """
    balance = gait.file.balance
    if not gait.graph.ends_step.any() or balance is None:
        raise UsageError(
            f"gait {gait.name!r} has no steps to balance; "
            f"play it with `windup play {robot.name} {gait.name}`"
        )
    return balance if sampling is None else _resampled(balance, sampling)


def _footfalls(
    robot: RobotDescription, state: RobotState, balance: Balance, options: WalkOptions
) -> Footfalls | None:
    """The thesis' control feels nothing of the ground."""
    if not balance.footfalls or options.rv:
        return None
    return Footfalls(state, robot.contacts, balance.footfalls)


def _shaken(
    balance: Balance, options: WalkOptions, one_rollout: bool
) -> DisturbanceDetector | None:
    """Return who says when to plan again in mid-step; nobody where a step may take one rollout."""
    if balance.replan is None or options.rv or one_rollout:
        return None
    return DisturbanceDetector(balance.replan)


def _resampled(balance: Balance, sampling: Sampling) -> Balance:
    """Return `balance` with another sampling; the thesis' three sample around zero."""
    centred = sampling != "full"
    return msgspec.structs.replace(
        balance, sampling=sampling, centred=centred, from_last=not centred
    )


def _perturbations(
    gait: Gait, balance: Balance, variables: list[RegulationVariable], chosen: bool
) -> list[str]:
    """Return the perturbation that controls each variable.

    The gait names them for its own variables. For variables chosen by the user they are taken in
    the file's order, the forward ones for forward variables and the lateral ones for lateral.
    """
    if not chosen:
        names = list(balance.perturbations)
    else:
        free = {
            axis: [item.name for item in gait.file.perturbation if item.axis == axis]
            for axis in ("forward", "lateral")
        }
        names = [free[v.axis].pop(0) for v in variables if free[v.axis]]
    if wrong := unmatched(names, variables):
        raise UsageError(f"gait {gait.name!r} has {wrong}")
    return names


def _step_model(
    gait: Gait,
    balance: Balance,
    variables: list[RegulationVariable],
    names: list[str],
    options: WalkOptions,
    memory: Memory | None,
) -> StepModel:
    reuse = options.model
    if (reuse != "full" or options.learn is not None) and balance.sampling != "full":
        option = "--learn" if options.learn is not None else f"--model {reuse}"
        raise UsageError(f"{option} keeps whole Jacobians; it needs `--sampling full`")
    items = {item.name: item for item in gait.file.perturbation}
    for name in names:
        gait.index(name)
    return StepModel(
        sampling=balance.sampling,
        samples=np.array([items[name].sample for name in names]),
        limits=np.array([items[name].limit for name in names]),
        weights=np.array([balance.weights.get(v.name, 1.0) for v in variables]),
        centred=balance.centred,
        from_last=balance.from_last,
        keep=balance.keep,
        regularisation=balance.regularisation,
        memory=memory,
        drift=balance.drift,
        rounds=balance.rounds if reuse == "full" else 0,
        miss=balance.miss,
    )


def _torso_servo(robot: RobotDescription, gait: Gait, wanted: bool) -> TorsoServo | None:
    record = gait.file.torso_servo
    return TorsoServo.of(record, robot.joints) if record is not None and wanted else None


def _on_the_pelvis(variable: RegulationVariable) -> RegulationVariable:
    """A servoed torso no longer shows how the body leans; the pelvis does (section 3.8)."""
    if not variable.name.startswith("up."):
        return variable
    pelvis = regulation_variables([f"pelvis_{variable.name}"])[0]
    return replace(pelvis, name=variable.name)


def _targets(given: tuple[str, ...], variables: list[RegulationVariable]) -> dict[str, float]:
    """Return targets by name from "NAME=VALUE", or a bare VALUE for the first forward one.

    Raises:
        UsageError: A value is no number, or a name is none of the regulation variables.
    """
    targets = {}
    names = [variable.name for variable in variables]
    for text in given:
        name, _, value = text.rpartition("=")
        if not name:
            name = next((v.name for v in variables if v.axis == "forward"), names[0])
        elif name in {v.partition(".")[0] for v in names} and f"{name}.forward" in names:
            name = f"{name}.forward"
        if name not in names:
            raise UnknownNameError("--target", name, names)
        targets[name] = read_number(f"--target {text}", value, TARGET)
    return targets
