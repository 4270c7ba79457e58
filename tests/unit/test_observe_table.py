"""Results as tables: text, files, pandas, pictures."""

import csv
import json
import math
import sys

import numpy as np
import pytest

import carom
from carom.observe import Estimate, Table
from carom.observe.table import Theory


@pytest.fixture
def table():
    return Table(
        "Mean square displacement",
        {
            "time": np.array([0.1, 1.0, 20.0]),
            "msd": np.array([0.02, 1.01, 5.0]),
            "msd_error": np.array([0.001, 0.02, math.nan]),
            "msd_theory": np.array([0.03, 3.0, math.nan]),
        },
        {"time": "time", "msd": "length^2"},
        "free flight, short times",
        ("not settled",),
    )


def test_text(table):
    assert str(table).splitlines() == [
        "Mean square displacement",
        "time         msd  msd (theory)",
        " 0.1  0.0200(10)          0.03",
        "   1     1.01(2)             3",
        "  20        5(?)              ",
        "theory: free flight, short times",
        "not settled",
        "(?): too few independent samples to know the error; run longer",
    ]
    assert len(table) == 3
    assert repr(table) == str(table)


def test_reading(table):
    assert table["msd"][1] == 1.01
    assert table.estimate("msd", 1).deviation(1.0) == pytest.approx(0.5)
    assert table.measured == ["msd"]
    with pytest.raises(carom.InputError, match="no column 'mds'; there are time, msd"):
        table["mds"]


def test_estimates_make_a_table_too():
    one = Table.of_estimates(
        "Z", {"Z": (Estimate(9.3, 0.1, 50, "beware"), Theory(9.38, "CS")),
              "P": (Estimate(2.0, 0.5, 10), None)},
    )  # fmt: skip
    assert one["value_theory"].tolist()[0] == 9.38
    assert math.isnan(one["value_theory"][1])
    assert one.estimate("value", 0) == Estimate(9.3, 0.1, 50)
    assert (one.theory, one.notes) == ("CS", ("beware",))
    assert one.rows()[1] == ["P", "2.0(5)", "10", ""]


def test_csv(table, tmp_path):
    table.save(tmp_path / "a.csv")
    lines = (tmp_path / "a.csv").read_text("utf-8").splitlines()
    assert lines[:5] == [
        "# Mean square displacement", "# time in time", "# msd in length^2",
        "# theory: free flight, short times", "# not settled",
    ]  # fmt: skip
    rows = list(csv.DictReader(lines[5:]))
    assert [float(row["msd"]) for row in rows] == [0.02, 1.01, 5.0]
    assert list(rows[0]) == list(table.columns)


def test_json(table, tmp_path):
    table.save(str(tmp_path / "a.json"))
    data = json.loads((tmp_path / "a.json").read_text("utf-8"))
    assert data == table.as_data()
    assert data["columns"]["msd_error"] == [0.001, 0.02, None]
    assert data["units"] == {"time": "time", "msd": "length^2"}


def test_npz(table, tmp_path):
    table.save(tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as data:
        assert data["msd"].tolist() == [0.02, 1.01, 5.0]
        assert json.loads(str(data["about"]))["title"] == table.title


def test_files_that_cannot_be(table, tmp_path):
    with pytest.raises(carom.InputError, match=r"a.txt is none of .csv, .json, .npz"):
        table.save(tmp_path / "a.txt")
    with pytest.raises(carom.FileError, match=r"cannot write .*: No such file"):
        table.save(tmp_path / "nowhere" / "a.csv")


def test_pandas(table):
    frame = table.to_pandas()
    assert frame["msd"].tolist() == [0.02, 1.01, 5.0]
    assert frame.attrs["theory"] == "free flight, short times"


def test_a_picture(table):
    import matplotlib

    matplotlib.use("agg")
    axes = table.plot()
    assert axes.get_title() == table.title
    assert axes.get_xlabel() == "time"
    assert axes.get_ylabel() == "msd (length²)"
    assert axes.get_xscale() == "log"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        "theory: free flight, short times",
        "msd",
    ]
    names = Table.of_estimates("Z", {"Z": (Estimate(9.3, 0.1, 50), Theory(9.38, "CS"))})
    assert names.plot(axes.figure.add_subplot()).get_xscale() == "linear"


@pytest.mark.parametrize(
    ("module", "action", "message"),
    [
        ("pandas", "to_pandas", r"to_pandas\(\) needs pandas: pip install .carom\[analysis\]"),
        ("matplotlib", "plot", r"plot\(\) needs matplotlib: pip install .carom\[plot\]"),
    ],
)
def test_what_is_not_installed_is_named(table, monkeypatch, module, action, message):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(carom.InputError, match=message):
        getattr(table, action)()
