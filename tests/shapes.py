"""Robots of any shape, generated: MJCF without inertials or sensors, robot.toml, a pose graph.

Each limb is a chain of links, whose joints turn in turn about y, x and z; masses stand in geoms.
"""

from dataclasses import dataclass
from pathlib import Path

LINK = 0.06
"""Length of a link, m."""


@dataclass(frozen=True)
class Limb:
    """A chain of links; `down` it hangs from the trunk, else it stands on it."""

    name: str
    place: str
    joints: int
    axes: str = "yxz"
    down: bool = True
    foot: bool = False


@dataclass(frozen=True)
class Shape:
    """A trunk with limbs, that floats or is fixed."""

    name: str
    limbs: tuple[Limb, ...]
    floats: bool = True
    height: float = 0.3


ARM = Shape("arm", (Limb("arm", "0 0 0.03", 4, down=False),), floats=False, height=0.03)
QUADRUPED = Shape(
    "quadruped",
    tuple(
        Limb(f"{end}_{side}", f"{x} {y} -0.03", 3, foot=True)
        for end, x in (("front", 0.1), ("hind", -0.1))
        for side, y in (("left", 0.06), ("right", -0.06))
    ),
)
ONE_LEG = Shape("one_leg", (Limb("leg", "0 0 -0.03", 3, "yyx", foot=True),))
THIRTY = Shape(
    "thirty",
    (
        Limb("left", "0 0.07 -0.03", 6, foot=True),
        Limb("right", "0 -0.07 -0.03", 6, foot=True),
        *(Limb(f"arm{k}", f"0 {0.04 * k - 0.08:g} 0.03", 6, down=False) for k in (1, 2, 3)),
    ),
    height=0.5,
)
SHAPES = (ARM, QUADRUPED, ONE_LEG, THIRTY)


def write_shape(folder: Path, shape: Shape, *, extra: str = "") -> Path:
    """Write a robot into `folder`, with `extra` at the head of its robot.toml, and return it."""
    (folder / "gaits").mkdir(parents=True)
    (folder / "model.xml").write_text(_mjcf(shape))
    (folder / "robot.toml").write_text(extra + _toml(shape))
    (folder / "gaits" / "nod.toml").write_text(_graph(shape))
    return folder


def add_table(folder: Path) -> None:
    """Add a heavy table to the MJCF of a robot, ahead of it and before it in the file."""
    mjcf = folder / "model.xml"
    table = (
        '<body name="table" pos="2 0 0.1"><geom type="box" size="0.2 0.2 0.1" mass="9" '
        'contype="0" conaffinity="0"/></body>\n<body name="trunk"'
    )
    mjcf.write_text(mjcf.read_text().replace('<body name="trunk"', table))


def joint_names(shape: Shape) -> list[str]:
    """Return the names of the joints, in MJCF order."""
    return [f"{limb.name}_{k}" for limb in shape.limbs for k in range(limb.joints)]


def _mjcf(shape: Shape) -> str:
    limbs = "".join(map(_limb, shape.limbs))
    free = "<freejoint/>" if shape.floats else ""
    return f"""<mujoco>
<compiler angle="radian"/>
<option timestep="0.002" integrator="implicitfast"/>
<default><geom contype="0" conaffinity="1"/></default>
<worldbody>
<geom type="plane" size="0 0 0.05" contype="1" conaffinity="0"/>
<body name="trunk" pos="0 0 {shape.height}">{free}
<geom type="box" size="0.12 0.08 0.03" mass="0.4"/><site name="imu"/>
{limbs}</body>
</worldbody>
</mujoco>"""


def _limb(limb: Limb) -> str:
    way = -LINK if limb.down else LINK
    text, place = "", limb.place
    for k in range(limb.joints):
        axis = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}[limb.axes[k % len(limb.axes)]]
        text += f'<body name="{limb.name}_link{k}" pos="{place}"><joint name="{limb.name}_{k}" '
        text += f'axis="{axis}" range="-1.5 1.5" armature="0.01" frictionloss="0.02"/>'
        text += f'<geom type="box" size="0.01 0.01 0.02" pos="0 0 {way / 2}" mass="0.02"/>'
        place = f"0 0 {way}"
    if limb.foot:
        text += f'<geom type="box" size="0.06 0.04 0.005" pos="0 0 {way}" mass="0.02"/>'
        text += f'<site name="{limb.name}_sole" pos="0 0 {way - 0.005}"/>'
    return text + "</body>" * limb.joints


def _toml(shape: Shape) -> str:
    joints = "".join(
        f'  {{ name = "{name}", id = {1 + index}, lower = -1.5, upper = 1.5 }},\n'
        for index, name in enumerate(joint_names(shape))
    )
    feet = "".join(
        f'[[foot]]\nname = "{limb.name}"\nbody = "{limb.name}_link{limb.joints - 1}"\n'
        f'site = "{limb.name}_sole"\n'
        for limb in shape.limbs
        if limb.foot
    )
    floats = '[imu]\nsite = "imu"\n[fall]\nheight = 0.05\ntilt = 1.0\n' if shape.floats else ""
    return f"""name = "{shape.name}"
title = "A robot of any shape"
rate_hz = 125
base = "trunk"
torso = "trunk"
stance = "stand"
joint = [
{joints}]
[drive]
kind = "servo"
servo = "XM430-W350"
bus = "body"
stiffness = 30.0
damping = 0.5
[[bus]]
name = "body"
protocol = "dynamixel2"
baud = 1_000_000
{floats}{feet}[poses.stand]
"""


def _graph(shape: Shape) -> str:
    last = (joint_names(shape) or ["none"])[-1]
    return f"""title = "Nods"
start = "stand"
loop = false
[[state]]
name = "nod"
pose = {{ {last} = 4 }}
until = {{ time = 0.3 }}
[[state]]
name = "back"
until = {{ time = 0.3 }}
"""
