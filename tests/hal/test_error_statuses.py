import pytest

from windup.hal import errors
from windup.hal.errors import UnknownNameError, WindupError, suggest


@pytest.mark.parametrize(
    ("kind", "status"),
    [
        (errors.WindupError, 1),
        (errors.UnsafeCommandError, 1),
        (errors.DivergedError, 1),
        (errors.ConfigError, 2),
        (errors.PluginError, 2),
        (errors.UsageError, 2),
        (errors.StateMissingError, 2),
        (errors.UnknownNameError, 2),
        (errors.PostureError, 2),
        (errors.StaleStateError, 3),
        (errors.FirstMotionError, 3),
        (errors.HardwareError, 3),
    ],
)
def test_every_error_knows_its_exit_status(kind: type[WindupError], status: int) -> None:
    assert issubclass(kind, WindupError)
    assert kind.exit_status == status


def test_every_error_of_the_stack_is_a_windup_error() -> None:
    own = [kind for kind in vars(errors).values() if isinstance(kind, type)]
    assert all(issubclass(kind, WindupError) for kind in own if issubclass(kind, Exception))


def test_a_likely_word_is_offered_only_where_there_is_one() -> None:
    assert suggest("knee", ["l_knee", "neck"]) == "; did you mean 'l_knee'? known: l_knee, neck"
    assert suggest("zzz", ["b", "a"]) == "; known: a, b"
    assert suggest("zzz", []) == "; known: none"


def test_names_that_begin_with_the_unknown_one_come_before_similar_ones() -> None:
    servos = ["STS3250", "STS3215-12V", "STS3215-7.4V"]
    hint = suggest("STS3215", servos)
    assert hint.startswith("; did you mean 'STS3215-12V' or 'STS3215-7.4V'? known: ")
    assert suggest("kne", ["knee", "kneel", "knob"]).startswith("; did you mean 'knee' or 'kneel'")
    assert suggest("a", ["abba", "acme", "adam", "aero"]).startswith("; known")
    assert str(UnknownNameError("pose", "stnd", ["stand"])) == (
        "unknown pose 'stnd'; did you mean 'stand'? known: stand"
    )
