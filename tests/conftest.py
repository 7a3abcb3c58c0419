"""Sessions that several tests look at: made once for each test process."""

import pytest

from tests.recorded_session import Twins, make_twins


@pytest.fixture(scope="session")
def twins(tmp_path_factory) -> Twins:
    """One learning session with a docking, made twice, and the beginning of one with another seed."""
    return make_twins(tmp_path_factory.mktemp("twins"))
