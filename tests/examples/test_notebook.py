"""The example notebook runs, and the outputs it is stored with are what it gives today.

``python tests/examples/test_notebook.py`` runs it and stores them anew.
"""

import re
import sys
from pathlib import Path

PATH = Path(__file__).parents[2] / "examples" / "gas.ipynb"


def executed(notebook):
    """A copy with new outputs, and nothing in it that is another on another machine."""
    from nbclient import NotebookClient

    notebook = notebook.copy()
    NotebookClient(notebook, timeout=120, kernel_name="python3", store_widget_state=False).execute()
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    for cell in notebook.cells:
        cell.metadata = {}
        for output in cell.get("outputs", []):
            # A widget's number is drawn anew each time; without its state it shows nothing.
            output.get("data", {}).pop("application/vnd.jupyter.widget-view+json", None)
    return notebook


def read():
    import nbformat

    return nbformat.read(PATH, as_version=4)


def shown(notebook):
    """Source and outputs of every cell."""
    return [
        (cell.source, [dict(output) for output in cell.get("outputs", [])])
        for cell in notebook.cells
    ]


def test_the_notebook_says_what_it_says_today():
    stored = read()
    assert shown(executed(stored)) == shown(stored)
    outputs = [output for cell in stored.cells for output in cell.get("outputs", [])]
    assert len(outputs) >= 4
    assert not [output for output in outputs if output["output_type"] == "error"]


def test_the_notebook_knows_no_machine():
    assert not re.search(r"/(home|work|tmp|Users|root)/|0x[0-9a-f]{6}", PATH.read_text("utf-8"))


def write(notebook):
    import nbformat

    PATH.write_text(nbformat.writes(notebook) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write(executed(read()))
    sys.exit()
