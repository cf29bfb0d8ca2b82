from tools.bench_bus import bench_memory, wire_bytes


def test_a_cycle_of_20_servos_has_the_bytes_that_the_findings_count() -> None:
    assert wire_bytes(20) == 568
    assert wire_bytes(20, fast=True) == 436


def test_the_benchmark_measures_every_subject() -> None:
    result = bench_memory(servos=3, rounds=1, cycles=2)
    assert set(result) == {"sdk", "codec", "codec fast", "backend"}
    assert all(time > 0.0 for time in result.values())
