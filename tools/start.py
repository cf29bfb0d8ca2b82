"""What comes before the first command to an armed robot: how it is, and its first motion."""

from control.first_motion import Approach, FirstMotion
from control.posture import Posture, PostureSense
from hal.controller import Controller
from hal.errors import PostureError
from hal.guard import GuardedBackend
from hal.servo_backend import ServoBackend
from robots import RobotDescription
from tools.protect import leg_joints, spread

LOOK = 0.3
"""How long the accelerometer is averaged, s."""
PERIOD = 0.01
"""Between two looks, s."""
CLEAR = 0.02
"""A robot of which something else is no higher than this above its feet rests on that too, m."""


class Start:
    """The start of one robot on a port of servos.

    Args:
        robot: The robot.
        backend: Its backend.
        port: URL of its port, as the user gave it.

    Attributes:
        motion: Its first motion.
        unseen: Torque has come on since somebody looked how it is.
    """

    def __init__(self, robot: RobotDescription, backend: GuardedBackend, port: str | None) -> None:
        self.robot, self.backend, self.port = robot, backend, port
        model, safety = robot.spec().compile(), robot.safety
        share = spread(safety.first_stiffness, leg_joints(robot, model))
        self.motion = FirstMotion(robot.joints, share, safety.first_speed, safety.first_lag)
        self._sense = None
        if robot.imu is not None and robot.feet:
            self._sense = PostureSense(model, [foot.body for foot in robot.feet])
        self.unseen = True
        if isinstance(backend.backend, ServoBackend):
            backend.backend.arming_stiffness = share * robot.joints.stiffness

    def begin(self) -> None:
        """Torque has come on."""
        self.motion.begin()
        self.unseen = True

    def before(self, controller: Controller) -> Approach:
        """Return `controller` with the first motion before it, where that is due."""
        return self.motion.before(controller)

    def check_upright(self) -> None:
        """Look at a robot that shall do what needs its feet.

        Raises:
            PostureError: It sits or lies.
        """
        posture, fall = self._look(), self.robot.fall
        if posture is None:
            return
        if posture.tilt > fall.tilt:
            how = f"lies on its {posture.side}"
        elif posture.height < fall.height or posture.clearance < CLEAR:
            how = "sits"
        else:
            return
        raise PostureError(f"{self.robot.name} {how}: put it on its feet{self._or_rise()}")

    def _look(self) -> Posture | None:
        """Return how the robot is, or None where it cannot be told."""
        if self._sense is None:
            return None
        seen, clock = [], self.backend.clock
        servos = self.backend.backend
        for _ in range(round(LOOK / PERIOD)):
            self.backend.heartbeat()
            seen.append(servos.read())
            clock.wait_until(clock.now() + PERIOD)
        if seen[-1].joints.age.max() > LOOK:
            return None  # arming will say which servo is silent
        return self._sense.posture(seen)

    def _or_rise(self) -> str:
        """Return what else a person can do, for those robots that get up by themselves."""
        if "get_up_front" not in self.robot.gaits():
            return ""
        arm = "" if self.port is None or self.port.startswith("twin://") else " --arm"
        return f", or run `windup rise {self.robot.name} --port {self.port}{arm}`"
