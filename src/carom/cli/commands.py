"""Commands, their options, and what becomes of errors."""

import sys
import traceback
from collections.abc import Sequence
from dataclasses import asdict
from typing import Annotated, Any

import typer
from rich.table import Table
from rich.text import Text

import carom
from carom import scenes
from carom.cli import report
from carom.cli.benching import bench
from carom.cli.comparing import compare as compare_both
from carom.cli.comparing import side_by_side
from carom.cli.measuring import measure
from carom.cli.observing import as_data as observed_data
from carom.cli.observing import observables, sheets, tables
from carom.cli.recording import Force, check, convert, info
from carom.cli.rendering import render_file
from carom.cli.replaying import show_recording
from carom.cli.resuming import (
    CheckpointEvery,
    EventFile,
    Every,
    Output,
    Plan,
    Resume,
    counted,
    resumed,
    what_was_kept,
)
from carom.cli.running import as_data, execute, goal, summary
from carom.cli.sketching import sketch
from carom.cli.source import own_options, parsed, source, whole
from carom.cli.story import TOLD, story
from carom.cli.validating import validate
from carom.errors import InputError, RunError
from carom.simulation import Simulation
from carom.state import State
from carom.view import LiveView, serve

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130
DEFAULT_SCENE = "gas"
#: Scene options are not known to Typer: they pass through and are read by `source`.
LOOSE = {"allow_extra_args": True, "ignore_unknown_options": True}

app = typer.Typer(
    name="carom",
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    epilog="Add --debug to any command for the traceback of an error.",
)

SceneName = Annotated[
    str, typer.Argument(metavar="SCENE|FILE.toml", help="A scene's name, or a scene file.")
]
ShownName = Annotated[
    str,
    typer.Argument(
        metavar="SCENE|FILE.toml|RUN.gsd", help="A scene's name, a scene file or a recording."
    ),
]
Seed = Annotated[str | None, typer.Option(metavar="N", help="Of the scene's random numbers.")]
Method = Annotated[
    str, typer.Option(metavar="NAME", help="exact, tick (the paper's) or reference (slow, plain).")
]
Tick = Annotated[
    str | None,
    typer.Option(metavar="TIME", help="Length of a tick; 1/60 of the scene's pace if left out."),
]
Until = Annotated[str | None, typer.Option(metavar="TIME", help="Simulated time to stop at.")]
Json = Annotated[
    bool, typer.Option("--json", metavar="", help="Write one JSON object instead of a table.")
]
Quiet = Annotated[
    bool, typer.Option("--quiet", metavar="", help="No progress bar, nothing but the result.")
]


def _version(asked: bool) -> None:
    if asked:
        report.output().print(f"carom {carom.__version__}")
        raise typer.Exit


