import pytest

from windup.tools.benches.bus import bench_memory, wire_bytes
from windup.tools.benches.bus1 import Vendor
from windup.tools.benches.wire import BenchFamily, cycle_over_wire


def test_a_cycle_of_20_servos_has_the_bytes_that_the_findings_count() -> None:
    assert wire_bytes(20) == 568
    assert wire_bytes(20, fast=True) == 436
    assert wire_bytes(20, vendor="feetech") == 336
    assert wire_bytes(20, vendor="dynamixel1") == 375


def test_the_benchmark_measures_every_subject() -> None:
    result = bench_memory(servos=3, rounds=1, cycles=2)
    assert set(result) == {"sdk", "codec", "codec fast", "backend"}
    assert all(time > 0.0 for time in result.values())


@pytest.mark.parametrize("vendor", ["feetech", "dynamixel1"])
def test_protocol_1_is_measured_beside_its_makers_sdk(vendor: Vendor) -> None:
    result = bench_memory(servos=3, rounds=1, cycles=2, vendor=vendor)
    assert set(result) == {"sdk", "codec", "backend"}
    assert all(time > 0.0 for time in result.values())


@pytest.mark.parametrize("maker", ["feetech", "dynamixel1", "dynamixel2"])
def test_a_cycle_over_an_emulated_wire_is_answered_and_measured(maker: BenchFamily) -> None:
    assert cycle_over_wire(1_000_000, maker, servos=4, rounds=1, cycles=3) > 0.0
