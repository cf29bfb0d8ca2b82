"""An emulated robot that begins beside its stance, in the hands that hold it."""

import windup.sim_twin.wire as wire
from windup.sim_twin.twin import Twin
from windup.sim_twin.wire.shafts.twin_shaft import TwinPhysics


def begin_noisily(world: str, twin: Twin, noise: float, seed: int) -> None:
    """Put the twin of a world into its stance, with noise.

    Args:
        world: Name of its world.
        twin: The twin.
        noise: Standard deviation of the noise, degrees; it stays where hands hold it.
        seed: Seed of the noise.
    """
    twin.reset(noise=noise, seed=seed)
    physics = wire.find_world(world).physics
    if noise and isinstance(physics, TwinPhysics):
        physics.store_held_pose()  # hands would put it back to where they took it
