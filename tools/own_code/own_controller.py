"""A controller of the user's own as a behaviour: any class with `reset` and `step`."""

from inspect import getdoc, signature
from pathlib import Path
from typing import Any, Final

from windup.hal.controller import Controller, Predictor
from windup.hal.errors import UsageError
from windup.robots import RobotDescription
from windup.sim_twin.rollouts import RolloutPredictor
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.own_code.code_place import place_of_code, refusing
from windup.tools.own_code.constructor_options import constructor_options
from windup.tools.own_code.trial import try_out

METHODS: Final = {"reset": ("observation",), "step": ("observation", "dt")}
"""Methods of a controller with their arguments."""


class OwnController(Behaviour[Any]):
    """A class of a user's file that is a controller.

    Its annotated constructor arguments are the options; those called robot, joints, stance and
    predictor get the robot's own. Class attributes `needs_imu` and `down` are those of `Behaviour`.

    Args:
        kind: The class.
        path: The file.

    Raises:
        UsageError: It is no controller, or its constructor needs what nobody can give.
    """

    def __init__(self, kind: Any, path: Path) -> None:
        self.kind, self.path = kind, path
        for method, arguments in METHODS.items():
            _check_method(kind, method, arguments, path)
        self.name = kind.__name__
        place = place_of_code(kind, path)
        self.Options, self._options, self._given = constructor_options(kind, place)
        self.needs_imu = bool(getattr(kind, "needs_imu", False))
        self.down = bool(getattr(kind, "down", False))

    @property
    def about(self) -> str:
        """What it does: the documentation of the class."""
        return getdoc(self.kind) or f"Run {self.name}."

    def build(
        self, robot: RobotDescription, options: Any, predictor: Predictor | None
    ) -> Controller:
        """Return an instance of the class."""
        own = {
            "robot": robot,
            "joints": robot.joints,
            "stance": robot.stance,
            "predictor": predictor,
        }
        given = {name: own[name] for name in self._given}
        chosen = {name: getattr(options, name) for name in self._options}
        controller: Controller = self.kind(**given, **chosen)
        return controller

    def check(self, robot: RobotDescription, options: Any) -> None:
        """Try the controller on one observation of a twin in its stance.

        Raises:
            UsageError: It raises something, or returns no command for this robot.
        """
        predictor = RolloutPredictor(robot) if "predictor" in self._given else None
        with refusing(self.path):
            controller = self.build(robot, options, predictor)
            returned = try_out(controller, robot)
        if problem := returned.problem():
            place = place_of_code(self.kind.step, self.path)
            raise UsageError(f"{place}: {self.name}.step {problem}")


def _check_method(kind: Any, method: str, arguments: tuple[str, ...], path: Path) -> None:
    """Raise unless a class has a method that takes these arguments.

    Raises:
        UsageError: It has none, or one with other arguments.
    """
    found, wanted = getattr(kind, method, None), ", ".join(arguments)
    if not callable(found):
        raise UsageError(
            f"{place_of_code(kind, path)}: {kind.__name__} is no controller: it has no "
            f"{method}({wanted})"
        )
    try:
        signature(found).bind(None, *arguments)
    except TypeError:
        raise UsageError(
            f"{place_of_code(found, path)}: {kind.__name__}.{method}{signature(found)} should be "
            f"{method}(self, {wanted})"
        ) from None
