"""Which version is installed."""

from importlib.metadata import PackageNotFoundError, version


def installed_version() -> str:
    """Return the version that is installed; "unknown" where only the files lie there."""
    try:
        return version("windup-robotics")
    except PackageNotFoundError:
        return "unknown"
