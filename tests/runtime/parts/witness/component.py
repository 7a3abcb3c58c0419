"""A tap that writes down what it hears, one JSON list a line."""

import json
from pathlib import Path

from runtime.contract import Output
from runtime.system import System
from schemas.session_pb2 import RecorderAck
from tests.runtime.parts.witness import ports


class Witness:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, system: System, started: str) -> None:
        self._file = Path(params.file).open("w", encoding="utf-8")  # noqa: SIM115  (open for the whole run)

    def message(self, key, schema, payload, run, sequence, capture_ns, time_ns) -> tuple[Output, ...]:
        print(json.dumps([key, schema, payload.hex(), run, sequence, capture_ns, time_ns]), file=self._file)
        return (Output("ack", RecorderAck(), capture_ns),) if key == "world/image" else ()

    def tick(self, time_ns: int) -> tuple[Output, ...]:
        self._file.flush()
        return ()

    def close(self) -> tuple[Output, ...]:
        self._file.close()
        return ()
