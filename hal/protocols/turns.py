"""Which good replies answer the last request, and not another one or nobody's.

A servo answers once, in its turn. Two frames with one id, or one out of its turn, mean that a wrong
id has passed the checksum. What an earlier request is still owed comes first, since adapters keep
the order of bytes: a run of such replies before the order begins anew is stale.

Replies of ids that were not asked are among `items` wherever a protocol can tell them from noise:
somebody has sent each of them in a turn of his own.
"""

from collections import Counter
from collections.abc import Mapping, Sequence

from windup.hal.protocols.protocol2 import Status


def newest(
    items: Sequence[Status], rows: Mapping[int, int], owed: Mapping[int, int]
) -> list[Status]:
    """Return the replies that are certainly not those to an earlier request.

    Behind a stale reply come those that waited for it, to the last. With a newer one among them
    the order would have begun anew; without any, nobody may have heard the new request. And where
    fewer answers came than are owed, the last one is no newer than the others.

    Args:
        items: Good frames, in the order in which they came.
        rows: The ids that were asked, to their turns.
        owed: Ids that have not answered earlier requests, to the number of those.

    Returns:
        The last answer, or what there is of it; nothing where all of it may be an earlier one.
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
    """Return the items in runs of rising turns; who was not asked has none."""
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
    """Return the ids of those who were asked."""
    return [item.id for item in items if item.id in rows]


def in_turn(items: Sequence[Status], rows: Mapping[int, int]) -> list[Status]:
    """Return the replies that came once and in their turn; for the arguments see `newest`.

    A reply has its turn where at least as many ids were asked before it as frames came before it,
    and as many behind it, and between it and the others that have theirs. What two longest choices
    of such replies do not agree on is left out.
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
    """Return what all longest runs of (frame, turn) share in which turns keep up with frames."""
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
