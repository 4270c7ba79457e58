"""The page's files: a fixed table read once, so no request ever names a path on the disk."""

import json
from collections.abc import Collection
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

HTML, CSS, JS = "text/html", "text/css", "text/javascript"
SVG, WEBP, JSON = "image/svg+xml", "image/webp", "application/json"

#: Address of each file, its name in `static/`, its type.
TABLE = {
    "/": ("index.html", HTML),
    "/icon.svg": ("icon.svg", SVG),
    **{
        f"/{name}.css": (f"{name}.css", CSS)
        for name in ("bars", "dialogs", "hands", "narrow", "panel", "plots", "style")
    },
    **{
        f"/{name}.js": (f"{name}.js", JS)
        for name in (
            "main",
            "annotations",
            "camera",
            "chart",
            "clipboard",
            "colors",
            "connection",
            "controls",
            "dialog",
            "dom",
            "flash",
            "fullscreen",
            "gallery",
            "gestures",
            "glsl",
            "gravity",
            "gravitypad",
            "handle",
            "help",
            "inspector",
            "interpolation",
            "keys",
            "later",
            "layout",
            "legend",
            "link",
            "look",
            "matrix",
            "newball",
            "numbers",
            "parameters",
            "pick",
            "plots",
            "program",
            "protocol",
            "readout",
            "renderer",
            "scales",
            "section",
            "sections",
            "settings",
            "shaders",
            "share",
            "slider",
            "speeds",
            "split",
            "stack",
            "standpoint",
            "statistics",
            "store",
            "theme",
            "timeline",
            "toast",
            "toolbar",
            "tools",
            "traces",
            "trail",
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
    """All files by address, and the scenes' pictures with a list of those there are."""
    folder = files("carom.view") / "static"
    table = {
        address: StaticFile((folder / name).read_bytes(), f"{kind}; charset=utf-8")
        for address, (name, kind) in TABLE.items()
    }
    pictures = sorted((folder / "gallery").iterdir(), key=lambda picture: picture.name)
    for picture in pictures:
        table[f"/gallery/{picture.name}"] = StaticFile(picture.read_bytes(), WEBP)
    names = json.dumps([picture.name.removesuffix(".webp") for picture in pictures])
    table["/gallery.json"] = StaticFile(names.encode(), JSON)
    return table


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
