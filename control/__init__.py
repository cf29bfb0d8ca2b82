"""Controllers: observations in, joint commands out."""

import windup.hal.late_glfw  # noqa: F401 - before the first file that imports MuJoCo
