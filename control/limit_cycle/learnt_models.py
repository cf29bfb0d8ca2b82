"""Step models that were learnt in earlier walks, stored in a file beside the gait.

With them every step is planned from one rollout, including the first, so that a small computer is
fast enough.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import msgspec
import numpy as np
from msgspec import Meta

from windup.hal.config import Count, TomlRecord, check_finite
from windup.hal.errors import ConfigError
from windup.hal.joints import Array
from windup.hal.small_file import read_small


class LearntModel(TomlRecord, frozen=True):
    """The model of a step for starts near one point.

    Attributes:
        phase: Index of the state that the step begins with.
        start: (f,) features of the start.
        jacobian: (r, r) derivative of each regulation variable by each scaling.
        steps: Number of steps over which `start` and `jacobian` are averaged.
    """

    phase: Count
    start: list[float]
    jacobian: list[list[float]]
    steps: Annotated[int, Meta(ge=1)] = 1


class ModelFile(TomlRecord, frozen=True):
    """A file of step models with their variables.

    Attributes:
        gait: The `gait_hash` of their gait.
        commands: Command lines of the walks they were learnt from.
        rate_hz: Rate of the control loop in these walks, Hz.
        regulation: Names of the r regulation variables.
        perturbations: Names of the r perturbations.
        models: The models.
    """

    regulation: list[str]
    perturbations: list[str]
    models: list[LearntModel]
    gait: str = ""
    commands: list[str] = []
    rate_hz: float | None = None

    def text(self) -> str:
        """Return it as JSON, with one model a line."""
        rows = [f" {_json(model)}" for model in self.models]
        head = [
            f"{_json(name)}: {_json(getattr(self, name))},"
            for name in ("gait", "commands", "rate_hz", "regulation", "perturbations")
        ]
        return "\n".join(["{", *head, '"models": [', ",\n".join(rows), "]", "}", ""])


def _json(value: object) -> str:
    return msgspec.json.encode(value).decode()


@dataclass
class LearntModels:
    """A memory of models by the start of the step, for learning or for look-up.

    Attributes:
        complete: No more models are sampled; every step uses the nearest stored model.
        reach: Maximum distance of two starts whose models are averaged into one.
        commands: Command lines of the walks that the models in its files were learnt from.
    """

    complete: bool = False
    reach: float = 0.02
    commands: list[str] = field(default_factory=list, init=False)
    _known: dict[int, list[tuple[Array, Array, int]]] = field(default_factory=dict, init=False)

    def reset(self) -> None:
        """Keep all models: they are also valid in the next walk."""

    def recall(self, side: int, start: Array) -> Array | None:
        """Return the Jacobian with the nearest start; None if there is none, or not `complete`."""
        entries = self._known.get(side, [])
        if not self.complete or not entries:
            return None
        return entries[self._nearest(entries, start)][1]

    def store(self, side: int, start: Array, jacobian: Array) -> None:
        """Add a model that has just been sampled."""
        self.add(side, start, jacobian, 1)

    def add(self, side: int, start: Array, jacobian: Array, steps: int) -> None:
        """Add a model that is the mean of `steps` steps."""
        entries = self._known.setdefault(side, [])
        if entries:
            at = self._nearest(entries, start)
            here, known, count = entries[at]
            if float(np.linalg.norm(here - start)) <= self.reach:
                part = steps / (count + steps)
                mean = here + part * (start - here), known + part * (jacobian - known)
                entries[at] = (*mean, count + steps)
                return
        entries.append((start, jacobian, steps))

    def read(self, path: Path, regulation: list[str], perturbations: list[str], gait: str) -> None:
        """Add the models of a file.

        Raises:
            ConfigError: The file cannot be read or decoded, or its models are for other variables
                or perturbations, for another gait, or for another version of this gait.
        """
        try:
            text = read_small(path)
            file = msgspec.json.decode(text, type=ModelFile)
            check_finite(path, msgspec.json.decode(text))
        except OSError as error:
            raise ConfigError(f"{path}: cannot be read: {error.strerror}") from None
        except (msgspec.DecodeError, RecursionError) as error:
            raise ConfigError(f"{path}: no file of step models: {error}") from None
        if (file.regulation, file.perturbations) != (regulation, perturbations):
            raise ConfigError(
                f"{path}: models of {', '.join(file.regulation)} by {', '.join(file.perturbations)}"
                "; the walk has others. Learn them anew: `windup walk ... --learn FILE`"
            )
        if file.gait != gait:
            raise ConfigError(
                f"{path}: learnt for another version of the gait: delete it, and learn its models "
                "anew with `windup walk ... --learn FILE`"
            )
        self.commands += file.commands
        for number, model in enumerate(file.models):
            _check_shape(path, number, model, file)
            self.add(model.phase, np.array(model.start), np.array(model.jacobian), model.steps)

    def file(
        self, regulation: list[str], perturbations: list[str], gait: str, rate_hz: float
    ) -> ModelFile:
        """Return all models as a file; see `ModelFile` for the arguments."""
        models = [
            LearntModel(
                phase=phase,
                start=np.round(start, 4).tolist(),
                jacobian=np.round(jacobian, 6).tolist(),
                steps=steps,
            )
            for phase, entries in sorted(self._known.items())
            for start, jacobian, steps in entries
        ]
        return ModelFile(
            regulation=regulation,
            perturbations=perturbations,
            models=models,
            gait=gait,
            commands=self.commands,
            rate_hz=rate_hz,
        )

    @staticmethod
    def _nearest(entries: list[tuple[Array, Array, int]], start: Array) -> int:
        return int(np.argmin([float(np.linalg.norm(known - start)) for known, _, _ in entries]))


def _check_shape(path: Path, number: int, model: LearntModel, file: ModelFile) -> None:
    """Check the size of a model's Jacobian, and of its start features.

    Raises:
        ConfigError: A size does not match the file's variables, or its first model.
    """
    rows, columns = len(file.regulation), len(file.perturbations)
    if [len(row) for row in model.jacobian] != [columns] * rows:
        raise ConfigError(f"{path}: models[{number}].jacobian: give {rows} x {columns} numbers")
    if len(model.start) != len(file.models[0].start):
        wanted = len(file.models[0].start)
        raise ConfigError(f"{path}: models[{number}].start: give {wanted} numbers, as the first")
