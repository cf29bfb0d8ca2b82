"""What the broker and the loop tell each other through the queues of the board."""

from typing import Final

import msgspec

from windup.tools.remote.messages import Change, Down, End, Ended, Refused, Run, Started


class Order(msgspec.Struct, frozen=True):
    """Broker to loop: a client's request.

    Attributes:
        client: Number of the client.
        message: The request.
    """

    client: int
    message: Run | Change | End | Down


class Report(msgspec.Struct, frozen=True):
    """Loop to broker: an answer to a client.

    Attributes:
        client: Number of the client.
        message: The answer.
    """

    client: int
    message: Started | Ended | Refused


ORDERS: Final = msgspec.json.Decoder(Order)
REPORTS: Final = msgspec.json.Decoder(Report)
