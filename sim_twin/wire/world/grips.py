"""Makes the grips with which hands turn servos on a bench."""

from collections.abc import Sequence

from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.hand import JointGrip


def bench_grips(devices: Sequence[Device], shafts: Sequence[InertiaShaft]) -> dict[str, JointGrip]:
    """Return the grips of servos on a bench, by id."""
    return {
        str(device.identifier): grip_on_shaft(device, shaft, 1.0)
        for device, shaft in zip(devices, shafts, strict=True)
    }


def grip_on_shaft(device: Device, shaft: InertiaShaft, ratio: float) -> JointGrip:
    """Return a grip on a joint whose angle is the shaft's divided by `ratio`."""
    return JointGrip(
        device,
        lambda: shaft.position / ratio,
        lambda angle, rate: shaft.turn(angle * ratio, rate * ratio),
    )
