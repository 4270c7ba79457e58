"""``carom sketch``: a student's own program in the browser."""

import sys
import traceback
from typing import Annotated

import typer
from rich.text import Text

from carom.cli import report
from carom.cli.source import whole
from carom.errors import CaromError
from carom.sketch.program import Program
from carom.sketch.serving import serve

FAILED = 1


def sketch(
    context: typer.Context,
    file: Annotated[str, typer.Argument(metavar="FILE.py", help="The program.")],
    port: Annotated[str, typer.Option(metavar="N", help="0 takes a free one.")] = "0",
    no_browser: Annotated[
        bool, typer.Option("--no-browser", metavar="", help="Only print the address.")
    ] = False,
    seed: Annotated[
        str, typer.Option(metavar="N", help="Of random(); the same seed, the same numbers.")
    ] = "1",
    json: Annotated[
        bool,
        typer.Option("--json", metavar="", help="Write the address as JSON; prints go to stderr."),
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", metavar="", help="Print the address and nothing else.")
    ] = False,
) -> None:
    """Run a program of your own with setup() and draw(), in the style of Processing."""
    number, chosen = whole("port", port), whole("seed", seed)
    assert number is not None
    assert chosen is not None
    program = Program(file, chosen, echo=sys.stderr if json else sys.stdout)
    program.load()

    def ready(address: str) -> None:
        if json:
            report.write_json({"address": address, "file": str(program.path)})
            return
        if quiet:
            report.output().print(address, soft_wrap=True)
            return
        line = Text("carom runs ").append(program.path.name, style="bold").append(" at ")
        line.append(address, style="cyan underline").append("   (Ctrl-C ends it)")
        report.output().print(line, soft_wrap=True)

    def complain(error: CaromError) -> None:
        if context.obj:  # --debug
            traceback.print_exception(error)
        report.complain(str(error))

    well = serve(
        program, port=number, open_browser=not no_browser, on_ready=ready, on_error=complain
    )
    if not well:
        raise typer.Exit(FAILED)
