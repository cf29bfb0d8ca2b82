"""What of a class somebody has used, so that a test can claim to have called everything."""

from typing import Any


def recorded(original: type) -> tuple[Any, set[str]]:
    """Return a subclass that notes what its instances were asked for, and the notes."""
    asked: set[str] = set()

    def note(self: Any, name: str) -> Any:
        asked.add(name)
        return object.__getattribute__(self, name)

    return type(original.__name__, (original,), {"__getattribute__": note}), asked


def calls(original: type) -> set[str]:
    """Return the names of all public methods and properties."""
    public = {name: getattr(original, name) for name in dir(original) if not name.startswith("_")}
    return {
        name
        for name, value in public.items()
        if callable(value) or hasattr(value, "__get__")  # a method or a property
    }
