"""`carom show RUN.gsd`: a recording as a replay in the browser."""

from rich.text import Text

from carom.cli import report
from carom.errors import InputError
from carom.record import load
from carom.view.playing import play
from carom.view.replay import even_times, replay


def show_recording(
    path: str,
    words: list[str],
    host: str,
    port: int,
    *,
    no_browser: bool,
    json: bool,
    quiet: bool,
) -> None:
    """Hand the replay of a recording to the browser until Ctrl-C."""
    if words:
        msg = f"a recording has no options, but there is {words[0]!r}: leave it out"
        raise InputError(msg)
    with load(path) as run:
        title = run.scene.title if run.scene is not None else ""
        n, frames = len(run[0]), even_times(run)
        with report.bar(quiet=quiet or json) as bar:
            task = bar.add_task(title or path, total=2 * len(frames), note="")  # read, then packed

            def tell(time: float) -> None:
                bar.update(task, advance=1, note=f"time {time:.4g}")

            page = replay(run, frames, title=title or path, progress=tell)

    def ready(address: str) -> None:
        if json:
            report.write_json({"address": address, "scene": title, "n": n})
        elif quiet:
            report.output().print(address, soft_wrap=True)
        else:
            line = Text("carom plays ").append(path, style="bold").append(" at ")
            line.append(address, style="cyan underline").append("   (Ctrl-C ends it)")
            report.output().print(line, soft_wrap=True)

    play(page, host=host, port=port, open_browser=not no_browser, on_ready=ready)
