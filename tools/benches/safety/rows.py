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
from windup.tools.benches.safety.row import HANG, STOP, Row

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
    Row("SIGINT", press(SIGINT), ASKED),
    Row("SIGINT x 2, 50 ms apart", press(SIGINT, 2, 0.05), ASKED),
    Row("SIGINT x 5, 50 ms apart", press(SIGINT, 5, 0.05), ASKED, STOP + 0.1, crouch=False),
    Row("SIGINT x 8, 20 ms apart", press(SIGINT, 8, 0.02), ASKED, STOP + 0.04, crouch=False),
    Row("SIGINT x 30, 100 ms apart", press(SIGINT, 30, 0.1), ASKED, STOP + 0.2, crouch=False),
    Row(
        "SIGINT x 4 in the crouch", press(SIGINT, 4, 0.1), ASKED, STOP + 0.2, crouch=False,
        activities=("closing crouch",),
    ),
    Row("SIGTERM", press(SIGTERM), ASKED),
    Row("SIGHUP", press(SIGHUP), ASKED),
    Row("SIGQUIT", press(SIGQUIT), ASKED),
    Row("SIGTSTP, SIGCONT", press_then(SIGTSTP, SIGCONT, 0.3), ASKED),
    Row("SIGSTOP for 1 s", press_then(SIGSTOP, SIGCONT, 1.0), KILLED, HANG),
    Row("SIGSTOP for ever", press(SIGSTOP), KILLED, HANG),
)  # fmt: skip

CONTROLLERS = (
    Row("controller raises", own_fault, FAILED, fault="raises"),
    Row("controller returns nan", own_fault, FAILED, fault="nan"),
    Row("controller returns a wrong shape", own_fault, FAILED, fault="wrong shape"),
    Row("controller blocks 0.3 s", own_fault, KILLED, HANG, fault="blocks 0.3 s"),
    Row("controller blocks for ever", own_fault, KILLED, HANG, fault="blocks"),
    Row("controller blocks in C", own_fault, KILLED, HANG, fault="blocks in C"),
    Row("controller spins", own_fault, KILLED, HANG, fault="spins"),
)

KILLS = (
    Row("SIGKILL program", kill("program"), KILLED),
    Row("SIGKILL planner", kill("planner"), FAILED, activities=("walking",)),
    Row("SIGKILL guardian", kill("guardian"), BUS),
    Row("SIGKILL adapter", kill("emulator"), BUS, end="unknown"),
    Row("SIGKILL program, planner", kill("program", "planner"), KILLED, activities=("walking",)),
    Row(
        "SIGKILL guardian, program", kill("guardian", "program"), KILLED, end="frozen",
        robots=X_SERVOS,
    ),
    Row("SIGKILL program, adapter", kill("program", "emulator"), KILLED, end="unknown"),
    Row("SIGKILL planner, guardian", kill("planner", "guardian"), (1, 3), activities=("walking",)),
    Row(
        "SIGKILL planner, adapter", kill("planner", "emulator"), (1, 3), end="unknown",
        activities=("walking",),
    ),
    Row("SIGKILL guardian, adapter", kill("guardian", "emulator"), BUS, end="unattended"),
    Row("SIGKILL program, standard error closed", kill("program"), KILLED, errors="closed"),
    Row("SIGKILL program, standard error unread", kill_unread, KILLED, errors="unread"),
    Row("SIGTERM program, guardian", kill("program", "guardian", number=SIGTERM), ASKED),
    Row("SIGSTOP guardian", kill("guardian", number=SIGSTOP), BUS, 2.0 * STOP),
)  # fmt: skip

HARDWARE = (
    Row("unplugged 0.1 s", unplug(0.1), BUS, crouch=False, start="the port is back"),
    Row("unplugged 0.5 s", unplug(0.5), BUS, crouch=False, start="the port is back"),
    Row("unplugged 3 s", unplug(3.0), BUS, crouch=False, start="the port is back"),
    Row("unplugged for good", unplug(inf), BUS, end="unknown"),
    Row("brown-out 0.1 s", brown_out(0.1), FELL, crouch=False, start="supply is back"),
    Row("brown-out 0.8 s", brown_out(0.8), FELL, crouch=False, start="supply is back"),
    Row("servo resets", inject({"": "reset:ids=13"}), FELL, STOP + STALE, crouch=False),
    Row("servo overloads", inject({"": "overload:ids=13"}), BUS, crouch=False),
    Row("servo at 75 C", inject({"": "heat:ids=13:degrees=75"}), BUS, STOP + HEAT),
    Row(
        "supply sinks", inject({"op3": "brown_out:volts=9:seconds=inf",
                                "duck": "brown_out:volts=5.5:seconds=inf"}),
        FELL, STOP + BELIEF,
    ),
    Row("servo dies", inject({"": "dead:ids=13"}), FELL, STOP + STALE, crouch=False),
    Row("IMU silent", inject({"": "imu_silent"}), FELL, STOP + BELIEF, activities=("walking",)),
    Row("IMU frozen", inject({"": "imu_frozen"}), FELL, STOP + BELIEF, activities=("walking",)),
    Row("IMU nan", own_fault, BUS, STOP + BELIEF, fault="imu nan", activities=("walking",)),
    Row("IMU spins", inject({"": "imu_spin"}), FELL, STOP + BELIEF, activities=("walking",)),
    Row(
        "network lost for 1 s", unplug(1.0), BUS, crouch=False, start="the network is back",
        robots=X_SERVOS, network=True,
    ),
    Row("stop button", inject({"": "button"}), ASKED, robots=X_SERVOS),
)  # fmt: skip

SCRIPTS = (
    Row("goes on after Ctrl-C", press(SIGINT), (2,), fault="goes on after Ctrl-C"),
    Row("Ctrl-C, run in a thread", press(SIGINT), ASKED, fault="runs in a thread"),
    Row(
        "exits between two calls", own_fault, (0,), fault="exits between two calls",
        activities=("standing",),
    ),
    Row("os._exit", own_fault, (7,), fault="os._exit", activities=("standing",)),
    Row("nobody reads its output", own_fault, FAILED, fault="nobody reads its output"),
)  # fmt: skip

LOOPS = (
    Row(
        "SIGINT in a loop over ticks", press(SIGINT), ASKED, fault="loops over ticks",
        activities=("standing",),
    ),
    Row(
        "loop over ticks blocks 0.3 s", own_fault, KILLED, HANG, fault="its loop blocks 0.3 s",
        activities=("standing",),
    ),
    Row(
        "loop over ticks raises", own_fault, FAILED, fault="its loop raises",
        activities=("standing",),
    ),
)  # fmt: skip

ROWS = (*SIGNALS, *CONTROLLERS, *LOOPS, *KILLS, *HARDWARE, *SCRIPTS)
