from windup.tools.checking.findings import Findings


def test_the_worst_comes_last() -> None:
    found = Findings(errors=["a"], warnings=["b", "c"], notes=["d"])
    assert found.lines() == ["note: d", "warning: b", "warning: c", "error: a"]
    assert found.verdict("rex") == "rex: 1 error, 2 warnings"
