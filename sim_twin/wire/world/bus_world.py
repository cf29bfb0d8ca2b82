"""A world of buses: physics, devices on the buses, and one schedule for all of them."""

from collections.abc import Sequence
from typing import Protocol

from windup.hal.errors import UnknownNameError
from windup.sim_twin.wire.boards.opencr import OpenCr
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.faults.faults import Faults
from windup.sim_twin.wire.schedule import Schedule
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.hand import Hand, HandMotion, JointGrip

WATCH_PERIOD = 0.010  # period of the checks of watchdogs and health, s
EPSILON = 1e-9  # tolerance for times that are rounded, s


class Physics(Protocol):
    """The simulation that moves the shafts."""

    @property
    def timestep(self) -> float:
        """Time step, s."""
        ...

    def step(self) -> None:
        """Advance by one step."""
        ...


class BenchPhysics:
    """Physics of separate shafts on a bench, each with its own inertia.

    Attributes:
        shafts: The shafts.
        timestep: Time step, s.
    """

    def __init__(self, shafts: Sequence[InertiaShaft], timestep: float = 0.001) -> None:
        self.shafts, self.timestep = tuple(shafts), timestep

    def step(self) -> None:
        """Advance by one step."""
        for shaft in self.shafts:
            shaft.step(self.timestep)


class BusWorld:
    """Physics and buses that advance together.

    Time is virtual: `advance` brings the world to an instant and executes the scheduled actions on
    the way, in order. `RealClock` ties it to the wall clock.

    Attributes:
        buses: The buses by name; the first is the default.
        physics: The simulation that moves the shafts.
        schedule: The schedule of future actions.
        supply: Supply voltage of the servos, V. Set it with `set_supply`.
        dead: Devices that are broken permanently.
        faults: The faults.
        grips: The joints that can be turned by hand: by joint name, on a bench by id.
        hands: The hands that turn limp joints.
    """

    def __init__(
        self,
        physics: Physics,
        schedule: Schedule,
        buses: dict[str, Bus],
        supply: float = 12.0,
        owned: Sequence[object] = (),
        faults: Faults | None = None,
    ) -> None:
        self.physics, self.schedule, self.buses, self.supply = physics, schedule, buses, supply
        self.owned = tuple(owned)  # objects such as the twin, for access to the true state
        self._full: list[float] = []  # supplies before the present brown-outs, V
        self._sags: list[float] = []  # supplies during the present brown-outs, V
        self.dead: list[Device] = []
        self.grips: dict[str, JointGrip] = {}
        self.hands: list[Hand] = []
        self._steps = 0
        self._watched = 0.0
        self._devices = [(bus, device) for bus in buses.values() for device in bus.devices]
        for device in self.devices:
            if isinstance(device, OpenCr):
                device.dead = self.dead
        self.faults = faults or Faults()
        for bus in buses.values():
            bus.faults = self.faults
        self.faults.attach(self)

    @property
    def now(self) -> float:
        """Time, s."""
        return self.schedule.now

    @property
    def devices(self) -> list[Device]:
        """All devices on all buses."""
        return [device for _, device in self._devices]

    def bus(self, name: str | None = None) -> Bus:
        """Return the bus of this name, by default the first."""
        return self.buses[name] if name else next(iter(self.buses.values()))

    def advance(self, time: float) -> None:
        """Advance the world to `time`, s."""
        schedule = self.schedule
        while schedule.next <= time:
            self.catch_up(schedule.next)
            schedule.run_next()
        if time > schedule.now:
            self.catch_up(time)
            schedule.now = time

    def catch_up(self, time: float) -> None:
        """Step physics and servo control loops up to `time`, s."""
        step = self.physics.timestep
        while (self._steps + 1) * step <= time + EPSILON:
            self.step()

    @property
    def physics_time(self) -> float:
        """Time that the physics have reached, s."""
        return self._steps * self.physics.timestep

    def step(self) -> None:
        """Run one step of physics, control loops, checks and hands."""
        now, step = self.physics_time, self.physics.timestep
        if now - self._watched >= WATCH_PERIOD - EPSILON:
            for bus, device in self._devices:
                device.watch(now, now - self._watched, bus.last_instruction)
            self._watched = now
        for _, device in self._devices:
            if device.busy:
                device.control(now, step)
        self.physics.step()
        for hand in self.hands:
            hand.move(step)
        self._steps += 1

    def hand(self, motion: HandMotion) -> None:
        """Add a hand that turns a joint to and fro from now on, while it is limp.

        Raises:
            UnknownNameError: There is no such joint.
        """
        if motion.joint not in self.grips:
            raise UnknownNameError("joint", motion.joint, self.grips)
        self.hands.append(Hand(self.grips[motion.joint], motion))

    def set_supply(self, volts: float) -> None:
        """Change the supply voltage of all devices, V."""
        self.supply = volts
        self._supply([volts] * len(self._devices))

    @property
    def volts(self) -> float:
        """Present supply voltage, including brown-outs, V."""
        return min([self.supply, *self._sags])

    def sag(self, volts: float) -> None:
        """Lower the supply of all devices to `volts` V, until `recover`."""
        if not self._sags:
            self._full = [device.supply for _, device in self._devices]
        self._sags.append(volts)
        self._supply([min(full, *self._sags) for full in self._full])

    def recover(self, volts: float) -> None:
        """End a `sag` to `volts` V; other sags continue."""
        self._sags.remove(volts)
        self._supply([min([full, *self._sags]) for full in self._full])

    def _supply(self, volts: list[float]) -> None:
        for (_, device), supply in zip(self._devices, volts, strict=True):
            if device not in self.dead:
                device.set_supply(supply, self.now)
        for bus in self.buses.values():
            bus.refresh()

    def kill(self, device: Device) -> None:
        """Break a device permanently: it loses its power."""
        if device not in self.dead:
            self.dead.append(device)
            device.set_supply(0.0, self.now)

    def repair(self, device: Device) -> None:
        """Repair a device that was killed: it gets the supply voltage of the others."""
        if device in self.dead:
            self.dead.remove(device)
            others = [other.supply for other in self.devices if other not in self.dead]
            device.set_supply(max(others, default=self.supply), self.now)
