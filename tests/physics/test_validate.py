"""The quick report of ``carom validate``, as a user runs it: every row is as it should be."""

from carom.validate import catalogue, suite


def test_every_row_of_the_quick_report():
    checks = catalogue.checks()
    done = list(suite.results(checks, suite.QUICK))
    assert {check["check"] for check in done} == {check.name for check in checks}
    assert not [(check["check"], check["failure"]) for check in done if check["failure"]]
    rows = [row for check in done for row in check["rows"]]
    assert len({row["name"] for row in rows}) == len(rows) >= 100
    off = [(row["name"], row["measured"], row["reference"]) for row in rows if not row["passed"]]
    assert not off
    # Deviations are neither too large nor, as from errors that are too large, too small.
    squares = [row["deviation"] ** 2 for row in rows if row["kind"] == "statistical"]
    assert 0.3 < sum(squares) / len(squares) < 1.8
