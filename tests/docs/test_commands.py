"""Every command of the documentation is one that exists; the pages to follow are followed, shortened as they say.

`make docs-check` follows all pages, whole, in a fresh clone.
"""

import os
import subprocess
import sys

import pytest

from runtime.launch import load
from tests.docs.calls import parsed
from tests.docs.page import MARKS, ROOT, blocks, pages, write_file
from tests.docs.sandbox import Sandbox

MADE = ("pilot.policy=", "pilot.task=", "task=", "learner.method=replaying")
"""What a page sets to something that an earlier step of it makes."""
DEADLINE_S = 300.0
"""Of the commands of one block, on a busy machine."""


def ids(page):
    return str(page.relative_to(ROOT))


def check_overrides(given):
    """A launch file that is there takes what is set."""
    launch, overrides = given.get("launch"), given.get("overrides") or ()
    if launch is not None and (ROOT / launch).exists():
        load(ROOT / launch, [each for each in overrides if not each.startswith(MADE)])


@pytest.mark.parametrize("page", pages(), ids=ids)
def test_every_call_of_berth_on_the_page_is_understood(page):
    for block in blocks(page):
        assert not block.mark or block.mark.startswith(MARKS), block.mark
        for words in block.calls if block.kind == "sh" else ():
            check_overrides(parsed(words)[1])


def test_a_call_with_an_option_that_does_not_exist_is_found():
    with pytest.raises(Exception, match="--recrod"):
        parsed(["run", "launch/sim.toml", "--recrod", "x"])


def follow(page, folder):
    """Type what the page says; returns what was said, block by block."""
    sandbox, said = Sandbox(folder), []
    for block in blocks(ROOT / page):
        if block.file:
            write_file(folder, block)
        elif block.kind == "sh" and (not block.mark or block.mark.startswith("shortened")):
            said.append(sandbox.run(block, DEADLINE_S))
    return said


def test_the_tutorial_leads_from_a_first_session_to_a_drive_with_a_policy_learned_again(tmp_path):
    learned, looked, relearned, drove = follow("docs/tutorial.md", tmp_path)
    assert "recordings/first.html" in learned
    assert (tmp_path / "recordings" / "first.html").stat().st_size > 20_000
    assert "complete" in looked
    assert "same hash" in relearned
    assert "exit_reason  finished" in drove


def test_setting_up_lets_a_package_beside_ours_be_found():
    """As the page on components has it; the sandbox would find it anyway."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    words = [sys.executable, "-P", "-c", "import benchmarks"]
    subprocess.run(words, cwd="/", env=environment, check=True)


def test_the_page_on_components_makes_one_that_keeps_the_contract_and_replays(tmp_path):
    said = follow("docs/how-to/component.md", tmp_path)
    assert "odometer/way" in said[1]
    assert "broken" not in said[1]
    assert "identical: " in said[2]
    assert "different: " in said[2]
