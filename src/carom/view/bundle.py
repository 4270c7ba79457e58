"""The page as one file that loads nothing: for replays, and for frames without a server."""

import base64
import hashlib
import html
import re
import zlib
from functools import cache

from carom.view.files import FOLDER, TYPES, VIEW, StaticFile

#: Where the live page finds the page of a replay.
TEMPLATE = "/replay.html"
#: Where the data of a replay goes: in front of this.
DATA_END = "</script><!-- data ends -->"
_IMPORT = re.compile(r'^import\s*\{([^}]*)\}\s*from\s*"\./(\w+)\.js";[ \t]*\n', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:async function|function|class|const) (\w+))", re.MULTILINE)
#: What is left of modules when all was understood: nothing.
_REST = re.compile(r"^\s*(?:import|export)\b.*", re.MULTILINE)
_BLOCK = re.compile(r"^[ \t]*/\*\*(?:(?!\*/).)*\*/[ \t]*\n", re.MULTILINE | re.DOTALL)
_NOTE = re.compile(r"^[ \t]*//.*\n", re.MULTILINE)
_INDENT = re.compile(r"^[ \t]+", re.MULTILINE)
_STYLE_NOTE = re.compile(r"/\*.*?\*/", re.DOTALL)


def page(entry: str, title: str = "carom", data: str = "") -> str:
    """Write the page with everything it needs, under a policy that lets it call nobody.

    Its program is packed, which saves two thirds; ``unpack.js`` adds it to the page as a script
    whose hash the policy names.

    Parameters
    ----------
    entry : str
        Module that starts it, such as "replay.js".
    title : str
    data : str
        Text that the page finds in the element ``#data``; nothing in it is a program.
    """
    program, starter, style = scripts(entry), scripts("unpack.js"), styles()
    body = (FOLDER / VIEW).read_text(encoding="utf-8")
    body = re.sub(r"\s*<(?:link|script)\b[^>]*>(?:</script>)?", "", body)
    icon = base64.b64encode((FOLDER / "icon.svg").read_bytes()).decode()
    policy = (
        f"default-src 'none'; script-src '{_digest(starter)}' '{_digest(program)}'; "
        f"style-src '{_digest(style)}'; img-src data: blob:; base-uri 'none'; form-action 'none'"
    )
    head = (
        f'<meta http-equiv="Content-Security-Policy" content="{policy}" />\n'
        f'    <link rel="icon" href="data:image/svg+xml;base64,{icon}" />\n'
        f"    <title>{html.escape(title)}</title>\n    <style>{style}</style>"
    )
    body = body.replace("<title>carom</title>", head, 1)
    tail = (
        f'<script type="text/plain" id="data">{data}{DATA_END}\n'
        f'    <script type="text/plain" id="program">{_packed(program)}</script>\n'
        f'    <script type="module">{starter}</script>\n  </body>'
    )
    before, after = body.rsplit("</body>", 1)
    return before + tail + after


def template() -> dict[str, StaticFile]:
    """A replay without data, which the live page fills with what it has seen."""
    return {TEMPLATE: StaticFile(page("replay.js").encode(), TYPES["html"])}


def styles() -> str:
    """Every style sheet of the page, in its order, without comments."""
    text = (FOLDER / VIEW).read_text(encoding="utf-8")
    names = re.findall(r'rel="stylesheet" href="/(\w+\.css)"', text)
    sheets = ((FOLDER / name).read_text(encoding="utf-8") for name in names)
    return _INDENT.sub("", _STYLE_NOTE.sub("", "".join(sheets)))


def _packed(text: str) -> str:
    return base64.b64encode(zlib.compress(text.encode(), 9)).decode()


@cache
def scripts(entry: str) -> str:
    """Join a module and all that it imports: each becomes a function that returns its exports."""
    done: dict[str, str] = {}

    def add(name: str) -> None:
        if name in done:
            return
        text = (FOLDER / f"{name}.js").read_text(encoding="utf-8")
        done[name] = ""  # a ring of imports would end here, and a test looks for rings
        for _, other in _IMPORT.findall(text):
            add(other)
        del done[name]
        done[name] = _wrapped(name, text)

    add(entry.removesuffix(".js"))
    # A closing tag inside a text would end the program in the eyes of a browser.
    return "\n".join(done.values()).replace("</script", r"<\/script")


def _wrapped(name: str, text: str) -> str:
    text = _NOTE.sub("", _BLOCK.sub("", text))
    exports = _EXPORT.findall(text)
    text = _EXPORT.sub("", text)
    text = _IMPORT.sub(
        lambda found: f"const {{{found[1].replace(' as ', ': ')}}} = ${found[2]};\n", text
    )
    if rest := _REST.search(text):
        msg = (
            f"{name}.js has an import or export of a form that the bundle does not know: {rest[0]}"
        )
        raise ValueError(msg)
    given = f"return {{ {', '.join(exports)} }};\n" if exports else ""
    return f"const ${name} = (() => {{\n{_INDENT.sub('', text)}{given}}})();"


def _digest(text: str) -> str:
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"
