"""The pages' files: tables read once, so no request ever names a path on the disk."""

import json
from collections.abc import Collection
from dataclasses import dataclass
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable

FOLDER = resources.files("carom.view") / "static"
TYPES = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "svg": "image/svg+xml; charset=utf-8",
    "webp": "image/webp",
    "json": "application/json; charset=utf-8",
}
VIEW, SKETCH = "index.html", "sketch.html"
#: Where the page finds which scenes have a picture.
GALLERY = "/gallery.json"


@dataclass(frozen=True, slots=True)
class StaticFile:
    """One file as it is sent."""

    content: bytes
    content_type: str


@cache
def load(page: str) -> dict[str, StaticFile]:
    """All files of a page by address: the page itself at ``/``, scripts, styles and pictures."""
    files = {"/": _read(FOLDER / page)}
    for file in FOLDER.iterdir():
        if file.name.endswith((".js", ".css", ".svg")):
            files[f"/{file.name}"] = _read(file)
    if page == VIEW:
        pictures = sorted((FOLDER / "gallery").iterdir(), key=lambda picture: picture.name)
        files |= {f"/gallery/{picture.name}": _read(picture) for picture in pictures}
        names = json.dumps([picture.name.removesuffix(".webp") for picture in pictures])
        files[GALLERY] = StaticFile(names.encode(), TYPES["json"])
    return files


def _read(file: Traversable) -> StaticFile:
    return StaticFile(file.read_bytes(), TYPES[file.name.rpartition(".")[2]])


def security_headers(hosts: Collection[str]) -> dict[str, str]:
    """Headers that let the page load from, and talk to, this server alone.

    Parameters
    ----------
    hosts : collection of str
        Where the server is reached, with the port.
    """
    # Safari before 15.4 does not count ws: as 'self', so the sockets are named.
    sockets = " ".join(f"ws://{host}" for host in sorted(hosts))
    policy = (
        f"default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
        f"connect-src 'self' {sockets}; base-uri 'none'; form-action 'none'; "
        f"frame-ancestors 'none'"
    )
    return _headers(policy)


def replay_headers() -> dict[str, str]:
    """Headers of a page that holds all it needs; its own policy forbids everything else."""
    return _headers("frame-ancestors 'none'")


def _headers(policy: str) -> dict[str, str]:
    return {
        "Content-Security-Policy": policy,
        "X-Content-Type-Options": "nosniff",
        "X-Frame-Options": "DENY",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Cache-Control": "no-store",
    }
