"""Control tables of protocol 1 servos, against a third party's, and their rules."""

from typing import Any

import pytest
import rustypot

from windup.hal.families import servo_model
from windup.sim_twin.wire.servos import dynamixel1_tables, feetech_tables
from windup.sim_twin.wire.servos.byte_table import TWOS, ByteTable, Field
from windup.sim_twin.wire.world.own_emulations import PROTOCOLS

TABLES: dict[str, tuple[ByteTable, Any]] = {
    "AX-12A": (dynamixel1_tables.MODELS["AX-12A"].table(), rustypot.AxPyController),
    "MX-106": (dynamixel1_tables.MODELS["MX-106"].table(), rustypot.MxPyController),
    "STS3250": (feetech_tables.MODELS["STS3250"].table(), rustypot.Sts3215PyController),
    "SCS0009": (feetech_tables.MODELS["SCS0009"].table(), rustypot.Scs0009PyController),
}
# rustypot lists what the tables of SCS servos that have it call factory parameters.
FACTORY = range(78, 83)
SIGNED_BY = {"present_current": 15}  # Feetech's own library says so, rustypot says unsigned


@pytest.mark.parametrize("name", TABLES)
def test_every_register_of_rustypot_is_where_it_says(name: str) -> None:
    table, theirs = TABLES[name]
    ours = {field.address: field for field in table.fields.values()}
    for register in theirs.registers():
        if name == "SCS0009" and register.addr in FACTORY:
            continue
        field = ours[register.addr]
        assert field.size == register.size, register
        assert (field.access == "RW") == ("Write" in str(register.access)), register
        if field.name not in SIGNED_BY and register.encoding == "sign_magnitude":
            assert field.sign in (register.sign_bit, 0), register


@pytest.mark.parametrize("name", [name for name in PROTOCOLS if PROTOCOLS[name] != "dynamixel2"])
def test_every_emulated_servo_has_a_data_sheet(name: str) -> None:
    table, _ = TABLES.get(name, (None, None))
    assert table is None or servo_model(name).model_number == table.get("model_number")
    assert servo_model(name).rows


@pytest.mark.parametrize(
    ("sign", "value", "bits"),
    [(0, 5, 5), (10, -5, 0x405), (11, -2047, 0xFFF), (15, -1, 0x8001), (TWOS, -1, 0xFFFF)],
)
def test_signs(sign: int, value: int, bits: int) -> None:
    field = Field(0, 2, "x", "RW", 0, -2047, 2047, sign)
    assert field.pack(value) == bits
    assert field.unpack(bits) == value


@pytest.mark.parametrize(("big", "raw"), [(False, b"\x02\x01"), (True, b"\x01\x02")])
def test_half_a_field_keeps_its_other_half(big: bool, raw: bytes) -> None:
    fields = (Field(0, 1, "a"), Field(1, 2, "x", "RW", 0x102), Field(3, 1, "b", "RW"))
    table = ByteTable(fields, 3, big)
    assert table.read(1, 2) == raw
    writes, clean = table.decode(2, b"\x07\x09")
    assert clean
    assert [(f.name, v) for f, v in writes] == [("x", 0x107 if big else 0x702), ("b", 9)]
    assert not table.decode(0, b"\x01\x01")[1]
    assert table.read(2, 4) == raw[1:] + bytes(3)
