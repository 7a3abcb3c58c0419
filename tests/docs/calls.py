"""Calls of `berth` as the command line itself understands them; nothing is run."""

import typer

from cli.main import app


def parsed(words):
    """(verb, what it was given); raises what typer raises about a mistake."""
    command = typer.main.get_command(app)
    context = command.make_context("berth", list(words))
    while rest := [*context._protected_args, *context.args]:
        name, command, rest = command.resolve_command(context, rest)
        context = command.make_context(name, rest)
    return context.info_name, context.params
