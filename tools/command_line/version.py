"""Which version is installed."""


def installed_version() -> str:
    """Return the version that is installed; "unknown" where only the files lie there."""
    from importlib.metadata import PackageNotFoundError, version  # takes a while, for its parsers

    try:
        return version("windup-robotics")
    except PackageNotFoundError:
        return "unknown"
