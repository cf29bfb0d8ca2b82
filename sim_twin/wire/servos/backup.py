"""The backup of an X-series servo's control table: instruction 0x20 of protocol 2.

The e-Manual, Control Table Backup (0x20): 1 stores the EEPROM and some of the RAM, 2 restores the
EEPROM and reboots, both with torque off only. The RAM is restored at start-up if Startup
Configuration(60) is set to do so.
"""

from collections.abc import Callable
from typing import Final

from windup.sim_twin.wire.servos.register_file import EEPROM_END, RegisterFile, TableItem

STORE: Final = b"\x01CTRL"
RESTORE: Final = b"\x02CTRL"
READY: Final = "backup_ready"
KEPT: Final = frozenset(
    ("velocity_i_gain", "velocity_p_gain", "position_d_gain", "position_i_gain",
     "position_p_gain", "feedforward_2nd_gain", "feedforward_1st_gain", "profile_acceleration",
     "profile_velocity")
)  # fmt: skip


class Backup:
    """The stored registers of one servo.

    Args:
        registers: Its control table; a model without a Backup Ready register has no backups.
    """

    def __init__(self, registers: RegisterFile) -> None:
        self._registers = registers
        self._stored: dict[str, int] = {}

    @property
    def is_supported(self) -> bool:
        """Whether this model supports backups."""
        return READY in self._registers.items

    @property
    def ready(self) -> bool:
        """Whether a backup is stored."""
        return bool(self._stored)

    def store(self) -> None:
        """Store the present values of the control table."""
        items = [item for item in self._registers.items.values() if _is_stored(item)]
        self._stored = {item.name: self._registers.get(item.name) for item in items}
        self._registers.set(READY, 1)

    def restore(self) -> None:
        """Restore the EEPROM."""
        self._restore(lambda item: item.address < EEPROM_END)

    def boot(self, restore: bool) -> None:
        """Set Backup Ready at start-up, and restore the RAM if `restore`."""
        if self.is_supported:
            self._registers.set(READY, int(self.ready))
        if restore:
            self._restore(lambda item: item.address >= EEPROM_END)

    def _restore(self, wanted: Callable[[TableItem], bool]) -> None:
        items = self._registers.items
        self._registers.commit(
            (items[name], value) for name, value in self._stored.items() if wanted(items[name])
        )


def _is_stored(item: TableItem) -> bool:
    writable = item.access == "RW"
    indirect = item.name.startswith("indirect_address")
    return writable and (item.address < EEPROM_END or item.name in KEPT or indirect)
