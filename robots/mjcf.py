"""Parsing and compiling of an MJCF, with one-line errors, and look-up of its names."""

import re
from codecs import BOM_UTF8
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np

from windup.hal.errors import ConfigError
from windup.hal.joints import Array
from windup.hal.small_file import MOST
from windup.robots.mjcf_numbers import wrong_numbers

OBJECTS = {
    "body": mujoco.mjtObj.mjOBJ_BODY,
    "joint": mujoco.mjtObj.mjOBJ_JOINT,
    "site": mujoco.mjtObj.mjOBJ_SITE,
    "sensor": mujoco.mjtObj.mjOBJ_SENSOR,
}
COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
FORMAT = re.compile(rb"%[-+ #0-9.*hlLqjzt]*[diouxXeEfFgGaAcspn]")
"""A conversion of printf, for which the parser of MuJoCo 4.0 takes names in its messages."""
HINGE = int(mujoco.mjtJoint.mjJNT_HINGE)
FREE = int(mujoco.mjtJoint.mjJNT_FREE)


def parse_mjcf(path: Path) -> mujoco.MjSpec:
    """Return a new parse of the MJCF or URDF at `path`; its suffix does not matter.

    Raises:
        ConfigError: The file is missing, cannot be read, or is not MJCF.
    """
    if not path.is_file():
        raise ConfigError(f"{path}: cannot be read: no such file")
    if path.stat().st_size > MOST:
        raise ConfigError(f"{path}: cannot be read: longer than {MOST >> 20} MB")
    try:
        if found := FORMAT.search(COMMENT.sub(b"", path.read_bytes())):
            raise ConfigError(
                f"{path}: {found[0].decode()!r} in a name or a value: MuJoCo can end the program "
                "at it; leave the % out"
            )
        if path.suffix == ".xml" and not path.read_bytes().startswith(BOM_UTF8):
            return mujoco.MjSpec.from_file(str(path))
        # MuJoCo selects the parser by the suffix, and fails at a byte-order mark.
        spec = mujoco.MjSpec.from_string(path.read_text("utf-8-sig"))
        spec.modelfiledir = str(path.parent)
        return spec
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise ConfigError(f"{path}: {_one_line(error)}") from None


def compile_mjcf(
    path: Path, complete: Callable[[mujoco.MjSpec], None] | None = None
) -> mujoco.MjModel:
    """Return the MJCF at `path` as a model, after `complete` has changed its spec.

    Raises:
        ConfigError: The file is missing, MuJoCo rejects it, or a number in it is invalid.
    """
    model = model_of(path, complete)
    for wrong in wrong_numbers(model):
        raise ConfigError(f"{path}: {wrong}")
    return model


def model_of(path: Path, complete: Callable[[mujoco.MjSpec], None] | None = None) -> mujoco.MjModel:
    """Return the MJCF at `path` as a model without a check of its numbers; see `compile_mjcf`.

    Raises:
        ConfigError: The file is missing, or MuJoCo rejects it.
    """
    try:
        spec = parse_mjcf(path)
        if complete is not None:
            complete(spec)
        return spec.compile()
    except ValueError as error:
        raise ConfigError(f"{path}: {_one_line(error)}") from None


def is_self_contained(path: Path) -> bool:
    """Return whether an MJCF or URDF names no other file, such as a mesh or a part of itself."""
    return b"file" not in path.read_bytes()


def names(model: mujoco.MjModel, kind: str) -> tuple[str, ...]:
    """Return the names of all objects of a `kind` of `OBJECTS`, in MJCF order."""
    count = {
        "body": model.nbody,
        "joint": model.njnt,
        "site": model.nsite,
        "sensor": model.nsensor,
    }
    found = (mujoco.mj_id2name(model, OBJECTS[kind], index) for index in range(count[kind]))
    return tuple(name for name in found if name)


def hinge_names(model: mujoco.MjModel) -> tuple[str, ...]:
    """Return the names of all hinges that have one, in MJCF order."""
    found = (model.joint(j).name for j in np.flatnonzero(model.jnt_type == HINGE))
    return tuple(name for name in found if name)


def hinge_axes(model: mujoco.MjModel, names: tuple[str, ...]) -> Array:
    """Return the unit axes (n, 3) of hinges in the world frame, in the zero pose."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return data.xaxis[[model.joint(name).id for name in names]].copy()


def _one_line(error: Exception) -> str:
    return "; ".join(line.strip() for line in str(error).splitlines() if line.strip())
