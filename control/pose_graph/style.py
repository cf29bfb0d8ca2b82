"""Styles: variations that are added to a gait by an amount, which is ramped from step to step."""

from dataclasses import dataclass, field
from math import inf

import numpy as np

from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.gait_file import Style
from windup.hal.errors import UnknownNameError, UsageError
from windup.hal.joints import Array

STEPS = 8.0


@dataclass(frozen=True)
class StyleInterval:
    """An amount of a style in an interval of time.

    Attributes:
        name: Name of the style.
        amount: Amount of the style.
        begin: Begin of the interval, s from the first step.
        end: End of the interval, s from the first step.
    """

    name: str
    amount: float
    begin: float = 0.0
    end: float = inf


def styles_of(gait: Gait) -> dict[str, Style]:
    """Return the styles of a gait by name: those of its file, and one for each perturbation."""
    alone = {
        item.name: Style(
            name=item.name, scale={item.name: 1.0}, least=-item.limit, most=item.limit, steps=STEPS
        )
        for item in gait.file.perturbation
    }
    return {**alone, **{style.name: style for style in gait.file.style}}


@dataclass
class Styling:
    """Blends styles into a gait: C = B + sum of amounts times perturbations.

    Attributes:
        gait: The gait.
        wanted: Desired amount of each style; may be changed at any time.
        spells: Additional amounts in intervals of time.
        present: Present amounts, ramped toward the desired ones.
    """

    gait: Gait
    wanted: dict[str, float] = field(default_factory=dict)
    spells: tuple[StyleInterval, ...] = ()
    present: dict[str, float] = field(default_factory=dict, init=False)
    _began: float | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._known = styles_of(self.gait)
        for name, amount in (
            *self.wanted.items(),
            *((spell.name, spell.amount) for spell in self.spells),
        ):
            if name not in self._known:
                raise UnknownNameError(f"style of gait {self.gait.name!r}", name, self._known)
            style = self._known[name]
            if not style.least <= amount <= style.most:
                raise UsageError(
                    f"style {name}={amount:g} is outside its range {style.least:g} .. "
                    f"{style.most:g} in gait {self.gait.name!r}"
                )

    def reset(self) -> None:
        """Start over with all amounts 0."""
        self.present.clear()
        self._began = None

    def begin_step(self, time: float, also: dict[str, float] | None = None) -> None:
        """Ramp the amounts toward those desired at `time`, s, plus those in `also`."""
        if self._began is None:
            self._began = time
        wanted = self._wanted(time - self._began, also or {})
        for name in sorted({*wanted, *self.present}):
            style, now = self._known[name], self.present.get(name, 0.0)
            most = max(abs(style.least), abs(style.most), 1e-9) / max(style.steps, 1e-9)
            self.present[name] = now + float(np.clip(wanted.get(name, 0.0) - now, -most, most))

    def _wanted(self, time: float, also: dict[str, float]) -> dict[str, float]:
        """Return the desired amounts at `time`, s from the first step, clipped to their ranges."""
        wanted = dict(self.wanted)
        for name, amount in also.items():
            wanted[name] = wanted.get(name, 0.0) + amount
        for spell in self.spells:
            if spell.begin <= time < spell.end:
                wanted[spell.name] = wanted.get(spell.name, 0.0) + spell.amount
        return {
            name: float(np.clip(amount, self._known[name].least, self._known[name].most))
            for name, amount in wanted.items()
        }

    def scale(self) -> Array:
        """Return the (p,) scalings for the present amounts."""
        scale = np.zeros(len(self.gait.perturbations))
        for style, amount in self._present():
            for name, value in style.scale.items():
                scale[self.gait.index(name)] += amount * value
        return scale

    def targets(self) -> dict[str, float]:
        """Return the additions to the targets for the present amounts, by name."""
        added: dict[str, float] = {}
        for style, amount in self._present():
            for name, value in style.targets.items():
                added[name] = added.get(name, 0.0) + amount * value
        return added

    def _present(self) -> list[tuple[Style, float]]:
        return [(self._known[name], amount) for name, amount in self.present.items()]
