"""The page of the command: every verb, its arguments and its options, as `--help` has them."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from typing import Any

import typer

from cli.main import app
from docs.reference.tables import code, table


def page() -> str:
    """The page."""
    root: Any = typer.main.get_command(app)
    head = (
        "# Commands\n\n"
        "Written from the command itself. Exit codes: 0 good; 1 failed, or what was compared differs; 2 a mistake in "
        "the command line, a file or a parameter, told in one line; 3 something is missing in a recording.\n\n"
        "`berth --install-completion` teaches your shell the verbs and options.\n"
    )
    return "\n".join([head, *(part for words, verb in verbs(root, "berth") for part in _verb(words, verb))])


def verbs(group: Any, words: str) -> Iterator[tuple[str, Any]]:
    """(words to type, command) of every command below a group, in its order."""
    context = group.make_context(words.rpartition(" ")[2], [], resilient_parsing=True)
    for name in group.list_commands(context):
        verb = group.get_command(context, name)
        typed = f"{words} {name}"
        if hasattr(verb, "list_commands"):
            yield from verbs(verb, typed)
        else:
            yield typed, verb


def _verb(words: str, verb: Any) -> Iterator[str]:
    arguments = [param for param in verb.params if param.param_type_name == "argument"]
    options = [param for param in verb.params if param.param_type_name == "option" and param.name != "help"]
    yield f"## {words}\n"
    yield f"{_prose(verb)}\n"
    if arguments:
        yield table(("argument", "what it is"), [(code(_shown(param)), param.help or "") for param in arguments])
    if options:
        rows = [(code(", ".join(param.opts)), _default(param), param.help or "") for param in options]
        yield table(("option", "default", "what it does"), rows)


def _prose(verb: Any) -> str:
    """What it does, and its example."""
    words = "\n\n".join(" ".join(part.split()) for part in (verb.help or "").split("\n\n"))
    examples = (verb.epilog or "").partition("Example:")[2]
    return f"{words}\n\n```text\n{inspect.cleandoc(examples)}\n```" if examples else words


def _shown(param: Any) -> str:
    name = param.metavar or param.name.upper()
    return f"{name}..." if param.nargs == -1 else str(name)


def _default(param: Any) -> str:
    if param.required:
        return "must be given"
    value = param.default
    return "" if value in (None, "", False, ()) or callable(value) else code(str(value))
