"""Which good replies answer the last request, and not another one or nobody's.

A servo answers once, in its turn. Two frames with one id, or one out of its turn, mean that a wrong
id has passed the checksum. What an earlier request is still owed comes first, since adapters keep
the order of bytes: a run of such replies before the order begins anew is stale.
"""

from collections import Counter
from collections.abc import Collection, Mapping, Sequence

from hal.protocols.protocol2 import Status


def newest(items: Sequence[Status], rows: Mapping[int, int], owed: Collection[int]) -> list[Status]:
    """Return the replies that are not certainly those to an earlier request.

    Args:
        items: Good frames of who was asked, in the order in which they came.
        rows: The ids that were asked, to their turns.
        owed: Ids that have not answered an earlier request.
    """
    runs: list[list[Status]] = [[]]
    for item in items:
        if runs[-1] and rows[item.id] <= rows[runs[-1][-1].id]:
            runs.append([])
        runs[-1].append(item)
    stale = 0
    while stale < len(runs) - 1 and all(item.id in owed for item in runs[stale]):
        stale += 1
    return [item for run in runs[stale:] for item in run]


def doubtful(items: Sequence[Status], rows: Mapping[int, int], owed: Collection[int]) -> bool:
    """Return True where all of the `newest` may be an earlier answer; for the arguments see there.

    Behind a stale reply come those that waited for it, to the last. With a newer one among them
    the order would have begun anew; without any, nobody may have heard the new request.
    """
    return len(items) < len(rows) and all(item.id in owed for item in items)


def in_turn(items: Sequence[Status], rows: Mapping[int, int]) -> list[Status]:
    """Return the replies that came once and in their turn; for the arguments see `newest`."""
    often = Counter(item.id for item in items)
    return _rising([item for item in items if often[item.id] == 1], rows)


def _rising(items: list[Status], rows: Mapping[int, int]) -> list[Status]:
    """Return the longest run of `items` whose turns rise."""
    best: list[list[Status]] = []
    for item in items:
        before = [run for run in best if rows[run[-1].id] < rows[item.id]]
        best.append([*max(before, key=len, default=[]), item])
    return max(best, key=len, default=[])
