"""The contract checker: passes what keeps the contract, and names who breaks which rule."""

import pytest

from runtime.check import Finding, check, traces
from runtime.launch import load
from runtime.params import ConfigurationError
from tests.recorded_session import LAUNCH

SAME, RESUMES = "same bytes under another hash seed", "same bytes after save and load"
ONCE, CAUSES = "drive answers every frame once", "outputs come on declared inputs"


def checked(tmp_path, fault: str) -> dict[str, Finding]:
    """Findings about the faulty part, by rule."""
    file = tmp_path / "faulty.toml"
    file.write_text(
        f"""
realm = "test/faulty"
[component.world]
run = "tests.runtime.parts.world"
inputs = {{ drive = "faulty/drive" }}
params = {{ frames = 12 }}
[component.faulty]
run = "tests.runtime.parts.faulty"
inputs = {{ image = "world/image" }}
params = {{ fault = "{fault}" }}
""",
        encoding="utf-8",
    )
    return {finding.rule: finding for finding in check(load(file), 1.0) if finding.component == "faulty"}


def test_every_component_of_the_simulation_keeps_the_contract():
    findings = check(load(LAUNCH), 3.0)
    assert [finding for finding in findings if not finding.kept] == []
    checked = {(finding.component, finding.rule) for finding in findings}
    folds = {spec.name for spec in load(LAUNCH).components}
    assert {name for name, rule in checked if rule == SAME} == folds
    assert {name for name, rule in checked if rule == CAUSES} == folds
    assert ("base", "actuate answers every frame once") in checked
    resumed = {f.component for f in findings if f.rule == RESUMES and not f.detail}
    assert {"pilot", "learner"} <= resumed


@pytest.mark.parametrize(
    ("fault", "broken"),
    [
        ("", set()),
        ("clock", {SAME, RESUMES}),
        ("hash order", {SAME}),
        ("twice", {ONCE}),
        ("silent", {ONCE}),
        ("forgetful", {RESUMES}),
        ("undeclared", {CAUSES}),
    ],
)
def test_each_broken_rule_is_found_and_no_other(tmp_path, fault, broken):
    findings = checked(tmp_path, fault)
    assert set(findings) == {SAME, RESUMES, ONCE, CAUSES}
    assert {rule for rule, finding in findings.items() if not finding.kept} == broken


def test_what_is_broken_is_said_with_its_place(tmp_path):
    assert checked(tmp_path, "undeclared")[CAUSES].detail.startswith("word came on image")
    assert "1 answered twice" in checked(tmp_path, "twice")[ONCE].detail


def test_only_lockstep_can_be_checked():
    with pytest.raises(ConfigurationError, match=r"session\.clock must be lockstep to be checked; got 'real'"):
        traces(load(LAUNCH, clock="real"), 1.0)


def test_a_launch_without_a_world_can_not_be_tried_and_says_so():
    with pytest.raises(ConfigurationError, match=r"look\.toml: can not be tried in one process: .*nobody answers"):
        check(load("launch/look.toml", clock="lockstep"), 1.0)
