"""Selects the replies that belong to the last request, and rejects stale or wrong ones.

Each servo answers once, in the order of the request. Two replies with the same id, or a reply out
of order, show that a wrong id has passed the checksum. Late replies to an earlier request come
first, since adapters keep the order of bytes: a run of them before the order restarts is stale.

Replies with ids that were not asked are among `items` if the protocol can tell them from noise:
each of them was sent by a servo in a position of the order of its own.
"""

from collections import Counter
from collections.abc import Mapping, Sequence

from windup.hal.protocols.protocol2 import Status


def current_replies(
    items: Sequence[Status], rows: Mapping[int, int], owed: Mapping[int, int]
) -> list[Status]:
    """Return the replies that certainly do not belong to an earlier request.

    A stale reply is followed by all the replies that waited for it, up to the last. If newer
    replies were among them, the order would have restarted; if there are none, the servos may not
    have received the new request. If fewer answers came than are owed, the last may be stale too.

    Args:
        items: Valid status packets, in the order of arrival.
        rows: Maps each requested id to its position in the request.
        owed: Maps id to the number of earlier requests that it has not answered.

    Returns:
        The replies of the last answer; empty if all of them may belong to an earlier one.
    """
    runs = _runs(items, rows)
    stale = 0
    while stale < len(runs) - 1 and all(id in owed for id in _asked(runs[stale], rows)):
        stale += 1
    left = [item for run in runs[stale:] for item in run]
    asked = _asked(left, rows)
    if not all(id in owed for id in asked):
        return left
    late = 0 < stale < max((owed[id] for id in asked), default=0)
    return [] if late or len(asked) < len(rows) else left


def _runs(items: Sequence[Status], rows: Mapping[int, int]) -> list[list[Status]]:
    """Split the items into runs of rising position; ids that were not asked have no position."""
    runs: list[list[Status]] = [[]]
    last = -1
    for item in items:
        row = rows.get(item.id)
        if row is not None:
            if row <= last:
                runs.append([])
            last = row
        runs[-1].append(item)
    return runs


def _asked(items: Sequence[Status], rows: Mapping[int, int]) -> list[int]:
    """Return the ids of the items that were asked."""
    return [item.id for item in items if item.id in rows]


def in_order(items: Sequence[Status], rows: Mapping[int, int]) -> list[Status]:
    """Return the replies that came once and in order; for the arguments see `current_replies`.

    A reply is in order if at least as many ids were asked before it as frames came before it, the
    same holds after it, and between it and the other accepted replies. If there are several longest
    selections of such replies, only those common to all are returned.
    """
    frames = [item for at, item in enumerate(items) if at == 0 or item != items[at - 1]]
    often = Counter(item.id for item in frames)
    known = [
        (at, rows[item.id])
        for at, item in enumerate(frames)
        if often[item.id] == 1 and item.id in rows
    ]
    spare = len(rows) - len(frames)
    ahead = _longest([(at, row) for at, row in known if 0 <= row - at <= spare])
    return [frames[at] for at, _ in ahead]


def _longest(places: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return the elements common to all longest chains of (frame, position) under `_follows`."""
    before = [0] * len(places)
    behind = [0] * len(places)
    for here, place in enumerate(places):
        before[here] = 1 + max(
            (before[k] for k in range(here) if _follows(places[k], place)), default=0
        )
    for here in reversed(range(len(places))):
        later = range(here + 1, len(places))
        behind[here] = 1 + max(
            (behind[k] for k in later if _follows(places[here], places[k])), default=0
        )
    most = max(before, default=0)
    within = [k for k in range(len(places)) if before[k] + behind[k] - 1 == most]
    rivals = Counter(before[k] for k in within)
    return [places[k] for k in within if rivals[before[k]] == 1]


def _follows(first: tuple[int, int], second: tuple[int, int]) -> bool:
    return second[1] - first[1] >= second[0] - first[0]
