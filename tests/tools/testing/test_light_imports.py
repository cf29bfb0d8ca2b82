"""What tests of servos do without: MuJoCo, and before a fixture is used, everything."""

import subprocess
import sys

import pytest

HEAVY = ("mujoco", "scipy", "shapely", "daqp", "matplotlib", "tyro", "rich")
BLOCK = """
import sys

class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {blocked!r}:
            raise ModuleNotFoundError(f"{{name}} is blocked", name=name)

sys.meta_path.insert(0, Blocked())
"""


def run_without(blocked: tuple[str, ...], program: str) -> "subprocess.CompletedProcess[str]":
    """Run a program that cannot import some packages."""
    text = BLOCK.format(blocked=blocked) + program
    return subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=100)


def test_the_blocker_blocks() -> None:
    ran = run_without(HEAVY, "import windup.sim_twin.twin")
    assert "mujoco is blocked" in ran.stderr


@pytest.mark.parametrize(
    "program",
    [
        "import windup.hal",
        """
from windup.tools.testing.servo_bus import ServoBus

with ServoBus(servos="XM430-W350:1-2") as bus:
    import dynamixel_sdk
    assert dynamixel_sdk.PacketHandler(2.0).ping(bus.open_sdk("dynamixel"), 1)[0] == 1020
""",
        """
from windup.hal.bus.bus import Bus
from windup.hal.families import family_of
from windup.tools.testing.servo_bus import ServoBus

with ServoBus(servos="STS3215:1-2") as bus:
    driver = Bus(bus.port(), family_of("STS3215-7.4V"))
    counts, valid = driver.sync_read((1, 2), driver.family.registers["present_position"])
    assert valid.all() and (counts == 2048).all()
""",
    ],
    ids=["hal", "an SDK on a bench", "our driver on a bench"],
)
def test_hal_and_servos_on_a_bench_need_no_mujoco(program: str) -> None:
    ran = run_without(HEAVY, program)
    assert ran.returncode == 0, ran.stderr


def test_robots_are_listed_without_mujoco() -> None:
    ran = run_without(("mujoco",), "from windup.tools.cli import main; main(['robots'])")
    assert ran.returncode == 0 and "op3" in ran.stderr, ran.stderr


def test_servos_on_a_bench_are_served_without_mujoco() -> None:
    words = ["emulate", "--servos", "STS3215:1-6", "--tcp", "0"]
    program = f"from windup.tools.cli import main; main({words})"
    text = BLOCK.format(blocked=("mujoco", "scipy", "shapely", "daqp")) + program
    with subprocess.Popen([sys.executable, "-c", text], stderr=subprocess.PIPE, text=True) as ran:
        assert ran.stderr is not None
        assert ran.stderr.readline().startswith("bus 'bench' (6 devices at 1000000 baud) on socket")
        ran.terminate()
        assert ran.wait(20) == 0


def test_the_plugin_imports_nothing_before_a_fixture_is_used(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(
        """
        import sys

        def test_something_else():
            assert "windup.tools.testing.pytest_plugin" in sys.modules
            assert not {"numpy", "mujoco", "serial", "windup.hal"} & set(sys.modules)

        def test_servos(servo_bus):
            servo_bus()
            assert "numpy" in sys.modules and "mujoco" not in sys.modules
        """
    )
    ran = pytester.runpytest_subprocess("-p", "windup.tools.testing.pytest_plugin")
    ran.assert_outcomes(passed=2)
