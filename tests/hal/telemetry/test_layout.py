"""The layout of a ring, for any robot: what is written is read, and what is damaged is not."""

from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.hal.telemetry.small_ring import ring, write
from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.observation import BaseState, ImuState, JointState, Observation
from windup.hal.publishing.controller_block import MOST_VALUES
from windup.hal.telemetry.fields import KINDS
from windup.hal.telemetry.header import Header
from windup.hal.telemetry.layout import CHECK, HEAD, at
from windup.hal.telemetry.reader import TelemetryReader
from windup.hal.telemetry.record import FIRST, LAST, Record

NAMES = st.lists(st.text("abcdefgh_äß", min_size=1, max_size=8), max_size=30).map(tuple)
HEADERS = st.builds(
    Header,
    robot=st.text(max_size=20),
    port=st.none() | st.text(max_size=20),
    rate_hz=st.floats(1.0, 1000.0),
    joints=NAMES.filter(bool),
    contacts=NAMES,
    clamps=NAMES,
    driver_clamps=NAMES,
    errors=NAMES,
    alerts=NAMES,
    estimated=st.booleans(),
).map(Header.with_fields)


@given(HEADERS)
def test_fields_follow_each_other_and_do_not_overlap(header: Header) -> None:
    dtype, end = header.dtype(), 0
    assert dtype.itemsize == header.record_size and dtype.itemsize % 8 == 0
    for field in header.fields:
        assert field.offset == end, field.name
        assert field.offset % np.dtype(field.type).itemsize == 0, field.name
        end += dtype[field.name].itemsize
    assert 0 <= dtype.itemsize - end < 8


@given(HEADERS)
def test_a_header_is_the_same_after_it_was_json(header: Header) -> None:
    again = msgspec.json.decode(msgspec.json.encode(header), type=Header)
    assert again == header
    assert again.dtype() == header.dtype()


def test_the_numbers_that_are_packed_together_have_no_gaps() -> None:
    names = [kind.name for kind in KINDS]
    assert names[:2] == ["sequence", "checksum"]
    assert names.index(FIRST) == 2
    assert all(kind.shape == () for kind in KINDS[2 : names.index(LAST) + 1])
    assert KINDS[names.index(LAST) + 1].name == "position"


def test_every_unit_and_meaning_is_given() -> None:
    for kind in KINDS:
        assert kind.meaning, kind.name
        assert kind.unit or kind.type != "<f8" or kind.name in ("asked", "applied", "values")


def test_the_numbers_of_the_head_can_be_written_in_one_piece() -> None:
    for name in HEAD.names or ():
        size = HEAD[name].itemsize
        assert size > 8 or at(name) % size == 0, name


@given(HEADERS, st.integers(0, 2**32 - 1))
@settings(max_examples=30)
def test_every_number_of_a_tick_is_read_as_it_was_written(header: Header, seed: int) -> None:
    draw = np.random.default_rng(seed).normal
    n, k = len(header.joints), len(header.contacts)
    rows = [draw(size=n) for _ in range(7)]
    imu = ImuState(draw(size=4), draw(size=3), draw(size=3), 0.5)
    base = BaseState(draw(size=3), draw(size=4), draw(size=3), draw(size=3), 0.25)
    asked, applied = JointCommand(draw(size=(5, n))), JointCommand(draw(size=(5, n)))
    record = Record(header)
    scalars = [kind for kind in KINDS if kind.shape == ()][2:]
    record.put_scalars(*(2 if kind.type != "<f8" else 2.5 for kind in scalars))
    record.put_observation(Observation(1.0, JointState(*rows), imu, draw(size=k), base))
    record.put_commands(asked, applied)
    counters = len(header.clamps) + len(header.driver_clamps) + len(header.errors)
    record.put_counters(list(range(counters)))
    tick = np.frombuffer(record.data, dtype=header.dtype())[0]
    for kind in scalars:
        assert tick[kind.name] == (2 if kind.type != "<f8" else 2.5), kind.name
    measured = ("position", "velocity", "torque", "voltage", "temperature", "age", "health_age")
    expected: dict[str, Array] = dict(zip(measured, rows, strict=True))
    expected |= {"imu_angular_velocity": imu.angular_velocity, "imu_acceleration": imu.acceleration}
    expected |= {"base_position": base.position, "base_angular_velocity": base.angular_velocity}
    expected |= {"asked": asked.block, "applied": applied.block}
    for name, values in expected.items():
        np.testing.assert_array_equal(tick[name], values, name)
    assert [*tick["clamps"], *tick["driver_clamps"], *tick["errors"]] == list(range(counters))
    assert tick["values"].shape == (MOST_VALUES,) and np.isnan(tick["values"]).all()


@given(st.integers(0, 2**31), st.integers(1, 255))
@settings(max_examples=40, deadline=None)
def test_a_record_with_one_wrong_byte_is_left_out(place: int, change: int) -> None:
    with TemporaryDirectory() as folder:
        writer = ring(Path(folder))
        write(writer, range(1, 4))
        size = writer.header.record_size
        data = bytearray(writer.path.read_bytes())
        (first,) = np.frombuffer(data, HEAD, count=1)["records_at"]
        data[int(first) + 2 * size + place % size] ^= change
        writer.path.write_bytes(bytes(data))
        with TelemetryReader(writer.path) as reader:
            assert reader.since()["tick"].tolist() == [1, 3]


@pytest.mark.parametrize("place", [0, CHECK.size - 1, CHECK.size, -1])
def test_a_damaged_record_is_counted_as_lost_once(tmp_path: Path, place: int) -> None:
    writer = ring(tmp_path)
    write(writer, range(1, 4))
    size = writer.header.record_size
    data = bytearray(writer.path.read_bytes())
    (first,) = np.frombuffer(data, HEAD, count=1)["records_at"]
    data[int(first) + 2 * size + place % size] ^= 1
    writer.path.write_bytes(bytes(data))
    with TelemetryReader(writer.path) as reader:
        assert reader.take()["tick"].tolist() == [1]
        assert reader.lost == 0, "it may still be completed"
        assert reader.take()["tick"].tolist() == [3]
        assert (reader.lost, len(reader.take())) == (1, 0)
