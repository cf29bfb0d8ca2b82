"""Split-phase reads on one port: request, compute, collect, with deadlines from the wire time."""

from collections import Counter
from collections.abc import Iterable
from math import inf

import numpy as np

from windup.hal.joints import Mask
from windup.hal.port.port import BITS, PLENTY, Port
from windup.hal.protocols.batched1 import ChainRead
from windup.hal.protocols.cyclic import CyclicRead

SLACK = 2e-3
"""Delay that the host and its driver may add to the time on the wire, s."""
TURNAROUND = 20e-6
"""Time that a servo with a return delay of 0 takes to answer, s."""
UNSET_TURNAROUND = 550e-6
"""Time that a servo with the factory default return delay takes to answer, s."""
MAX_EXTRA_BYTES = 256
"""Maximum number of extra bytes before an answer (noise, or an echo of the adapter)."""
LATE_ANSWER_TIME = 0.03
"""Time after an unanswered request in which a late answer may still come, s."""
JITTER = 1e-4
"""Jitter of the answer time of a servo, s."""
LATE_SERVO_PAUSE = 3e-3
"""Pause after an incomplete answer, for late servos to finish before the next request, s."""
MAX_LATE = 6
"""Number of unanswered requests after which a servo counts as missing, not late."""
MAX_DOUBTED = 2
"""Number of consecutive doubtful answers after which requests pause until the line is quiet."""


_NOBODY: Mask = np.zeros(0, dtype=bool)


