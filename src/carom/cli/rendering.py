"""``carom render``: a picture or a film, without a browser."""

from typing import Annotated, Any

import typer
from rich.text import Text

from carom.checks import number
from carom.cli import report
from carom.cli.source import own_options, parsed, source, whole
from carom.errors import InputError
from carom.record import load
from carom.rendering import Progress as Progressed
from carom.rendering import render
from carom.scene import Camera

INTERRUPTED = 130


def render_file(
    context: typer.Context,
    scene: Annotated[
        str, typer.Argument(metavar="SCENE|FILE.toml|FILE.gsd", help="What to show.")
    ] = "",
    output: Annotated[
        str,
        typer.Option(
            "--output", "-o", metavar="FILE", help="Ends in .mp4, .gif, .png or .html (a replay)."
        ),
    ] = "",
    begin: Annotated[
        str | None, typer.Option("--from", metavar="TIME", help="Simulated time to begin at.")
    ] = None,
    until: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="Simulated time to end at, or of a picture."),
    ] = None,
    duration: Annotated[
        str | None, typer.Option(metavar="TIME", help="The same, counted from where it begins.")
    ] = None,
    slow_motion: Annotated[
        str, typer.Option(metavar="X", help="Times slower than the scene's own pace; 0.5: faster.")
    ] = "1",
    fps: Annotated[
        str | None, typer.Option(metavar="N", help="Pictures per second; 30, for a GIF 25.")
    ] = None,
    size: Annotated[str, typer.Option(metavar="WxH", help="In pixels.")] = "1280x720",
    camera: Annotated[
        str | None,
        typer.Option(metavar="X,Y,Z[,X,Y,Z]", help="Where to look from, and what at."),
    ] = None,
    color: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="energy, speed, collisions, own or species."),
    ] = None,
    theme: Annotated[str, typer.Option(metavar="NAME", help="dark or light.")] = "dark",
    shadows: Annotated[bool, typer.Option("--shadows/--no-shadows", metavar="")] = True,
    quality: Annotated[
        str, typer.Option(metavar="NAME", help="good, or draft: rough edges, half the time.")
    ] = "good",
    caption: Annotated[
        bool,
        typer.Option("--caption/--no-caption", metavar="", help="Title, clock, colours."),
    ] = True,
    seed: Annotated[
        str | None, typer.Option(metavar="N", help="Of the scene's random numbers.")
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", metavar="", help="Write one JSON object when done.")
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", metavar="", help="No progress bar, no word.")
    ] = False,
) -> None:
    """Write a picture, a film or a replay of a scene or a recording.

    The scene's own options go here too, as in: carom render gas -o gas.mp4 --n 300
    """
    if not output:
        msg = f"say where to write with -o, as in 'carom render {scene or 'gas'} -o film.mp4'"
        raise InputError(msg)
    shown, label = _shown(scene, context, whole("seed", seed))
    first, last = parsed("from", begin), parsed("until", until)
    length = parsed("duration", duration)
    if length is not None:
        if last is not None:
            msg = "give only one of --until, --duration: a film has one end"
            raise InputError(msg)
        last = length + (getattr(shown, "start", 0.0) if first is None else first)
    slower = number("--slow-motion", parsed("slow-motion", slow_motion), above=0)
    options: dict[str, Any] = {
        "begin": first,
        "until": last,
        "speed": 1 / slower,
        "fps": parsed("fps", fps),
        "size": sized(size),
        "camera": None if camera is None else _camera(camera),
        "color": color,
        "theme": theme,
        "shadows": shadows,
        "quality": quality,
        "caption": caption,
    }
    done = _execute(shown, output, options, label, quiet=quiet or json)
    if json:
        report.write_json({"file": output, "scene": label, "pictures": done})
    elif not quiet:
        report.output().print(Text("wrote ").append(output, style="bold"), soft_wrap=True)


def sized(text: str) -> tuple[int, int]:
    """Read a size such as ``1280x720``.

    Raises
    ------
    InputError
        If it is none.
    """
    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        msg = f"--size is {text!r}; give width and height in pixels, as in --size 1280x720"
        raise InputError(msg)
    return int(width), int(height)


def _camera(text: str) -> Camera:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (3, 6):
        msg = (
            f"--camera is {text!r}; give a place, as in --camera 30,-20,10, "
            "and after it what to look at if that is not the origin, as in 30,-20,10,0,0,5"
        )
        raise InputError(msg)
    if len(numbers) == 3:
        numbers += [0.0, 0.0, 0.0]
    x, y, z, tx, ty, tz = numbers
    return Camera((x, y, z), (tx, ty, tz))


def _shown(target: str, context: typer.Context, seed: int | None) -> tuple[Any, str]:
    """What is to be shown, and what it is called."""
    if not target.endswith(".gsd"):
        found = source(target, context.args, seed, own_options(context))
        return found.simulation(), found.text
    given = [*context.args, *([] if seed is None else ["--seed"])]
    if given:
        msg = f"{given[0]} is an option of scenes, not of recordings; leave it out"
        raise InputError(msg)
    return load(target), target


def _execute(shown: Any, path: str, options: dict[str, Any], label: str, *, quiet: bool) -> int:
    """Render with a progress bar on standard error, if somebody looks at it."""
    drawn, replay = 0, path.lower().endswith(".html")
    with report.bar(quiet=quiet) as bar:
        task = bar.add_task(label, total=None, note="")

        def show(now: Progressed) -> None:
            nonlocal drawn
            drawn = now.done // 2 if replay else now.done
            which = "" if replay else f"picture {now.done:,} of {now.total:,}, "
            text = f"{which}time {now.time:.4g}"
            bar.update(task, completed=now.done, total=now.total, note=text)

        try:
            render(shown, path, progress=show, **options)
        except KeyboardInterrupt:
            # Only films are kept in part; one that is there may be an old one.
            if drawn and not replay:
                held = "1 picture" if drawn == 1 else f"{drawn:,} pictures"
                kept = f"Stopped by Ctrl-C; {path} holds {held} until then."
                bar.console.print(Text(kept, style="yellow"), soft_wrap=True)
            raise typer.Exit(INTERRUPTED) from None
    return max(1, drawn)
