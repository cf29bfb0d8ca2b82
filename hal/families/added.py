"""Checks of a servo family that another distribution adds."""

from collections.abc import Iterable, Sequence

from windup.hal.families.family import Family

NEEDED = (
    "id",
    "baud_rate",
    "model_number",
    "torque_enable",
    "goal_position",
    "present_position",
    "present_velocity",
    "present_voltage",
    "present_temperature",
)
"""Registers that the driver uses of every servo, by these names."""


def check_added(found: object, own: Sequence[Family]) -> Family:
    """Return `found` if it is a family that can be used beside those in `own`.

    Raises:
        ValueError: It is not; the message says why.
    """
    if not isinstance(found, Family):
        kind = type(found).__name__
        raise ValueError(f"should be a windup.hal.families.Family, and is of type {kind}")
    if not found.models:
        raise ValueError(f"family {found.name!r} has no models")
    _check_free("family", [found.name], [family.name for family in own])
    taken = [name for family in own for name in _names(family)]
    _check_free("servo model", _names(found), taken)
    needed = (*NEEDED, *(() if found.errors_in_answers else ("hardware_error",)))
    for model in found.models:
        if not {model.name, model.name.split("-")[0]} & {*found.numbers.values()}:
            raise ValueError(f"model {model.name!r} has no entry in the numbers of the family")
        if missing := [name for name in needed if name not in found.table(model.name)]:
            raise ValueError(f"model {model.name!r} has no register {', '.join(missing)}")
    return found


def _names(family: Family) -> list[str]:
    """Return the names of all models of a family, with and without data sheet."""
    return [*(model.name for model in family.models), *family.numbers.values()]


def _check_free(kind: str, names: Iterable[str], taken: Sequence[str]) -> None:
    for name in names:
        if name in taken:
            raise ValueError(f"Windup has a {kind} {name!r} itself; choose another name")
