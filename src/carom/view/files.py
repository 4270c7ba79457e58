"""The page's files: a fixed table read once, so no request ever names a path on the disk."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

HTML, CSS, JS, SVG = "text/html", "text/css", "text/javascript", "image/svg+xml"

#: Address of each file, its name in `static/`, its type.
TABLE = {
    "/": ("index.html", HTML),
    "/style.css": ("style.css", CSS),
    "/icon.svg": ("icon.svg", SVG),
    **{
        f"/{name}.js": (f"{name}.js", JS)
        for name in (
            "main",
            "camera",
            "colors",
            "connection",
            "controls",
            "gestures",
            "glsl",
            "interpolation",
            "legend",
            "matrix",
            "numbers",
            "program",
            "protocol",
            "readout",
            "renderer",
            "shaders",
            "stack",
            "timeline",
            "walls",
            "wire",
        )
    },
}

#: The page of a sketch: its own address table, because it is served alone.
SKETCH_TABLE = {
    "/": ("sketch.html", HTML),
    "/sketch.css": ("sketch.css", CSS),
    "/icon.svg": ("icon.svg", SVG),
    **{
        f"/{name}.js": (f"{name}.js", JS)
        for name in (
            "sketch",
            "sketch_camera",
            "sketch_order",
            "sketch_protocol",
            "sketch_renderer",
            "sketch_shaders",
            "connection",
            "glsl",
            "matrix",
            "program",
            "protocol",
            "stack",
            "wire",
        )
    },
}


@dataclass(frozen=True, slots=True)
class StaticFile:
    """One file as it is sent."""

    content: bytes
    content_type: str


@cache
def load() -> dict[str, StaticFile]:
    """All files of the live view by address."""
    return _read(TABLE)


@cache
def load_sketch() -> dict[str, StaticFile]:
    """All files of a sketch's page by address."""
    return _read(SKETCH_TABLE)


def _read(table: Mapping[str, tuple[str, str]]) -> dict[str, StaticFile]:
    folder = files("carom.view") / "static"
    return {
        address: StaticFile((folder / name).read_bytes(), f"{kind}; charset=utf-8")
        for address, (name, kind) in table.items()
    }


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
    return {
        "Content-Security-Policy": policy,
        "X-Content-Type-Options": "nosniff",
        "X-Frame-Options": "DENY",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Cache-Control": "no-store",
    }
