"""A world of buses: physics underneath, devices on the wires, one clock for all of it."""

from collections.abc import Sequence
from typing import Protocol

from windup.hal.errors import UnknownNameError
from windup.sim_twin.wire.boards.opencr import OpenCr
from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.faults.faults import Faults
from windup.sim_twin.wire.schedule import Schedule
from windup.sim_twin.wire.shafts.shaft import InertiaShaft
from windup.sim_twin.wire.world.hand import Grip, Hand, Swing

WATCH_PERIOD = 0.010  # s between two looks at watchdogs and health
EPSILON = 1e-9  # s; steps that are due to the bit


class Physics(Protocol):
    """What moves the shafts."""

    @property
    def timestep(self) -> float:
        """Step, s."""
        ...

    def step(self) -> None:
        """Advance by one step."""
        ...


class Bench:
    """Physics of shafts on a bench, each with nothing but its inertia.

    Attributes:
        shafts: The shafts.
        timestep: Step, s.
    """

    def __init__(self, shafts: Sequence[InertiaShaft], timestep: float = 0.001) -> None:
        self.shafts, self.timestep = tuple(shafts), timestep

    def step(self) -> None:
        """Advance by one step."""
        for shaft in self.shafts:
            shaft.step(self.timestep)


class BusWorld:
    """Physics and buses in step.

    Time is virtual: `advance` brings the world to an instant, doing on the way, in order, what
    was scheduled. `RealTime` ties it to the wall.

    Attributes:
        buses: The buses by name; the first is the default.
        physics: What moves the shafts.
        schedule: What will happen.
        supply: Voltage of the servos, V. Set it with `set_supply`.
        dead: What will never work again.
        faults: What goes wrong.
        grips: Where hands can take hold: by joint, on a bench by id.
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
        self.owned = tuple(owned)  # such as the twin, for whoever wants the truth
        self._full: list[float] = []  # supplies before the brown-outs that go on now
        self._sags: list[float] = []  # to what they let everything sink, V
        self.dead: list[Device] = []
        self.grips: dict[str, Grip] = {}
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
        """Everything on all buses."""
        return [device for _, device in self._devices]

    def bus(self, name: str | None = None) -> Bus:
        """Return a bus by its name, the first by default."""
        return self.buses[name] if name else next(iter(self.buses.values()))

    def advance(self, time: float) -> None:
        """Bring the world to `time` s."""
        schedule = self.schedule
        while schedule.next <= time:
            self.catch_up(schedule.next)
            schedule.run_next()
        if time > schedule.now:
            self.catch_up(time)
            schedule.now = time

    def catch_up(self, time: float) -> None:
        """Step the physics up to `time` s, with what the servos do at each step."""
        step = self.physics.timestep
        while (self._steps + 1) * step <= time + EPSILON:
            self.step()

    @property
    def physics_time(self) -> float:
        """How far the physics have got, s."""
        return self._steps * self.physics.timestep

    def step(self) -> None:
        """Do one step of the physics."""
        now, step = self.physics_time, self.physics.timestep
        if now - self._watched >= WATCH_PERIOD - EPSILON:
            for bus, device in self._devices:
                device.watch(now, now - self._watched, bus.heard)
            self._watched = now
        for _, device in self._devices:
            if device.busy:
                device.control(now, step)
        self.physics.step()
        for hand in self.hands:
            hand.move(step)
        self._steps += 1

    def hand(self, swing: Swing) -> None:
        """Have a hand turn a joint to and fro from now on, while that is limp.

        Raises:
            UnknownNameError: There is no such joint.
        """
        if swing.joint not in self.grips:
            raise UnknownNameError("joint", swing.joint, self.grips)
        self.hands.append(Hand(self.grips[swing.joint], swing))

    def set_supply(self, volts: float) -> None:
        """Change the supply voltage of everything."""
        self.supply = volts
        self._supply([volts] * len(self._devices))

    @property
    def volts(self) -> float:
        """The supply as it is now, during a brown-out too, V."""
        return min([self.supply, *self._sags])

    def sag(self, volts: float) -> None:
        """Let the supply of everything sink to `volts` V, until `recover`."""
        if not self._sags:
            self._full = [device.supply for _, device in self._devices]
        self._sags.append(volts)
        self._supply([min(full, *self._sags) for full in self._full])

    def recover(self, volts: float) -> None:
        """Undo a `sag` to `volts` V; other sags go on."""
        self._sags.remove(volts)
        self._supply([min([full, *self._sags]) for full in self._full])

    def _supply(self, volts: list[float]) -> None:
        for (_, device), supply in zip(self._devices, volts, strict=True):
            if device not in self.dead:
                device.set_supply(supply, self.now)
        for bus in self.buses.values():
            bus.refresh()

    def kill(self, device: Device) -> None:
        """Let a device die: it has no power any more."""
        if device not in self.dead:
            self.dead.append(device)
            device.set_supply(0.0, self.now)

    def repair(self, device: Device) -> None:
        """Give a device that had died the power that the others have."""
        if device in self.dead:
            self.dead.remove(device)
            others = [other.supply for other in self.devices if other not in self.dead]
            device.set_supply(max(others, default=self.supply), self.now)
