"""Delays the loading of glfw until a window is opened; has to be imported before MuJoCo.

MuJoCo imports glfw, which starts a process to query the version of its library. That is a tenth of
the time of `from windup import Robot`. This stands in hal because robots and control both import
MuJoCo, and hal is all that both may import.
"""

import sys
from importlib.util import find_spec
from types import ModuleType
from typing import Any


class LazyModule(ModuleType):
    """A module whose code runs when one of its attributes is first used.

    Unlike a module of `importlib.util.LazyLoader`, it is not loaded by a second `import`, which
    reads `__spec__`.
    """

    def __getattr__(self, name: str) -> Any:
        """Load the module, and return the attribute; a module that failed is tried again."""
        object.__setattr__(self, "__class__", ModuleType)
        assert self.__spec__ is not None and self.__spec__.loader is not None
        try:
            self.__spec__.loader.exec_module(self)
        except BaseException:
            object.__setattr__(self, "__class__", LazyModule)
            raise
        return getattr(self, name)


def import_lazily(name: str) -> None:
    """Register a module whose code runs when it is first used.

    Does nothing if the module is imported already or is not installed.
    """
    if name in sys.modules or (spec := find_spec(name)) is None:
        return
    module = LazyModule(name)
    module.__spec__, module.__loader__, module.__file__ = spec, spec.loader, spec.origin
    module.__package__, module.__path__ = name, spec.submodule_search_locations or []
    sys.modules[name] = module


import_lazily("glfw")
