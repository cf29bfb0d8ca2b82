from pathlib import Path

import pytest

from windup.hal.errors import ConfigError
from windup.robots.mjcf import compile_mjcf

MJCF = """<mujoco><option timestep="0.002" gravity="0 0 -9.81"/><worldbody>
<body name="trunk" pos="0 0 1"><freejoint/><geom name="hull" size=".1" mass="2"/>
<body name="leg"><joint name="hip" range="-1 1" damping="0.5" armature="0.25"/>
<geom name="shin" size=".1" friction="0.75"/></body></body></worldbody></mujoco>"""


def load(folder: Path, old: str, new: str) -> None:
    path = folder / "model.xml"
    assert old in MJCF
    path.write_text(MJCF.replace(old, new, 1))
    compile_mjcf(path)


def test_a_model_with_sound_numbers_is_compiled(tmp_path: Path) -> None:
    load(tmp_path, "0.002", "0.001")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("0.002", "nan", "option timestep: nan s is outside 1e-05 .. 0.05 s"),
        ("0.002", "0", "option timestep: 0 s is outside"),
        ("0.002", "1e-12", "option timestep: 1e-12 s is outside"),
        ("-9.81", "inf", "option gravity: "),
        ('pos="0 0 1"', 'pos="0 0 inf"', "body 'trunk', pos: inf is not finite"),
        ('mass="2"', 'mass="1e300"', "body 'trunk', "),
        ('range="-1', 'range="-inf', "joint 'hip', range: -inf is not finite"),
        ('damping="0.5"', 'damping="-1"', "joint 'hip', damping: -1 is negative"),
        ('armature="0.25"', 'armature="nan"', "joint 'hip', armature: nan is not finite"),
        ('friction="0.75"', 'friction="-1"', "geom 'shin', friction: -1 is negative"),
    ],
)
def test_what_mujoco_lets_through_is_named(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(ConfigError) as error:
        load(tmp_path, old, new)
    assert str(error.value).startswith(f"{tmp_path / 'model.xml'}: {said}")


@pytest.mark.parametrize("name", ["%s%n", "hip-%5.1f"])
def test_a_format_in_a_name_is_refused_before_mujoco_sees_it(tmp_path: Path, name: str) -> None:
    with pytest.raises(ConfigError, match="in a name or a value: MuJoCo can end the program"):
        load(tmp_path, '<joint name="hip"', f'<joint class="{name}" name="hip"')


def test_a_format_in_a_comment_is_none_of_our_business(tmp_path: Path) -> None:
    load(tmp_path, "<worldbody>", "<!-- 5%d of\nit --><worldbody>")
