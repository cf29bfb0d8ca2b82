"""`windup run`: run a controller or a behaviour of the user's own."""

import shlex
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, is_dataclass, make_dataclass
from inspect import getfile
from pathlib import Path
from typing import Annotated, Any, ClassVar

import tyro

from windup.hal.errors import UsageError
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.behaviours.report import Report
from windup.tools.command_line.table import COMMANDS
from windup.tools.commands.behaviour_command import BehaviourCommand
from windup.tools.options.twin_options import TwinOptions
from windup.tools.own_code.code_place import failing, refusing
from windup.tools.own_code.installed import INSTALLED
from windup.tools.own_code.python_file import is_python_file, load_own, split


@dataclass(frozen=True, kw_only=True)
class Run(TwinOptions, BehaviourCommand):
    """Run a controller of your own: a class with reset(observation) and step(observation, dt).

    The annotated arguments of its constructor are options, see `windup run ROBOT FILE.py --help`;
    those called robot, joints, stance and predictor get the robot's own. It is tried on one
    observation first, and refused before anything moves if it fails.
    """

    what: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="FILE")]
    """The class: FILE.py, or FILE.py:NAME if the file has several; or the name of a behaviour that
    an installed package brings."""

    usage: ClassVar[str] = "run"

    @classmethod
    def specialised(cls, words: Sequence[str]) -> type:
        """Return the command with the options of what is to be run."""
        what = next((word for word in words if is_python_file(word)), None)
        if what is not None:
            return command_of(load_own(what), what, words)
        installed = INSTALLED.names()
        what = next((word for word in words if word in installed), None)
        if what is not None:
            return command_of(INSTALLED.load(what), what, words)
        if len(words) > 1 and not any(word.startswith("-") for word in words[:2]):
            raise UsageError(_unknown(words[1], words[0], installed))
        return cls

    @property
    def remote_name(self) -> str:
        """What a runtime knows the behaviour by: with the whole path of its file."""
        if not is_python_file(self.what):
            return self.what
        path, name = split(self.what)
        return f"{path.absolute()}:{name}" if name else str(path.absolute())

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        if not hasattr(self, "behaviour"):
            raise UsageError(f"run: write `windup run {self.robot} {self.what}`, then the options")
        with self._own(refusing):
            super().check()

    def one(self, seed: int, *, show: bool = True) -> Report:
        """Run one seed and return how it went; see `BehaviourCommand.one`.

        Raises:
            ControllerError: The user's code raised something; its traceback has been printed.
        """
        with self._own(failing):
            return super().one(seed, show=show)

    @contextmanager
    def _own(self, converting: Any) -> Iterator[None]:
        """Convert what the code of a user raises; other errors are of the stack."""
        own = is_python_file(self.what)
        path = split(self.what)[0] if own else Path(getfile(type(self.behaviour)))
        with converting(path):
            yield

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how another process makes this command: its class is made from `what`."""
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        return _remade, (self.what, values)


def _remade(what: str, values: dict[str, Any]) -> Run:
    command: Run = Run.specialised((what,))(**values)
    return command


def command_of(behaviour: Behaviour[Any], what: str, words: Sequence[str]) -> type:
    """Return the command `windup run` with the options of a behaviour.

    Args:
        behaviour: The behaviour.
        what: What the user calls it.
        words: Words after `run`.

    Raises:
        UsageError: The options are no frozen dataclass, or one has the name of another option.
    """
    kind = behaviour.Options
    if not is_dataclass(kind) or not kind.__dataclass_params__.frozen:  # type: ignore[attr-defined]
        raise UsageError(f"{what}: {behaviour.name}.Options should be a @dataclass(frozen=True)")
    if taken := [item.name for item in fields(kind) if hasattr(Run, item.name) or item.name in OWN]:
        raise UsageError(
            f"{what}: {behaviour.name} has an option {taken[0]!r}, and `windup run` has it, too: "
            "give it another name"
        )
    robot = words[0] if len(words) > 1 and not words[0].startswith("-") else "ROBOT"
    about = {"behaviour": behaviour, "usage": shlex.join(["run", robot, what])}
    return make_dataclass(
        "Run",
        [],
        bases=(kind, Run),
        frozen=True,
        namespace={**about, "__doc__": behaviour.about, "__module__": __name__},
    )


OWN = {item.name for item in fields(Run)}
"""Names of the options of every `windup run`."""


def _unknown(what: str, robot: str, installed: Sequence[str]) -> str:
    """Return why there is nothing to run."""
    if what in COMMANDS:
        return f"run: {what} is a command: `windup {what} {robot}`"
    if Path(what).is_file():
        return f"run: {what} is no file of Python: FILE.py or FILE.py:NAME"
    known = f", or one of {', '.join(installed)}" if installed else ""
    return f"run: there is no behaviour {what!r}; give FILE.py or FILE.py:NAME{known}"
