from functools import partial

from windup.sim_twin.wire.protocols.protocol1 import FEETECH, Protocol1
from windup.sim_twin.wire.servos.plain_servo import PlainServo
from windup.sim_twin.wire.world.emulation import Emulation

from .family import FAMILY

EMULATION = Emulation(partial(PlainServo, FAMILY, {"shutdown": 36}), partial(Protocol1, FEETECH))
