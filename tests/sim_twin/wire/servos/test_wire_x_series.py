"""The control tables against those that ROBOTIS ships with its SDK."""

from pathlib import Path

import dynamixel_sdk
import pytest

from windup.sim_twin.wire.servos.x_series import FOUR_MODES, MODELS, SIX_MODES, model

TABLES = Path(dynamixel_sdk.__file__).parent.parent / "dynamixel_easy_sdk" / "control_table"
RENAMED = {
    "secondary_shadow_id": "secondary_id",
    "present_load": "present_current",  # one address, two meanings
}


def robotis_table(number: int) -> dict[str, tuple[int, int]]:
    lines = (TABLES / "dynamixel.model").read_text().splitlines()
    files = dict(line.split("\t")[:2] for line in lines if line[:1].isdigit())
    text = (TABLES / files[str(number)]).read_text().split("[control table]")[1]
    table = {}
    for line in text.splitlines():
        if line[:1].isdigit():
            address, size, name = line.split("\t")[:3]
            key = name.strip().lower().replace("(", "_").replace(")", "").replace(" ", "_")
            table[RENAMED.get(key, key)] = (int(address), int(size))
    return table


@pytest.mark.skipif(not TABLES.exists(), reason="this dynamixel-sdk has no tables")
@pytest.mark.parametrize("name", MODELS)
def test_addresses_and_sizes_are_those_of_the_maker(name: str) -> None:
    items = MODELS[name].registers().items
    theirs = robotis_table(MODELS[name].number)
    ours = {key: (item.address, item.size) for key, item in items.items()}
    both = ours.keys() & theirs.keys()
    assert {key: ours[key] for key in both} == {key: theirs[key] for key in both}
    assert {"id", "goal_position", "present_position", "bus_watchdog"} <= both
    unknown = {key for key in theirs.keys() - ours.keys() if "indirect" not in key}
    assert unknown == set()


def test_servos_without_a_current_sensor_report_load_and_have_no_current_modes() -> None:
    without = {name for name, table in MODELS.items() if table.current_unit is None}
    assert without == {"XL430-W250", "XC430-W240", "XC430-W150", "2XL430-W250", "2XC430-W250"}
    for name, table in MODELS.items():
        assert table.modes == (FOUR_MODES if name in without else SIX_MODES)
        assert ("current_limit" in table.registers().items) == (name not in without)


def test_two_axis_servos_know_no_fast_sync_read_and_the_x330_since_firmware_46() -> None:
    assert model("2XL430").fast_since is None
    assert model("2XC430").fast_since is None
    assert model("XL330").fast_since == 46
