"""Small tables as HTML, which notebooks show in place of a `repr`."""

import base64
from collections.abc import Iterable, Sequence
from html import escape


def html_table(
    title: str,
    rows: Iterable[Sequence[str]],
    *,
    heading: Sequence[str] = (),
    notes: Iterable[str] = (),
) -> str:
    """Write a table; all that is handed in is text, and none of it is read as HTML.

    Parameters
    ----------
    title : str
        Stands above it.
    rows : iterable of sequences of str
    heading : sequence of str
        Stands above the columns; without it the first cell of each row is what the row is about.
    notes : iterable of str
        Stand below it.

    Examples
    --------
    >>> html_table("", [("n", "2 < 3")])
    '<table><tbody><tr><th>n</th><td>2 &lt; 3</td></tr></tbody></table>'
    """
    above = f'<caption style="text-align: left">{escape(title)}</caption>' if title else ""
    head = f"<thead>{_row(heading, all_heads=True)}</thead>" if heading else ""
    body = "".join(_row(row, first_head=not heading) for row in rows)
    below = "".join(f"<p><small>{escape(note)}</small></p>" for note in notes)
    return f"<table>{above}{head}<tbody>{body}</tbody></table>{below}"


def _row(cells: Sequence[str], *, all_heads: bool = False, first_head: bool = False) -> str:
    tags = ["th" if all_heads or (first_head and k == 0) else "td" for k in range(len(cells))]
    texts = (f"<{tag}>{escape(cell)}</{tag}>" for tag, cell in zip(tags, cells, strict=True))
    return f"<tr>{''.join(texts)}</tr>"


def html_picture(png: bytes | None) -> str:
    """A PNG picture inside the page itself; nothing if there is none."""
    if png is None:
        return ""
    data = base64.b64encode(png).decode()
    return f'<img alt="" style="max-width: 100%" src="data:image/png;base64,{data}">'
