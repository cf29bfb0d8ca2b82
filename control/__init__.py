"""Controllers, which map observations to joint commands."""

import windup.hal.lazy_glfw  # noqa: F401 - before the first file that imports MuJoCo
