from pathlib import Path

import pytest

from windup.hal.config import TomlRecord, load_toml
from windup.hal.errors import ConfigError


class Wheel(TomlRecord, frozen=True):
    radius: float
    spokes: int = 8


class Cart(TomlRecord, frozen=True):
    name: str
    wheels: list[Wheel] = []


GOOD = 'name = "cart"\nwheels = [{ radius = 0.5 }]\n'


def load(folder: Path, text: str) -> Cart:
    path = folder / "cart.toml"
    path.write_text(text)
    return load_toml(path, Cart)


def test_a_file_becomes_a_typed_record(tmp_path: Path) -> None:
    assert load(tmp_path, GOOD) == Cart(name="cart", wheels=[Wheel(radius=0.5)])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('nam = "cart"', "unknown key 'nam'; did you mean 'name'? known: name, radius, spokes, "),
        (
            'name = "cart"\nwheels = [{ radius = 1.0, spoke = 3 }]',
            "unknown key 'wheels[0].spoke'; did you mean 'spokes'? known: name, radius, spokes, ",
        ),
        ("name = 3", "name: Expected `str`, got `int`"),
        (
            'name = "cart"\nwheels = [{ radius = "big" }]',
            "wheels[0].radius: Expected `float`, got `str`",
        ),
        ('name = "cart"\nwheels = [{ radius = nan }]', "wheels[0].radius: nan is not finite"),
        ('name = "cart"\nwheels = [{ radius = -inf }]', "wheels[0].radius: -inf is not finite"),
        (
            'name = "cart"\nwheels = [{ radius = 1e300 }]',
            "wheels[0].radius: 1e+300 is too large (maximum",
        ),
        (
            'name = "cart"\nwheels = [{ radius = 1.0, spokes = 1000000000000000000000 }]',
            "is too large (maximum 1e+12)",
        ),
        ("", "cart.toml: missing: name"),
        ("wheels = [{}, {}]", "cart.toml: missing: name, wheels[0].radius, wheels[1].radius"),
        ("name = 'cart'\nwheels = [" + 20 * "{}," + "]", ", wheels[11].radius and 8 more"),
        ("name = " + 9999 * "[", "not TOML: "),
        ("name = " + 5000 * "9", "not TOML: "),
        ('name = "cart', "not TOML: "),
    ],
    ids=[
        "unknown key",
        "unknown key inside",
        "wrong type",
        "wrong type inside",
        "nan",
        "infinite",
        "huge",
        "huge integer",
        "missing",
        "several missing",
        "many missing",
        "deep",
        "long number",
        "TOML",
    ],
)
def test_what_does_not_fit_is_one_line_with_file_and_key(
    tmp_path: Path, text: str, message: str
) -> None:
    with pytest.raises(ConfigError) as error:
        load(tmp_path, text)
    assert str(error.value).startswith(f"{tmp_path / 'cart.toml'}: ")
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_a_byte_order_mark_is_no_mistake(tmp_path: Path) -> None:
    assert load(tmp_path, "\ufeff" + GOOD) == load(tmp_path, GOOD)


def test_a_missing_file_says_so(tmp_path: Path) -> None:
    path = tmp_path / "none.toml"
    with pytest.raises(ConfigError) as error:
        load_toml(path, Cart)
    assert str(error.value) == f"{path}: cannot be read: No such file or directory"


def test_a_file_that_is_no_text_is_an_error_of_ours(tmp_path: Path) -> None:
    path = tmp_path / "cart.toml"
    path.write_bytes(b'name = "\xff\xfe"')
    with pytest.raises(ConfigError, match="not TOML"):
        load_toml(path, Cart)


def test_a_device_is_not_read() -> None:
    with pytest.raises(ConfigError, match="/dev/zero: cannot be read: this is a device"):
        load_toml(Path("/dev/zero"), Cart)