@app.callback()
def _carom(
    version: Annotated[
        bool,
        typer.Option(
            "--version", metavar="", callback=_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Exact collisions of spheres in three dimensions, live in the browser."""


@app.command("scenes")
def list_scenes(
    name: Annotated[str, typer.Argument(metavar="[SCENE]", help="One, with its options.")] = "",
    json: Json = False,
    seed: Seed = None,
    quiet: Quiet = False,
) -> None:
    """List the scenes, or the options of one."""
    whole("seed", seed)
    if json:
        chosen = [_described(each) for each in ([name] if name else scenes.names())]
        report.write_json(chosen[0] if name else chosen)
    elif name:
        _print_options(name, quiet)
    else:
        _print_scenes(quiet)


def _print_scenes(quiet: bool) -> None:
    console = report.output()
    lines = Table.grid("", "", padding=(0, 2))
    lines.columns[0].style = report.ACCENT
    for each in scenes.names():
        lines.add_row(each, scenes.describe(each))
        if not console.is_terminal:  # one line each for programs; a terminal folds long ones
            console.print(f"{each:<15}{scenes.describe(each)}", soft_wrap=True, markup=False)
    if console.is_terminal:
        console.print(lines)
    if not quiet:
        console.print()
        console.print("carom show NAME     watch it in the browser", style="dim")
        console.print("carom run NAME      run it without a window", style="dim")
        console.print("carom scenes NAME   its options", style="dim")


def _described(name: str) -> dict[str, Any]:
    options = [{**asdict(o), "type": o.type.__name__} for o in scenes.options(name)]
    return {"name": name, "description": scenes.describe(name), "options": options}


def _print_options(name: str, quiet: bool) -> None:
    title = report.heading(name, scenes.describe(name))
    sheet = report.table(title, "option", "default", "")
    sheet.columns[2].justify = "left"
    for option in scenes.options(name):
        dashed = "--" + option.name.replace("_", "-")
        sheet.add_row(dashed, str(option.default), option.help)
    report.output().print(sheet)
    if not quiet:
        example = "".join(
            f" --{o.name.replace('_', '-')} {o.default}" for o in scenes.options(name)[:2]
        )
        report.output().print(Text(f"carom run {name}{example}"))


@app.command(context_settings=LOOSE)
def show(
    context: typer.Context,
    scene: ShownName = DEFAULT_SCENE,
    port: Annotated[str, typer.Option(metavar="N", help="0 takes a free one.")] = "0",
    host: Annotated[
        str,
        typer.Option(
            metavar="ADDRESS",
            help="127.0.0.1 is this machine only; 0.0.0.0 lets others in the network see it.",
        ),
    ] = "127.0.0.1",
    no_browser: Annotated[
        bool, typer.Option("--no-browser", metavar="", help="Only print the address.")
    ] = False,
    method: Method = "exact",
    tick: Tick = None,
    seed: Seed = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Show a scene live in the browser, or a recording as a replay; Ctrl-C ends it."""
    words = context.args
    if scene.startswith("-"):  # `carom show --seed 3` needs no scene, `--n 5` has one
        words, scene = [scene, *words], DEFAULT_SCENE
    number = whole("port", port)
    assert number is not None
    if scene.endswith(".gsd"):
        names = {"--method": method != "exact", "--tick": tick, "--seed": seed}
        words = [*words, *(name for name, given in names.items() if given)]
        show_recording(scene, words, host, number, no_browser=no_browser, json=json, quiet=quiet)
        return
    found = source(scene, words, whole("seed", seed), own_options(context))
    sim = found.simulation(method, parsed("tick", tick))

    def ready(view: LiveView) -> None:
        if json:
            addresses = {"address": view.url}
            if view.is_public:
                addresses["watch_address"] = view.watch_url
            report.write_json({**addresses, "scene": found.name, "n": len(sim)})
        elif quiet:
            report.output().print(view.url, soft_wrap=True)
        else:
            line = Text("carom shows ").append(found.text, style="bold").append(" at ")
            line.append(view.url, style="cyan underline").append("   (Ctrl-C ends it)")
            report.output().print(line, soft_wrap=True)
        if view.is_public:
            report.warn_of_network(view.watch_url)

    serve(sim, host=host, port=number, open_browser=not no_browser, on_ready=ready)


@app.command(context_settings=LOOSE)
def run(
    context: typer.Context,
    scene: SceneName = "",
    until: Until = None,
    collisions: Annotated[
        str | None, typer.Option(metavar="COUNT", help="Stop after so many (1e6 is a count).")
    ] = None,
    events: Annotated[
        str | None, typer.Option(metavar="COUNT", help="The same, with walls counted.")
    ] = None,
    method: Method = "exact",
    tick: Tick = None,
    observe: Annotated[
        str | None,
        typer.Option(metavar="A,B", help="What to measure: compressibility, msd ...; or list."),
    ] = None,
    output: Output = None,
    every: Every = None,
    checkpoint_every: CheckpointEvery = None,
    force: Force = False,
    record_events: EventFile = None,
    resume: Resume = None,
    seed: Seed = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Run a scene without a window and say how it went.

    The scene's own options go here too, as in: carom run fluid --n 1e6 --seed 2
    """
    observed = observables(observe)
    times = parsed("every", every), parsed("checkpoint-every", checkpoint_every)
    plan = Plan(output, *times, force, record_events)
    if resume is not None:
        given = scene or context.args or seed or tick or method != "exact" or plan.asked
        found, sim = resumed(resume, refuse=bool(given), ends=(until, collisions, events))
    else:
        found = source(scene, context.args, whole("seed", seed), own_options(context))
    aim = goal(
        found.scene.pace,
        until=parsed("until", until),
        collisions=whole("collisions", collisions),
        events=counted(events),
    )
    if resume is None:
        if tick is not None and method != "tick":
            msg = f"--tick is {tick}, but method {method} has no ticks; add --method tick"
            raise InputError(msg)
        sim = found.simulation(method, parsed("tick", tick))
        plan.begin(sim)
    start = sim.state
    with sim:
        outcome = execute(
            sim, aim, quiet=quiet or json, label=found.name, observe=[*observed.values()]
        )
    kept = plan.kept(resume)
    results = tables(observed)
    if json:
        data = as_data(sim, found, outcome) | kept
        report.write_json({**data, "observed": observed_data(results)} if observed else data)
    else:
        if found.name == "phase-2" and not quiet:
            _print_story(start, sim)
        report.output().print(summary(sim, found, aim, outcome))
        for part in sheets(results):
            report.output().print(part)
        if kept and not quiet:
            report.output().print(what_was_kept(kept), soft_wrap=True)
    if not outcome.complete:
        raise typer.Exit(INTERRUPTED)


def _print_story(start: State, sim: Simulation) -> None:
    for lines in story(start, sim):
        report.output().print(lines, "", sep="\n", markup=False)
    if sim.collisions > TOLD:
        report.output().print(f"... and {sim.collisions - TOLD} more\n", style="dim")


@app.command(context_settings=LOOSE)
def compare(
    context: typer.Context,
    scene: SceneName = "",
    until: Until = None,
    tick: Tick = None,
    seed: Seed = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Run a scene exactly and in the paper's ticks, and compare."""
    found = source(scene, context.args, whole("seed", seed), own_options(context))
    aim = goal(found.scene.pace, until=parsed("until", until))
    data = compare_both(found, aim, parsed("tick", tick), quiet=quiet or json)
    if json:
        report.write_json(data)
    else:
        report.output().print(side_by_side(found, data))


app.command()(sketch)
app.command()(bench)
app.command()(validate)
app.command("render", context_settings=LOOSE)(render_file)
app.command()(measure)
app.command()(info)
app.command()(check)
app.command()(convert)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and leave the program with its exit status.

    0 all is well; 2 bad input: options, values, scene files; 1 the run failed, or a file
    or port cannot be used; 130 Ctrl-C.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in words
    sys.exit(_status([word for word in words if word != "--debug"], debug))


def _status(words: list[str], debug: bool) -> int:
    try:
        status = int(app(words, prog_name="carom", standalone_mode=False, obj=debug) or 0)
        if "--help" in words and len(words) > 2 and words[1] in scenes.names():
            _print_options(words[1], quiet=True)
        return status
    except KeyboardInterrupt:  # before a command has begun; later Typer makes an Abort of it
        return INTERRUPTED
    except Exception as error:
        if debug:
            traceback.print_exc()
        sentence, status = _verdict(error)
        if sentence:
            report.complain(sentence)
        return status


def _verdict(error: Exception) -> tuple[str, int]:
    """What to say about an error, and the exit status; a bug is raised again."""
    usage = typer.BadParameter.__mro__[1]  # its name has moved between versions of Typer
    if isinstance(error, InputError):
        return str(error), BAD_INPUT
    if isinstance(error, RunError | OSError):
        return str(error), FAILED
    if isinstance(error, MemoryError):
        return "there is not enough memory for this many spheres; take fewer", FAILED
    if isinstance(error, typer.Abort):
        return "", INTERRUPTED
    if isinstance(error, usage):
        # Typer prints its help and raises an empty complaint where nothing at all is asked.
        said = str(getattr(error, "format_message", lambda: error)()).rstrip(".")
        return said, BAD_INPUT if said else 0
    raise error
