"""The papers that can be reproduced. A new one is a package beside `laszlo` and a line here."""

from tools.reproduce.figure import Study


def studies() -> dict[str, Study]:
    """Return the papers by name; loaded only when somebody asks."""
    from tools.reproduce.kenwright import KENWRIGHT
    from tools.reproduce.laszlo import LASZLO
    from tools.reproduce.wu_zordan import WU_ZORDAN

    return {study.name: study for study in (LASZLO, KENWRIGHT, WU_ZORDAN)}
