"""Can it be read? Contrast of the page's colours by WCAG 2.2, success criteria 1.4.3 and 1.4.11."""

import re
from importlib import resources

import pytest

CSS = (resources.files("carom.view") / "static" / "style.css").read_text(encoding="utf-8")
#: Text on what it stands on, and how much of a ratio it needs.
PAIRS = [
    *((text, on, 4.5) for text in ("text", "quiet") for on in ("back", "card", "sheet", "well")),
    *((text, on, 4.5) for text in ("good", "fair", "poor") for on in ("card", "sheet", "back")),
    ("on-accent", "accent", 4.5),
    ("accent", "sheet", 4.5),
    ("accent", "card", 3.0),
    ("text", "hover", 4.5),
]


def theme(selector):
    block = re.search(rf"^{re.escape(selector)} {{(.*?)^}}", CSS, re.MULTILINE | re.DOTALL)
    return dict(re.findall(r"--([\w-]+): ([^;]+);", block[1]))


DARK = theme(":root")
LIGHT = {**DARK, **theme(':root[data-theme="light"]')}


def parse(text):
    """Red, green, blue and opacity from 0 to 1."""
    if text.startswith("#"):
        return [int(text[k : k + 2], 16) / 255 for k in (1, 3, 5)], 1.0
    numbers = [float(part) for part in re.findall(r"[\d.]+", text)]
    return [part / 255 for part in numbers[:3]], numbers[3]


def solid(colors, name):
    """A colour over what lies below it: wells lie on cards, cards on the background."""
    rgb, opacity = parse(colors[name])
    if opacity == 1.0:
        return rgb
    below = solid(colors, "card" if name in ("well", "hover") else "back")
    return [opacity * a + (1 - opacity) * b for a, b in zip(rgb, below, strict=True)]


def luminance(rgb):
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a, b):
    bright, dim = sorted((luminance(a), luminance(b)), reverse=True)
    return (bright + 0.05) / (dim + 0.05)


def test_the_formula_is_the_standards():
    assert contrast([1, 1, 1], [0, 0, 0]) == pytest.approx(21)
    assert contrast(parse("#767676")[0], [1, 1, 1]) == pytest.approx(4.54, abs=0.01)


@pytest.mark.parametrize("colors", [DARK, LIGHT], ids=["dark", "light"])
@pytest.mark.parametrize(("text", "on", "least"), PAIRS)
def test_text_can_be_read(colors, text, on, least):
    ratio = contrast(solid(colors, text), solid(colors, on))
    assert ratio >= least, f"{text} on {on}: {ratio:.2f}"
