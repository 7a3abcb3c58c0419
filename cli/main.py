"""The command `berth`: one verb per file, imported when it is called."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from typing import Any

import typer
import typer.core

from cli.layout import WIDTH, laid_out
from runtime.params import ConfigurationError

VERBS: dict[str, str] = {
    "run": "cli.run:run",
    "compare": "cli.compare:compare",
    "import": "cli.intake.command:intake",
    "ps": "cli.ps:ps",
    "stop": "cli.stop:stop",
    "logs": "cli.logs:logs",
    "topic": "cli.topic:topic",
    "record": "cli.record:record",
    "play": "cli.play:play",
    "replay": "cli.replay:replay",
    "relearn": "cli.relearn:relearn",
    "info": "cli.info:info",
    "doctor": "cli.doctor:doctor",
    "recover": "cli.recover:recover",
    "report": "cli.report:report",
    "film": "cli.film:film",
    "goal": "cli.goal:goal",
    "view": "cli.view:view",
    "experiment": "cli.experiment:experiment",
    "graph": "cli.graph:graph",
    "check": "cli.check:check",
    "tune": "cli.tune:tune",
    "calibrate": "cli.calibrate:calibrate",
    "keys": "cli.credentials:keys",
}
"""Verb -> module:name of a function with typer's annotations, or of a `typer.Typer` with verbs of its own."""


class Verbs(typer.core.TyperGroup):
    """The verbs whose file is there, in the table's order."""

    def list_commands(self, ctx: Any) -> list[str]:  # noqa: ARG002
        """Names of the verbs."""
        return [verb for verb, target in VERBS.items() if importlib.util.find_spec(target.partition(":")[0])]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """A verb's command, its module imported now; None if there is no such verb."""
        if cmd_name not in self.list_commands(ctx):
            return None
        module, _, name = VERBS[cmd_name].partition(":")
        return command(cmd_name, getattr(importlib.import_module(module), name))


def command(name: str, target: Any) -> Any:
    """A command from a function or a `typer.Typer`."""
    app = target
    if not isinstance(target, typer.Typer):
        app = typer.Typer(add_completion=False, rich_markup_mode=None)
        app.command(name)(target)
    made = laid_out(typer.main.get_command(app))
    made.name = name
    return made


app = typer.Typer(
    cls=Verbs,
    no_args_is_help=True,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": WIDTH},
)


@app.callback()
def berth() -> None:
    """Let a mobile robot learn to dock at an object it sees. `berth COMMAND -h` has an example of each command."""


COMPLAINT: Any = typer.BadParameter.__mro__[2]
"""What typer raises about a command line; it has no public name of its own."""


def main() -> None:
    """Run the command line; an error of the user is one line and exit code 2."""
    try:
        sys.exit(typer.main.get_command(app)(standalone_mode=False))
    except ConfigurationError as error:
        sys.stderr.write(f"berth: {error}\n")
    except COMPLAINT as complaint:
        text = complaint.format_message()
        sys.stderr.write(text + "\n" if "\n" in text else f"berth: {text}\n")  # no words at all: the whole help
    sys.exit(2)


if __name__ == "__main__":
    main()
