"""The bench of odd runs: it counts them all, and a process that hangs costs one of them."""

from windup.tools.benches.fuzz.bench import Runner, measure_fuzz


def test_all_runs_are_counted() -> None:
    result = measure_fuzz("op3", 5, seed=7)
    assert result["runs"] == 5 and sum(result["statuses"].values()) == 5


def test_a_run_that_does_not_end_is_told_and_its_process_is_replaced() -> None:
    runner = Runner(("op3",))
    try:
        runner.begin(1)
        trial = runner.end()  # long before its process has even started
        assert trial.fault == "hung" and runner.left == 0
    finally:
        runner.close()
    assert not runner.process.is_alive()
