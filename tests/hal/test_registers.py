from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scservo_sdk import SCS_TOHOST, SCS_TOSCS

from windup.hal.errors import UnknownNameError
from windup.hal.families import FAMILIES, Family, family_of, servo_model, servo_names
from windup.hal.registers import Register
from windup.hal.servos.feetech_registers import BAUD_CODES, SCS, STS, feetech_registers
from windup.hal.servos.mx_registers import mx_registers

SIGNED = [STS["present_position"], STS["present_load"], STS["homing_offset"], SCS["present_load"]]
ids = [f"{register.name} {register.order}" for register in SIGNED]


@pytest.mark.parametrize("register", SIGNED, ids=ids)
@given(data=st.data())
def test_signs_are_those_of_feetechs_own_sdk(register: Register, data: st.DataObject) -> None:
    bit = register.sign_bit
    assert bit is not None
    counts = data.draw(st.integers(1 - (1 << bit), (1 << bit) - 1))
    raw = SCS_TOSCS(counts, bit)
    assert register.encode(counts) == raw.to_bytes(2, register.order)
    assert register.decode(register.encode(counts)) == counts == SCS_TOHOST(raw, bit)


@given(st.lists(st.integers(0, 0xFFFF), min_size=1, max_size=20))
def test_an_array_is_decoded_as_its_elements_are(raws: list[int]) -> None:
    for register in (*SIGNED, STS["goal_time"], mx_registers("MX-28")["present_velocity"]):
        raw = np.array(raws, dtype=np.uint16).astype(register.dtype)
        each = [register.decode(raw[at : at + 1].tobytes()) for at in range(len(raw))]
        assert register.values(raw).tolist() == each


def test_a_value_that_does_not_fit_under_its_sign_is_refused() -> None:
    assert STS["homing_offset"].encode(-2047) == bytes([0xFF, 0x0F])
    with pytest.raises(OverflowError, match="2048 does not fit into homing_offset"):
        STS["homing_offset"].encode(2048)


def test_sts_and_scs_spell_the_same_number_the_other_way_round() -> None:
    assert STS["goal_position"].encode(0x0123) == bytes([0x23, 0x01])
    assert SCS["goal_position"].encode(0x0123) == bytes([0x01, 0x23])


def test_tables_say_what_differs_between_families() -> None:
    assert STS["lock"].address == 55 and SCS["lock"].address == 48
    assert "homing_offset" not in SCS and "present_current" not in SCS
    assert "compliance_slopes" in mx_registers("AX-12A")
    assert "present_current" not in mx_registers("MX-28")
    assert set(BAUD_CODES) == {1_000_000, 500_000, 250_000, 128_000, 115_200}
    with pytest.raises(UnknownNameError, match=r"unknown Feetech servo 'STS3216'; did you mean"):
        feetech_registers("STS3216")


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_no_two_registers_of_a_table_overlap(family: Family) -> None:
    for model in family.numbers.values():
        spans = sorted((item.address, item.size) for item in family.table(model).values())
        for (start, size), (after, _) in pairwise(spans):
            assert start + size <= after


@pytest.mark.parametrize("name", servo_names())
def test_every_servo_of_the_catalogue_has_a_family_that_knows_its_number(name: str) -> None:
    model = servo_model(name)
    assert name.startswith(family_of(name).model_name(model.model_number))
    assert 0 < model.middle < model.last_count
