"""The version of a gait: what is learnt for one does not hold for another."""

import json
import tomllib
from hashlib import sha256
from pathlib import Path

from windup.hal.small_file import read_small

LENGTH = 16


def gait_hash(path: Path) -> str:
    """Return 16 hexadecimal digits of what the gait file at `path` says; comments do not count.

    Raises:
        OSError: It cannot be read.
        ValueError: It is not TOML.
    """
    said = tomllib.loads(read_small(path).decode("utf-8-sig"))
    return sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()[:LENGTH]