class BusTransactions:
    """The cyclic transactions of one port.

    The wire time of all bytes sent is tracked, so that the deadline of a request after a long
    write is later, and no answer is waited for longer than it can take.

    Attributes:
        port: The port.
        errors: Number of errors by kind: "no answer" and "corrupt" count servos,
            "resynchronised" counts answers with missing replies, "implausible" counts
            servos whose valid frame contained impossible values.
        stuffed: Number of complete answers that were longer than the layout, by byte stuffing or
            noise; this is not an error.
        cycles: Number of answers collected.
        turnaround: Time that each servo takes before it answers, s; `TURNAROUND` once its return
            delay has been set to 0.
    """

    def __init__(self, port: Port) -> None:
        self.port = port
        self.errors: Counter[str] = Counter()
        self.cycles = 0
        self.stuffed = 0
        self.turnaround = UNSET_TURNAROUND
        self._wire_free = 0.0
        self._deadline = 0.0
        self._pending: CyclicRead | None = None
        self._owed: dict[int, int] = {}  # id: number of unanswered requests
        self._parts_owed: dict[int, float] = {}  # id: until when a late single answer may come, s
        self._whole_owed = -inf  # until when a fast answer may still come, s
        self._silence = 0.0
        self._doubts = 0
        self._quiet = 0.0  # until when no request is sent, s

    def move_to(self, port: Port) -> None:
        """Continue on another port; requests pending on the old one are dropped."""
        self.port = port
        self._wire_free = self._deadline = self._silence = self._quiet = 0.0
        self._pending = None
        self._owed, self._parts_owed = {}, {}
        self._whole_owed = -inf

    def send(self, frames: Iterable[bytes]) -> None:
        """Send frames that are not answered."""
        for frame in frames:
            self.port.write(frame)
            self._occupy(len(frame))

    def request(self, read: CyclicRead, rest: bool = False) -> None:
        """Send the request of `read`; input received before is discarded as too late.

        Args:
            read: The read to request.
            rest: If the line has to fall quiet first, send nothing instead of waiting.
        """
        if rest and self._quiet > self.port.clock.now():
            self._pending = None
            return
        if isinstance(read, ChainRead):
            read.begin()
            self._ask(read.parts[0])
        else:
            self._ask(read)
        self._pending = read

    def collect(self) -> Mask:
        """Return (n,) bool: which servos answered in time; an empty array without a request."""
        read, self._pending = self._pending, None
        if read is None:
            return _NOBODY
        self.cycles += 1
        if isinstance(read, ChainRead):
            return self._collect_chain(read)
        read.owed = self._owed
        stream = self._answer(read)
        if not read.echo_is_confusable and self.port.clock.now() < self._whole_owed:
            self._decode_if_alone(read, stream)
        else:
            if self._owed:
                stream = self._newest(read, stream)
            read.decode(stream)
            if not read.complete:
                self._resynchronise(read, stream)
        self._note_owed(read)
        return read.valid

    def _answer(self, read: CyclicRead) -> bytes:
        """Read up to `read.length` bytes; an echo of the request in front of them is removed."""
        stream = self.port.read(read.length, self._deadline)
        request = read.request
        if stream and request.startswith(stream[: len(request)]):
            stream += self.port.read(len(request), self._deadline)
            if stream.startswith(request):
                return stream[len(request) :]
        return stream

    def _newest(self, read: CyclicRead, stream: bytes) -> bytes:
        """Return `stream` as far as it can be the answer, while late ones may still arrive.

        A late answer held back by the adapter comes sooner than the wire time of the new answer
        allows, or is followed by more bytes.
        """
        now = self.port.clock.now()
        if len(stream) < read.length:
            return stream + self.port.read(PLENTY, now)
        soonest = self._wire_free + (read.length - 1) * BITS / self.port.baud
        if now < soonest:
            self.port.read(PLENTY, now)
            return b""
        last = now + len(read.spans) * self.turnaround + self.port.latency + JITTER
        return stream + self.port.read(PLENTY, last)

    def _decode_if_alone(self, read: CyclicRead, stream: bytes) -> None:
        """Decode an answer only if it is complete and alone: a late one may still arrive."""
        stream = self._newest(read, stream)
        read.decode(stream if len(stream) == read.length else b"")
        if not read.complete:
            self._count_lost(read, stream)

    def _note_owed(self, read: CyclicRead) -> None:
        """Record which servos still owe an answer, including those whose reply was doubtful.

        If a servo is late, so are all after it: the next request waits for them, at most `MAX_LATE`
        times. A single silent servo is not waited for. After `MAX_DOUBTED` doubtful answers in a
        row, requests pause until the line is quiet.
        """
        now = self.port.clock.now()
        self._doubts = self._doubts + 1 if read.doubted else 0
        if self._doubts == MAX_DOUBTED:
            self._owed, self._doubts, self._quiet = {}, 0, now + LATE_ANSWER_TIME
            return
        if read.complete:
            self._owed, self._whole_owed = {}, -inf
            return
        if not read.echo_is_confusable:
            self._whole_owed = now + LATE_ANSWER_TIME
            return
        silent = [span.id for span, came in zip(read.spans, read.valid, strict=True) if not came]
        answered = {span.id for span in read.spans}.difference(silent)
        still = {id: count for id, count in self._owed.items() if id not in answered}
        self._owed = still | {id: still.get(id, 0) + 1 for id in silent}
        late = self._owed.get(read.spans[-1].id, 0)
        if len(silent) > 1 and 0 < late <= MAX_LATE:
            self._silence = self._deadline + LATE_SERVO_PAUSE

    def _collect_chain(self, chain: ChainRead) -> Mask:
        """Collect the first answer of a chain, then request and collect the others one by one."""
        for row, part in enumerate(chain.parts):
            if row:
                self._ask(part)
            self._collect_part(part)
            chain.collected(row)
        return chain.valid

    def _collect_part(self, part: CyclicRead) -> None:
        """Collect the answer of one servo; a late one is recognised by bytes after it."""
        id = part.spans[0].id
        stream, now = self._answer(part), self.port.clock.now()
        if id in self._owed or now < self._parts_owed.get(id, -inf):
            self._decode_if_alone(part, stream)
        else:
            part.decode(stream)
            if not part.complete:
                self._resynchronise(part, stream)
        if part.complete:
            self._owed.pop(id, None)
        elif now >= self._parts_owed.get(id, -inf):
            self._parts_owed[id] = now + LATE_ANSWER_TIME

    def answer_time(self, read: CyclicRead) -> float:
        """Return the maximum time from the end of the request of `read` to its full answer, s."""
        wire = read.length * BITS / self.port.baud
        return wire + len(read.spans) * self.turnaround + self.port.latency + SLACK

    def _ask(self, read: CyclicRead) -> None:
        until = max(self._silence, self._quiet)
        if until > self.port.clock.now():
            self.port.clock.wait_until(until)
        self.port.flush_input()
        self.port.write(read.request)
        self._occupy(len(read.request))
        self._deadline = self._wire_free + self.answer_time(read)

    def _resynchronise(self, read: CyclicRead, stream: bytes) -> None:
        """Read and decode more bytes until the deadline: stuffing, noise or loss moved replies."""
        while not read.complete and self.port.clock.now() < self._deadline:
            more = self.port.read(max(1, read.length - len(stream)), self._deadline)
            if not more:
                break
            stream += more
            if len(stream) > 2 * read.longest + MAX_EXTRA_BYTES:
                break
            read.decode(stream)
        if read.complete:
            self.stuffed += 1
        else:
            self._count_lost(read, stream)

    def _count_lost(self, read: CyclicRead, stream: bytes) -> None:
        """Count the replies that are missing in an answer."""
        self.errors["resynchronised"] += 1
        kind = "corrupt" if len(stream) > read.answered_bytes() else "no answer"
        self.errors[kind] += int((~read.valid).sum())

    def _occupy(self, count: int) -> None:
        start = max(self._wire_free, self.port.clock.now())
        self._wire_free = start + count * BITS / self.port.baud
