"""The papers that can be reproduced. A new one is a package beside `laszlo` and a line here."""

from windup.tools.reproduce.study.figure import Study


def studies() -> dict[str, Study]:
    """Return the papers by name; loaded only when somebody asks."""
    from windup.tools.reproduce.kenwright import KENWRIGHT
    from windup.tools.reproduce.laszlo import LASZLO
    from windup.tools.reproduce.wu_zordan import WU_ZORDAN

    return {study.name: study for study in (LASZLO, KENWRIGHT, WU_ZORDAN)}
