"""The table: all known ways to end a run, with the correct result of each."""

from math import inf
from signal import (
    SIGCONT,
    SIGHUP,
    SIGINT,
    SIGKILL,
    SIGQUIT,
    SIGSTOP,
    SIGTERM,
    SIGTSTP,
)

from windup.tools.benches.safety.endings import (
    brown_out,
    inject,
    kill,
    kill_unread,
    own_fault,
    press,
    press_then,
    unplug,
)
from windup.tools.benches.safety.row import HANG, STOP, Ending

KILLED, ASKED, FAILED, BUS = (-SIGKILL,), (130,), (1,), (3,)
X_SERVOS = ("op3",)
"""Robots whose servos have a bus watchdog."""
FELL = (1, 3)
"""Exit statuses of a run that falls: the cause may be detected before or after the fall."""
STALE = 0.25
"""Age of a joint's state that ends a run, s."""
BELIEF = 0.6
"""Time until the watches of supply and IMU confirm a finding, s."""
HEAT = 3.5
"""The same for heat, s: a servo's temperature is read every 1.6 s, and must be read twice."""

SIGNALS = (
    Ending("SIGINT", press(SIGINT), ASKED),
    Ending("SIGINT x 2, 50 ms apart", press(SIGINT, 2, 0.05), ASKED),
    Ending("SIGINT x 5, 50 ms apart", press(SIGINT, 5, 0.05), ASKED, STOP + 0.1, crouch=False),
    Ending("SIGINT x 8, 20 ms apart", press(SIGINT, 8, 0.02), ASKED, STOP + 0.04, crouch=False),
    Ending("SIGINT x 30, 100 ms apart", press(SIGINT, 30, 0.1), ASKED, STOP + 0.2, crouch=False),
    Ending(
        "SIGINT x 4 in the crouch", press(SIGINT, 4, 0.1), ASKED, STOP + 0.2, crouch=False,
        activities=("closing crouch",),
    ),
    Ending("SIGTERM", press(SIGTERM), ASKED),
    Ending("SIGHUP", press(SIGHUP), ASKED),
    Ending("SIGQUIT", press(SIGQUIT), ASKED),
    Ending("SIGTSTP, SIGCONT", press_then(SIGTSTP, SIGCONT, 0.3), ASKED),
    Ending("SIGSTOP for 1 s", press_then(SIGSTOP, SIGCONT, 1.0), KILLED, HANG),
    Ending("SIGSTOP for ever", press(SIGSTOP), KILLED, HANG),
)  # fmt: skip

CONTROLLERS = (
    Ending("controller raises", own_fault, FAILED, fault="raises"),
    Ending("controller returns nan", own_fault, FAILED, fault="nan"),
    Ending("controller returns a wrong shape", own_fault, FAILED, fault="wrong shape"),
    Ending("controller blocks 0.3 s", own_fault, KILLED, HANG, fault="blocks 0.3 s"),
    Ending("controller blocks for ever", own_fault, KILLED, HANG, fault="blocks"),
    Ending("controller blocks in C", own_fault, KILLED, HANG, fault="blocks in C"),
    Ending("controller spins", own_fault, KILLED, HANG, fault="spins"),
)

KILLS = (
    Ending("SIGKILL program", kill("program"), KILLED),
    Ending("SIGKILL planner", kill("planner"), FAILED, activities=("walking",)),
    Ending("SIGKILL guardian", kill("guardian"), BUS),
    Ending("SIGKILL adapter", kill("emulator"), BUS, end="unknown"),
    Ending("SIGKILL program, planner", kill("program", "planner"), KILLED, activities=("walking",)),
    Ending(
        "SIGKILL guardian, program", kill("guardian", "program"), KILLED, end="frozen",
        robots=X_SERVOS,
    ),
    Ending("SIGKILL program, adapter", kill("program", "emulator"), KILLED, end="unknown"),
    Ending(
        "SIGKILL planner, guardian", kill("planner", "guardian"), (1, 3), activities=("walking",),
    ),
    Ending(
        "SIGKILL planner, adapter", kill("planner", "emulator"), (1, 3), end="unknown",
        activities=("walking",),
    ),
    Ending("SIGKILL guardian, adapter", kill("guardian", "emulator"), BUS, end="unattended"),
    Ending("SIGKILL program, standard error closed", kill("program"), KILLED, errors="closed"),
    Ending("SIGKILL program, standard error unread", kill_unread, KILLED, errors="unread"),
    Ending("SIGTERM program, guardian", kill("program", "guardian", number=SIGTERM), ASKED),
    Ending("SIGSTOP guardian", kill("guardian", number=SIGSTOP), BUS, 2.0 * STOP),
)  # fmt: skip

