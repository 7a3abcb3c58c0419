"""Says a word about each image."""

from runtime.contract import Event, Output
from schemas.session_pb2 import SessionEnd
from tests.runtime.parts.student import ports


class Student:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        pass

    def handle(self, event: Event) -> tuple[Output, ...]:
        return (Output("word", SessionEnd(reason="seen")),) if event.port == "image" else ()
