"""Nothing that reads bytes of strangers breaks: good bytes, spoiled ones, and whatever once broke something.

BERTH_FUZZ says how many spoiled ones for each; `make fuzz` looks for more, guided by coverage.
"""

import os
import random
from pathlib import Path

import pytest

from benchmarks.decoders import READERS, Reader, survives
from benchmarks.mutations import mutated

CASES = int(os.environ.get("BERTH_FUZZ", "40"))
KEPT = sorted((Path(__file__).parent / "kept").glob("*"))


@pytest.mark.parametrize("name", READERS)
def test_good_bytes_are_read(name):
    seeds = list(READERS[name].seeds())
    assert [survives(READERS[name], seed) for seed in seeds] == [True] * len(seeds)


@pytest.mark.parametrize("name", READERS)
def test_spoiled_bytes_are_read_or_refused(name):
    reader, chance = READERS[name], random.Random(name)
    seeds = list(reader.seeds())
    refused = sum(not survives(reader, mutated(chance.choice(seeds), chance)) for _ in range(CASES))
    assert refused == 0 or reader.refuses


@pytest.mark.parametrize("file", KEPT, ids=lambda file: file.name)
def test_what_was_once_found_is_read_or_refused(file):
    survives(READERS[file.name.partition("-")[0]], file.read_bytes())


def test_an_error_that_is_no_refusal_is_not_swallowed():
    def read(data):
        raise ZeroDivisionError(data)

    with pytest.raises(ZeroDivisionError):
        survives(Reader(read, (ValueError,), list), b"")
