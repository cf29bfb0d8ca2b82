"""The installed version."""


def installed_version() -> str:
    """Return the installed version; "unknown" if the package is not installed."""
    from importlib.metadata import PackageNotFoundError, version  # its import is slow

    try:
        return version("windup-robotics")
    except PackageNotFoundError:
        return "unknown"
