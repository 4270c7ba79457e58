"""All checks, by name and by family."""

from fnmatch import fnmatchcase

from carom.checks import nearest
from carom.errors import UnknownNameError
from carom.validate import columns, contacts, flights, fluids, granular, lines, mixtures, transport
from carom.validate.row import Check

#: What each family is about, in the order of the report.
FAMILIES = {
    "pairs": "Two spheres",
    "ball": "One ball",
    "galperin": "Galperin's billiard",
    "rods": "Rods on a line",
    "collapse": "Inelastic collapse",
    "sinai": "Two spheres in a cube",
    "fluid": "The fluid",
    "programs": "Against other programs",
    "crystal": "The crystal",
    "mixture": "Mixtures",
    "flights": "Free flights",
    "speeds": "Speeds",
    "diffusion": "Diffusion",
    "transport": "Viscosity and conduction of heat",
    "cooling": "A gas that cools",
    "two-kinds": "Two kinds that cool",
    "column": "Gas under gravity",
    "walls": "Gas between walls",
}


def checks() -> list[Check]:
    """All of them, in the order of the report."""
    parts = (contacts, lines, fluids, mixtures, flights, transport, granular, columns)
    found = [check for part in parts for check in part.checks()]
    order = list(FAMILIES)
    return sorted(found, key=lambda check: order.index(check.family))


def named(name: str) -> Check:
    """The check of this name."""
    return next(check for check in checks() if check.name == name)


def chosen(patterns: str | None) -> list[Check]:
    """Checks by a list of families or names, in which * stands for anything; None: all.

    Raises
    ------
    UnknownNameError
        If one matches nothing.
    """
    everything = checks()
    if patterns is None:
        return everything
    wanted: set[str] = set()
    for pattern in patterns.split(","):
        some = [
            check.name
            for check in everything
            if fnmatchcase(check.family, pattern) or fnmatchcase(check.name, pattern)
        ]
        if not some:
            names = dict.fromkeys([*FAMILIES, *(check.name for check in everything)])
            msg = f"there is no family or check {pattern!r}{nearest(pattern, names)}"
            raise UnknownNameError(msg)
        wanted.update(some)
    return [check for check in everything if check.name in wanted]
