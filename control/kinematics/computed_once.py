"""An attribute that is computed when first asked for, and then kept until it is discarded."""

from collections.abc import Callable
from typing import Any, Generic, Self, TypeVar, overload

T = TypeVar("T")


class ComputedOnce(Generic[T]):
    """Decorator of a method whose result is kept in the instance's `__dict__`, by its name.

    Like `functools.cached_property`, but without its lock, which takes longer than what many of
    these methods compute.
    """

    def __init__(self, compute: Callable[[Any], T]) -> None:
        self._compute, self.__doc__ = compute, compute.__doc__

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, instance: None, owner: type) -> Self: ...
    @overload
    def __get__(self, instance: object, owner: type) -> T: ...
    def __get__(self, instance: object | None, owner: type) -> Self | T:
        """Compute the value and keep it; later the instance's `__dict__` answers by itself."""
        if instance is None:
            return self
        value = instance.__dict__[self._name] = self._compute(instance)
        return value


def computed_once(owner: type) -> tuple[str, ...]:
    """Return the names of these attributes of a class."""
    return tuple(name for name, item in vars(owner).items() if isinstance(item, ComputedOnce))
