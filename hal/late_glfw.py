"""Import this before MuJoCo, and glfw is loaded when somebody opens a window, not before.

MuJoCo imports glfw, which starts a process to ask its library for its version: a tenth of the time
that `from windup import Robot` takes, on computers that mostly have no window.
"""

import sys
from importlib.util import find_spec
from types import ModuleType
from typing import Any


class LateModule(ModuleType):
    """A module whose code runs when something of it is first asked for.

    Unlike that of `importlib.util.LazyLoader`, it is not loaded by a second `import`, which asks
    for its `__spec__`.
    """

    def __getattr__(self, name: str) -> Any:
        """Load the module, and return what was asked for."""
        object.__setattr__(self, "__class__", ModuleType)
        assert self.__spec__ is not None and self.__spec__.loader is not None
        self.__spec__.loader.exec_module(self)
        return getattr(self, name)


def import_late(name: str) -> None:
    """Put a module into place whose code runs when it is first used.

    Nothing happens where it is imported already, or is not installed.
    """
    if name in sys.modules or (spec := find_spec(name)) is None:
        return
    module = LateModule(name)
    module.__spec__, module.__loader__, module.__file__ = spec, spec.loader, spec.origin
    module.__package__, module.__path__ = name, spec.submodule_search_locations or []
    sys.modules[name] = module


import_late("glfw")
