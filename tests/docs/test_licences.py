"""Everything that is locked comes under a licence that lets Berth be passed on under its own."""

import re

import pytest

from docs.reference.licences import INSIDE, READ, REFUSED, REQUIREMENTS, packages, page

PACKAGES = packages()


@pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.name)
def test_the_licence_is_known_and_not_refused(package):
    assert package.licence or package.only
    assert not REFUSED.search(package.licence)
    assert len(package.licence) < 150, "a licence's name, not its text"


@pytest.mark.parametrize(
    "words",
    ["GPL-3.0-or-later", "GNU GPLv2", "AGPL-3.0", "GNU Affero General Public License v3", "MIT AND GPL-2.0-only",
     "GNU General Public License v2 (GPLv2)", "SSPL-1.0"],
)  # fmt: skip
def test_a_licence_that_binds_whoever_passes_berth_on_is_refused(words):
    assert REFUSED.search(words)


@pytest.mark.parametrize(
    "words", ["LGPL-2.1", "GNU Lesser General Public License v3", "MPL-2.0", "Apache-2.0 OR EPL-2.0"]
)
def test_others_are_not(words):
    assert not REFUSED.search(words)


def test_every_locked_line_is_on_the_page():
    lines = (REQUIREMENTS / "dev.lock").read_text(encoding="utf-8").splitlines()
    names = {line.partition("==")[0] for line in lines if re.match(r"[\w.-]+==", line)}
    assert len(names) > 80
    assert names <= {package.name for package in PACKAGES}
    text = page()
    assert all(f"| {name} |" in text for name in names)


def test_what_was_read_by_a_person_is_still_locked():
    names = {package.name for package in PACKAGES}
    assert set(READ) <= names
    assert {name for names_ in INSIDE for name in names_.split(", ")} <= names
