"""The installed version."""

from importlib.metadata import PackageNotFoundError, version


def installed_version() -> str:
    """Return the installed version; "unknown" if the package is not installed."""
    try:
        return version("windup-robotics")
    except PackageNotFoundError:
        return "unknown"
