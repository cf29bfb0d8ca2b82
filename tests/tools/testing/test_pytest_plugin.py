"""The fixtures that Windup installs, as somebody else's tests use them."""

import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
PLUGIN = "windup.tools.testing.pytest_plugin"


def run(pytester: pytest.Pytester) -> pytest.RunResult:
    return pytester.runpytest("-p", PLUGIN)


def test_the_package_installs_the_plugin() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["entry-points"]["pytest11"] == {PLUGIN: PLUGIN}


def test_the_example_in_docs_passes(pytester: pytest.Pytester) -> None:
    pytester.makepyfile((ROOT / "docs/test_servo_bus_example.py").read_text())
    run(pytester).assert_outcomes(passed=6)


def test_the_five_tests_with_the_makers_sdks_pass(pytester: pytest.Pytester) -> None:
    pytester.makepyfile((ROOT / "docs/test_sdk_example.py").read_text())
    run(pytester).assert_outcomes(passed=10)


def test_the_fixture_of_paths_serves_until_the_test_ends(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(
        """
        from pathlib import Path
        import serial

        paths = []

        def test_open(servo_pty):
            pty = servo_pty(servos="STS3215:1-2")
            with serial.Serial(pty.path, 1_000_000, timeout=20) as port:
                port.write(bytes.fromhex("FF FF 01 02 01 FB"))
                assert len(port.read(6)) == 6
            paths.append(pty.path)

        def test_gone():
            assert not Path(paths[0]).exists()
        """
    )
    run(pytester).assert_outcomes(passed=2)


def test_two_runs_bring_the_same_bytes(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(
        """
        def run(servo_bus, path):
            bus = servo_bus("op3", physics="inertia", seed=4, faults="drop:0.02,noise:0.02")
            bus.record(path)
            robot = bus.robot(rate=125)
            robot.stand(0.5)
            bus.close()
            return path.read_text()

        def test_same(servo_bus, tmp_path):
            one, other = (run(servo_bus, tmp_path / name) for name in "ab")
            assert one == other and len(one) > 10_000
        """
    )
    run(pytester).assert_outcomes(passed=1)


def test_a_golden_trace_fails_where_the_bytes_change(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(
        """
        from pathlib import Path

        def ask(bus, ping):
            bus.golden(Path("ask.trace"))
            with bus.serial() as port:
                port.write(bytes.fromhex(ping))
                port.read(6)

        def test_first(servo_bus):
            ask(servo_bus("bench", servos="STS3215:1-2"), "FF FF 01 02 01 FB")

        def test_second(servo_bus):
            ask(servo_bus("bench", servos="STS3215:1-2"), "FF FF 02 02 01 FA")
        """
    )
    result = run(pytester)
    result.assert_outcomes(passed=2, errors=1)
    result.stdout.fnmatch_lines(["*ask.trace, line 2: byte 2 of 6 differs*"])


def test_a_test_that_fails_leaves_no_golden_trace(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(
        """
        def test_fails(servo_bus):
            bus = servo_bus("bench", servos="STS3215:1-2")
            bus.golden("ask.trace")
            with bus.serial() as port:
                port.write(bytes.fromhex("FF FF 01 02 01 FB"))
                assert port.read(6) == b""
        """
    )
    run(pytester).assert_outcomes(failed=1)
    assert not (pytester.path / "ask.trace").exists()
