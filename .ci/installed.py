"""Install the package as its users do, and use it in projects with folders of the same names.

    python .ci/installed.py [PYTHON ...]

For each interpreter (by default this one): the wheel and the sdist are built, the sdist is
installed into a fresh environment with pytest and python-control, and two projects are tried. One
has its own `tools/`, `control/`, `hal/`, `robots/` and `sim_twin/`; in the other python-control is
used. In both `python -m pytest` and `windup walk` have to work.
"""

import shutil
import subprocess
import sys
import tempfile
import venv
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
OWN_FOLDERS = ("control", "hal", "robots", "sim_twin", "tools")
OWN_TEST = """
import control, hal, robots, sim_twin, tools
from windup import load_robot

def test_own_folders_are_found() -> None:
    assert {folder.OWNER for folder in (control, hal, robots, sim_twin, tools)} == {"ours"}
    assert load_robot("op3").name == "op3"

def test_the_fixture_of_the_plugin_works(servo_bus) -> None:
    assert servo_bus(servos="STS3215:1").open_sdk("feetech").is_open
"""
CONTROL_TEST = """
import control
from windup import load_robot

def test_python_control_is_what_it_is() -> None:
    assert control.tf([1.0], [1.0, 1.0]).poles() == [-1.0]
    assert load_robot("op3").name == "op3"
"""


def run(*words: object, cwd: Path) -> str:
    """Run a command and return its output.

    Raises:
        SystemExit: It failed; with its output.
    """
    done = subprocess.run([str(word) for word in words], cwd=cwd, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def build(folder: Path) -> tuple[Path, Path]:
    """Build the wheel and the sdist into `folder` and return their paths."""
    environment = folder / "build"
    venv.create(environment, with_pip=True)
    python = environment / "bin" / "python"
    run(python, "-m", "pip", "install", "--quiet", "hatchling", cwd=folder)
    run(python, "-m", "hatchling", "build", "-d", folder / "dist", cwd=ROOT)
    (wheel,), (sdist,) = (folder / "dist").glob("*.whl"), (folder / "dist").glob("*.tar.gz")
    return wheel, sdist


def check_wheel(wheel: Path) -> None:
    """Check that a wheel installs `windup` and nothing beside it.

    Raises:
        SystemExit: It installs something else.
    """
    tops = {name.split("/")[0] for name in zipfile.ZipFile(wheel).namelist()}
    beside = {top for top in tops if top != "windup" and not top.endswith(".dist-info")}
    if beside:
        raise SystemExit(f"the wheel installs {', '.join(sorted(beside))} beside windup")


def install(interpreter: str, package: Path, folder: Path) -> Path:
    """Install a package into a fresh environment and return the folder of its programs."""
    environment = folder / "environment"
    run(interpreter, "-m", "venv", environment, cwd=folder)
    python = environment / "bin" / "python"
    run(python, "-m", "pip", "install", "--quiet", package, "pytest", "control", cwd=folder)
    return python.parent


def try_projects(programs: Path, folder: Path) -> None:
    """Run the tests of two projects, and a walk in them."""
    own, beside = folder / "own", folder / "beside"
    for name in OWN_FOLDERS:
        (own / name).mkdir(parents=True)
        (own / name / "__init__.py").write_text('OWNER = "ours"\n')
    beside.mkdir()
    (own / "test_own.py").write_text(OWN_TEST)
    (beside / "test_control.py").write_text(CONTROL_TEST)
    for project in (own, beside):
        print(run(programs / "python", "-m", "pytest", "-q", cwd=project).splitlines()[-1])
        run(programs / "windup", "walk", "op3", "--steps", "4", cwd=project)


def main(interpreters: list[str]) -> None:
    """Check the package with each interpreter."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        wheel, sdist = build(folder)
        check_wheel(wheel)
        for number, name in enumerate(interpreters or [sys.executable]):
            interpreter = str(Path(shutil.which(name) or name).absolute())
            place = folder / str(number)
            place.mkdir()
            try_projects(install(interpreter, sdist, place), place)
            print(f"{interpreter}: the sdist installs, two projects and a walk work")


if __name__ == "__main__":
    main(sys.argv[1:])
