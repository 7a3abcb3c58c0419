"""Sessions that several tests look at: made once for each test process."""

import os

import pytest
from hypothesis import settings

from tests.recorded_session import Twins, make_twins

settings.register_profile("repeatable", derandomize=True, deadline=None)
"""The same cases on every run, without deadlines: a busy machine is no bug."""
settings.register_profile("explore", deadline=None, max_examples=1000)
"""`HYPOTHESIS_PROFILE=explore pytest` looks for new cases."""
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))


@pytest.fixture(scope="session")
def twins(tmp_path_factory) -> Twins:
    """One learning session with a docking, made twice, and the beginning of one with another seed."""
    return make_twins(tmp_path_factory.mktemp("twins"))
