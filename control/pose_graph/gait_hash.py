"""Hash of a gait file, which ties learnt step models to the version of their gait."""

import json
import tomllib
from hashlib import sha256
from pathlib import Path

from windup.hal.small_file import read_small

LENGTH = 16


def gait_hash(path: Path) -> str:
    """Return a hash, 16 hexadecimal digits, of the gait file at `path`; comments do not count.

    Raises:
        OSError: The file cannot be read.
        ValueError: The file is not TOML.
    """
    said = tomllib.loads(read_small(path).decode("utf-8-sig"))
    return sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()[:LENGTH]
