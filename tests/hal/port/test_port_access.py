import os
import stat

import pytest

from windup.hal.port.port_access import User, access_remedy, permission_remedy

ME, DIALOUT = 1000, 20
JOIN = "sudo usermod -aG dialout $USER"


@pytest.fixture(autouse=True)
def dialout_is_a_group(monkeypatch: pytest.MonkeyPatch) -> None:
    names = {0: "root", DIALOUT: "dialout"}
    monkeypatch.setattr("windup.hal.port.port_access._group", lambda gid: names[gid])


def _device(mode: int, uid: int, gid: int) -> os.stat_result:
    return os.stat_result((stat.S_IFCHR | mode, 0, 0, 1, uid, gid, 0, 0, 0, 0))


def _person(groups: set[int] | None = None, member: set[int] | None = None) -> User:
    has = frozenset(groups or {ME})
    return User(ME, has, has | (member or set()))


def test_a_group_that_may_open_it_can_be_joined() -> None:
    assert JOIN in permission_remedy(_device(0o660, 0, DIALOUT), _person())


def test_nobody_is_told_to_join_the_group_root() -> None:
    said = permission_remedy(_device(0o660, 0, 0), _person())
    assert "usermod" not in said
    assert "crw-rw---- root root" in said


@pytest.mark.parametrize("mode", [0o600, 0o620, 0o640])
def test_a_group_that_may_not_open_it_is_not_worth_joining(mode: int) -> None:
    said = permission_remedy(_device(mode, 0, DIALOUT), _person())
    assert "usermod" not in said
    assert "udev rule" in said


def test_a_group_joined_since_the_login_wants_another_login() -> None:
    said = permission_remedy(_device(0o660, 0, DIALOUT), _person(member={DIALOUT}))
    assert said == "you have joined its group dialout since you logged in: log in again"


def test_a_device_of_ones_own_wants_other_bits() -> None:
    assert "chmod u+rw" in permission_remedy(_device(0o400, ME, DIALOUT), _person())


def test_a_mode_that_allows_it_points_elsewhere() -> None:
    device = _device(0o660, 0, DIALOUT)
    assert "a container, or a security module" in permission_remedy(device, _person({DIALOUT}))
    root = User(0, frozenset([0]), frozenset([0]))
    assert "a container, or a security module" in permission_remedy(_device(0o600, 0, 0), root)


def test_this_process_is_asked_by_default() -> None:
    assert User.present().uid == os.geteuid()
    assert access_remedy("/dev/null").startswith("it is crw-rw-rw- root root")
