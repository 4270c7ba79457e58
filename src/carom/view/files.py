"""The page's files: a fixed table read once, so no request ever names a path on the disk."""

from collections.abc import Collection
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
            "arrows",
            "buffers",
            "camera",
            "colors",
            "connection",
            "controls",
            "crowd",
            "crowdlight",
            "frame",
            "gestures",
            "glsl",
            "images",
            "interpolation",
            "legend",
            "light",
            "matrix",
            "numbers",
            "overlay",
            "program",
            "protocol",
            "quality",
            "readout",
            "renderer",
            "room",
            "shadows",
            "spheres",
            "stack",
            "timeline",
            "walls",
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
    """All files by address."""
    folder = files("carom.view") / "static"
    return {
        address: StaticFile((folder / name).read_bytes(), f"{kind}; charset=utf-8")
        for address, (name, kind) in TABLE.items()
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