HARDWARE = (
    Ending("unplugged 0.1 s", unplug(0.1), BUS, crouch=False, start="the port is back"),
    Ending("unplugged 0.5 s", unplug(0.5), BUS, crouch=False, start="the port is back"),
    Ending("unplugged 3 s", unplug(3.0), BUS, crouch=False, start="the port is back"),
    Ending("unplugged for good", unplug(inf), BUS, end="unknown"),
    Ending("brown-out 0.1 s", brown_out(0.1), FELL, crouch=False, start="supply is back"),
    Ending("brown-out 0.8 s", brown_out(0.8), FELL, crouch=False, start="supply is back"),
    Ending("servo resets", inject({"": "reset:ids=13"}), FELL, STOP + STALE, crouch=False),
    Ending("servo overloads", inject({"": "overload:ids=13"}), BUS, crouch=False),
    Ending("servo at 75 C", inject({"": "heat:ids=13:degrees=75"}), BUS, STOP + HEAT),
    Ending(
        "supply sinks", inject({"op3": "brown_out:volts=9:seconds=inf",
                                "duck": "brown_out:volts=5.5:seconds=inf"}),
        FELL, STOP + BELIEF,
    ),
    Ending("servo dies", inject({"": "dead:ids=13"}), FELL, STOP + STALE, crouch=False),
    Ending("IMU silent", inject({"": "imu_silent"}), FELL, STOP + BELIEF, activities=("walking",)),
    Ending("IMU frozen", inject({"": "imu_frozen"}), FELL, STOP + BELIEF, activities=("walking",)),
    Ending("IMU nan", own_fault, BUS, STOP + BELIEF, fault="imu nan", activities=("walking",)),
    Ending("IMU spins", inject({"": "imu_spin"}), FELL, STOP + BELIEF, activities=("walking",)),
    Ending(
        "network lost for 1 s", unplug(1.0), BUS, crouch=False, start="the network is back",
        robots=X_SERVOS, network=True,
    ),
    Ending("stop button", inject({"": "button"}), ASKED, robots=X_SERVOS),
)  # fmt: skip

SCRIPTS = (
    Ending("goes on after Ctrl-C", press(SIGINT), (2,), fault="goes on after Ctrl-C"),
    Ending("Ctrl-C, run in a thread", press(SIGINT), ASKED, fault="runs in a thread"),
    Ending(
        "exits between two calls", own_fault, (0,), fault="exits between two calls",
        activities=("standing",),
    ),
    Ending("os._exit", own_fault, (7,), fault="os._exit", activities=("standing",)),
    Ending("nobody reads its output", own_fault, FAILED, fault="nobody reads its output"),
)  # fmt: skip

LOOPS = (
    Ending(
        "SIGINT in a loop over ticks", press(SIGINT), ASKED, fault="loops over ticks",
        activities=("standing",),
    ),
    Ending(
        "loop over ticks blocks 0.3 s", own_fault, KILLED, HANG, fault="its loop blocks 0.3 s",
        activities=("standing",),
    ),
    Ending(
        "loop over ticks raises", own_fault, FAILED, fault="its loop raises",
        activities=("standing",),
    ),
)  # fmt: skip

ROWS = (*SIGNALS, *CONTROLLERS, *LOOPS, *KILLS, *HARDWARE, *SCRIPTS)
