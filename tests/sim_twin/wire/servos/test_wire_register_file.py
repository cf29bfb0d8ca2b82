import pytest

from windup.sim_twin.wire.servos.register_file import (
    BAD_ACCESS,
    BAD_LENGTH,
    BAD_RANGE,
    OK,
    RegisterFile,
)
from windup.sim_twin.wire.servos.x_series import MODELS, model


@pytest.fixture
def registers() -> RegisterFile:
    return model("XM430-W350").registers()


@pytest.mark.parametrize(
    ("address", "data", "error"),
    [
        (116, b"\0\0\0\0", OK),
        (84, b"\x20\x03", OK),
        (80, bytes(6), OK),  # D, I and P
        (116, b"\0\0", BAD_LENGTH),  # half a goal
        (118, b"\0\0", BAD_LENGTH),
        (132, bytes(4), BAD_ACCESS),  # present position
        (86, b"\0", BAD_ACCESS),  # nothing there
        (0, b"\0\0", BAD_ACCESS),
        (7, b"\xfd", BAD_RANGE),  # id 253
        (8, b"\x08", BAD_RANGE),
        (36, (886).to_bytes(2, "little"), BAD_RANGE),
        (700, b"\0", BAD_ACCESS),
    ],
)
def test_a_write_has_to_cover_whole_items_that_may_be_written(
    registers: RegisterFile, address: int, data: bytes, error: int
) -> None:
    assert registers.check(address, data, locked=False)[0] == error


def test_the_eeprom_is_locked_while_torque_is_on(registers: RegisterFile) -> None:
    assert registers.check(9, b"\0", locked=True)[0] == BAD_ACCESS
    assert registers.check(84, b"\0\0", locked=True)[0] == OK


def test_a_read_fills_gaps_with_zero_but_needs_something_there(registers: RegisterFile) -> None:
    assert registers.read(64, 7) == b"\0\0\0\0\x02\0\0"
    assert registers.read(400, 4) is None
    assert registers.read(660, 4) is None


def test_indirect_data_reads_and_writes_what_it_points_to(registers: RegisterFile) -> None:
    for k in range(4):
        _, writes = registers.check(168 + 2 * k, (116 + k).to_bytes(2, "little"), locked=True)
        registers.commit(writes)
    error, writes = registers.check(224, (1500).to_bytes(4, "little"), locked=True)
    assert error == OK
    registers.commit(writes)
    assert registers.get("goal_position") == 1500
    assert registers.read(224, 4) == (1500).to_bytes(4, "little")
    assert registers.check(224, b"\0\0", locked=True)[0] == BAD_LENGTH
    assert registers.touches(224, 4, 116, 119)


def test_indirect_addresses_reach_no_eeprom(registers: RegisterFile) -> None:
    assert registers.check(168, (36).to_bytes(2, "little"), locked=False)[0] == BAD_RANGE


@pytest.mark.parametrize("name", MODELS)
def test_every_default_is_allowed_and_no_two_items_overlap(name: str) -> None:
    registers = MODELS[name].registers()
    places: set[int] = set()
    for item in registers.items.values():
        if item.access == "RW" and item.name != "secondary_id":
            assert item.low <= item.default <= item.high, item
        covered = set(range(item.address, item.end))
        assert not covered & places
        places |= covered
