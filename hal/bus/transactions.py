"""Split-phase reads on one port: ask, compute, collect, with deadlines from the wire itself."""

from collections import Counter
from collections.abc import Iterable
from math import inf

import numpy as np

from windup.hal.joints import Mask
from windup.hal.port.port import BITS, PLENTY, Port
from windup.hal.protocols.batched1 import ChainRead
from windup.hal.protocols.cyclic import CyclicRead

SLACK = 2e-3
"""What the host and its driver may add to the time on the wire, s."""
TURNAROUND = 20e-6
"""What a servo with a return delay of 0 takes to answer, s."""
UNSET_TURNAROUND = 550e-6
"""The same as it leaves the factory, s."""
STRANGE = 256
"""Bytes that may come before an answer: noise, or what an adapter gives back."""
STILL_COMING = 0.03
"""So long after a request that got no answer one may still come, s."""
JITTER = 1e-4
"""What a servo may answer later than it should, s."""
GRACE = 3e-3
"""Silence granted to servos that are late, before all are asked again, s."""
LATE = 6
"""Requests without an answer after which a servo is not late, but gone."""
DOUBTS = 2
"""Doubtful answers, one behind the other, after which the line is let fall quiet."""


_NOBODY: Mask = np.zeros(0, dtype=bool)


class BusTransactions:
    """The cyclic traffic of one port.

    The time on the wire of everything sent is kept in mind, so that a request behind a long
    write has its deadline moved, and no answer is waited for longer than it can take.

    Attributes:
        port: The port.
        errors: Kind of error to how often it happened: "no answer" and "corrupt" count servos,
            "resynchronised" counts answers in which something was lost, "implausible" counts
            servos whose good frame said what cannot be.
        stuffed: Answers that were longer than plain and all there: data that looked like a header
            was stuffed, or noise came with them, which is no error.
        cycles: Answers collected.
        turnaround: What each servo takes before it answers, s; `TURNAROUND` once its return
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
        self._owed: dict[int, int] = {}  # who has not answered, and how often by now
        self._parts_owed: dict[int, float] = {}  # who may still answer alone, and until when, s
        self._whole_owed = -inf  # until when a fast answer may still come, s
        self._silence = 0.0
        self._doubts = 0
        self._quiet = 0.0  # until when nobody is to be asked, s

    def move_to(self, port: Port) -> None:
        """Go on over another port; what was asked on the old one is forgotten."""
        self.port = port
        self._wire_free = self._deadline = self._silence = self._quiet = 0.0
        self._pending = None
        self._owed, self._parts_owed = {}, {}
        self._whole_owed = -inf

    def send(self, frames: Iterable[bytes]) -> None:
        """Send frames that nobody answers."""
        for frame in frames:
            self.port.write(frame)
            self._occupy(len(frame))

    def request(self, read: CyclicRead, rest: bool = False) -> None:
        """Ask; input that has come before is too late for whatever it answered.

        Args:
            read: What to ask.
            rest: Rather ask nobody than wait, where the line has to fall quiet.
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
        """Return (n,) bool: who answered the request in time; all False without a request."""
        read, self._pending = self._pending, None
        if read is None:
            return _NOBODY
        self.cycles += 1
        if isinstance(read, ChainRead):
            return self._collect_chain(read)
        read.owed = self._owed
        stream = self._answer(read)
        if not read.confusable and self.port.clock.now() < self._whole_owed:
            self._alone(read, stream)
        else:
            if self._owed:
                stream = self._newest(read, stream)
            read.decode(stream)
            if not read.complete:
                self._resynchronise(read, stream)
        self._note_owed(read)
        return read.valid

    def _answer(self, read: CyclicRead) -> bytes:
        """Return as many bytes as the answer has, without the request if that came back."""
        stream = self.port.read(read.length, self._deadline)
        request = read.request
        if stream and request.startswith(stream[: len(request)]):
            stream += self.port.read(len(request), self._deadline)
            if stream.startswith(request):
                return stream[len(request) :]
        return stream

    def _newest(self, read: CyclicRead, stream: bytes) -> bytes:
        """Return `stream` as far as it can be an answer, where earlier ones may still be coming.

        What an adapter held back comes sooner than the wire can carry an answer, or has more
        behind it.
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

    def _alone(self, read: CyclicRead, stream: bytes) -> None:
        """Take in an answer that must be whole and alone: an earlier one may still be coming."""
        stream = self._newest(read, stream)
        read.decode(stream if len(stream) == read.length else b"")
        if not read.complete:
            self._count_lost(read, stream)

    def _note_owed(self, read: CyclicRead) -> None:
        """Remember who was asked and has not answered, also where a reply may have been another's.

        Where a servo is late, so are all behind it: they are let finish before the next request,
        a few times. One that is silent alone is not waited for. Where answers go on being doubtful,
        the line is let fall quiet.
        """
        now = self.port.clock.now()
        self._doubts = self._doubts + 1 if read.doubted else 0
        if self._doubts == DOUBTS:
            self._owed, self._doubts, self._quiet = {}, 0, now + STILL_COMING
            return
        if read.complete:
            self._owed, self._whole_owed = {}, -inf
            return
        if not read.confusable:
            self._whole_owed = now + STILL_COMING
            return
        silent = [span.id for span, came in zip(read.spans, read.valid, strict=True) if not came]
        answered = {span.id for span in read.spans}.difference(silent)
        still = {id: count for id, count in self._owed.items() if id not in answered}
        self._owed = still | {id: still.get(id, 0) + 1 for id in silent}
        late = self._owed.get(read.spans[-1].id, 0)
        if len(silent) > 1 and 0 < late <= LATE:
            self._silence = self._deadline + GRACE

    def _collect_chain(self, chain: ChainRead) -> Mask:
        """Take in the first answer of a chain, then ask and take in one after the other."""
        for row, part in enumerate(chain.parts):
            if row:
                self._ask(part)
            self._collect_part(part)
            chain.collected(row)
        return chain.valid

    def _collect_part(self, part: CyclicRead) -> None:
        """Take in the answer of one servo; an earlier one that comes late has another behind it."""
        id = part.spans[0].id
        stream, now = self._answer(part), self.port.clock.now()
        if id in self._owed or now < self._parts_owed.get(id, -inf):
            self._alone(part, stream)
        else:
            part.decode(stream)
            if not part.complete:
                self._resynchronise(part, stream)
        if part.complete:
            self._owed.pop(id, None)
        elif now >= self._parts_owed.get(id, -inf):
            self._parts_owed[id] = now + STILL_COMING

    def answer_time(self, read: CyclicRead) -> float:
        """Return how long the answer to `read` may take once the request is on the wire, s."""
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
        """Wait for what stuffing, noise or a lost byte has moved back, and keep what is good."""
        while not read.complete and self.port.clock.now() < self._deadline:
            more = self.port.read(max(1, read.length - len(stream)), self._deadline)
            if not more:
                break
            stream += more
            if len(stream) > 2 * read.longest + STRANGE:
                break
            read.decode(stream)
        if read.complete:
            self.stuffed += 1
        else:
            self._count_lost(read, stream)

    def _count_lost(self, read: CyclicRead, stream: bytes) -> None:
        """Count who is missing in an answer."""
        self.errors["resynchronised"] += 1
        kind = "corrupt" if len(stream) > read.answered() else "no answer"
        self.errors[kind] += int((~read.valid).sum())

    def _occupy(self, count: int) -> None:
        start = max(self._wire_free, self.port.clock.now())
        self._wire_free = start + count * BITS / self.port.baud
