"""The true state of an emulated robot's base, where somebody asks for it instead of an estimate."""

from dataclasses import dataclass, replace

from windup.hal.observation import Observation
from windup.sim_twin.sensors import Sensors


@dataclass
class TwinStateSource:
    """An estimator that cheats: it looks at the twin behind an emulated bus.

    Attributes:
        sensors: What the twin's own sensors would say.
    """

    sensors: Sensors

    def update(self, observation: Observation, dt: float) -> Observation:
        """Return `observation` with the true base and contacts."""
        true = self.sensors.read()
        return replace(observation, base=true.base, contacts=true.contacts)
