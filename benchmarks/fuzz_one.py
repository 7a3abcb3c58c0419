"""One reader under atheris, guided by what its code reaches: python -m benchmarks.fuzz_one NAME LIBFUZZER-OPTION..."""

from __future__ import annotations

import sys

import atheris

with atheris.instrument_imports(include=["components", "docking", "runtime", "cli", "mcap", "tomllib"]):
    from benchmarks.decoders import READERS, survives


def main() -> None:
    """Never returns: libFuzzer ends the process, with 0 if nothing was found."""
    name, *options = sys.argv[1:]
    reader = READERS[name]
    for seed in reader.seeds():  # imports and compilation are no hang
        survives(reader, seed)
    atheris.Setup([sys.argv[0], *options], lambda data: survives(reader, data))
    atheris.Fuzz()


if __name__ == "__main__":
    main()
