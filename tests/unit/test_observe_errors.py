"""Error bars: are they right, and do they say when they cannot be?"""

import math

import numpy as np
import pytest

import carom
from carom import observe
from carom.observe import Estimate, blocking, settling
from carom.observe.blocking import ratio
from carom.observe.series import MOST, Series


def ar1(rng, n, tau):
    """x' = a x + noise with unit variance: g = (1 + a)/(1 - a) samples count as one."""
    a = math.exp(-1 / tau) if tau else 0.0
    noise = rng.normal(size=n) * math.sqrt(1 - a * a)
    noise[0] = rng.normal()
    x = np.empty(n)
    x[0] = noise[0]
    for k in range(1, n):
        x[k] = a * x[k - 1] + noise[k]
    return x, (1 + a) / (1 - a)


class TestBlocking:
    @pytest.mark.parametrize(("tau", "n"), [(0, 512), (0, 4096), (3, 4096), (20, 16384)])
    def test_one_sigma_covers_what_it_should(self, tau, n):
        rng, runs = np.random.default_rng(tau + n), 400 if n < 5000 else 150
        found = [blocking(ar1(rng, n, tau)[0]) for _ in range(runs)]
        off = np.array([e.deviation(0.0) for e in found])
        # 68.27 % of a normal variable lie within one sigma, 95.45 % within two.
        for sigmas, share in ((1, 0.6827), (2, 0.9545)):
            error = math.sqrt(share * (1 - share) / runs)
            assert abs((abs(off) < sigmas).mean() - share) < 3.5 * error
        true = math.sqrt(ar1(rng, 2, tau)[1] / n)
        assert np.mean([e.error for e in found]) == pytest.approx(true, rel=0.05)
        assert np.mean([e.n_independent for e in found]) == pytest.approx(1 / true**2, rel=0.25)

    def test_the_spread_alone_would_be_far_too_small(self):
        x, g = ar1(np.random.default_rng(1), 2**14, 20)
        assert blocking(x).error > 4 * x.std() / math.sqrt(len(x))
        assert g == pytest.approx(40, rel=0.01)

    def test_constant_data_have_no_error(self):
        assert blocking([0.1] * 1000).error == 0
        assert blocking(np.zeros(8)).error == 0

    def test_too_few_give_no_error_rather_than_a_lie(self):
        assert math.isnan(blocking([1.0, 2.0, 3.0]).error)
        assert math.isnan(blocking([]).value)
        x, _ = ar1(np.random.default_rng(1), 200, 100)  # two independent samples
        assert math.isnan(blocking(x).error)
        assert str(blocking([1.0, 2.0])) == "1.5(?)"

    @pytest.mark.parametrize("look", [blocking, settling])
    @pytest.mark.parametrize(
        ("values", "message"),
        [
            ([[1.0, 2.0]], r"not an array of shape \(1, 2\)"),
            ([1.0, math.nan] * 100, "number 1 is nan"),
            ("soon", "not 'soon'"),
            ([[1.0], [2.0, 3.0]], r"not \[\[1.0\]"),
        ],
    )
    def test_what_is_no_series_is_refused(self, look, values, message):
        with pytest.raises(carom.InputError, match=f"one row of finite numbers.*{message}"):
            look(values)

    def test_a_ratio_knows_that_both_parts_vary(self):
        rng, found = np.random.default_rng(3), []
        for _ in range(300):
            weights = rng.exponential(size=1000)
            found.append(ratio(2 * weights + rng.normal(size=1000), weights).deviation(2.0))
        assert np.std(found) == pytest.approx(1, abs=0.15)
        assert ratio(3 * weights, weights).error < 1e-15


class TestSettling:
    def test_a_series_in_equilibrium_has_settled(self):
        rng = np.random.default_rng(5)
        flagged = [not settling(ar1(rng, 2000, 5)[0]).settled for _ in range(200)]
        assert np.mean(flagged) < 0.03

    def test_a_decay_at_the_beginning_is_found_and_nothing_is_cut(self):
        x, _ = ar1(np.random.default_rng(5), 2000, 2)
        drift = 8 * np.exp(-np.arange(2000) / 60)
        found = settling(x + drift)
        assert not found.settled
        assert 0.05 < found.fraction < 0.3
        assert found.shift > 4
        assert "first" in found.note
        assert "nothing was cut" in found.note

    def test_short_and_constant_series_say_nothing(self):
        assert settling([1.0] * 500).note == ""
        assert settling([3.0, 1.0, 1.0]).settled


class TestEstimate:
    @pytest.mark.parametrize(
        ("value", "error", "text"),
        [
            (9.3847, 0.0043, "9.385(4)"),
            (9.3847, 0.0013, "9.3847(13)"),
            (1.02, 0.00196, "1.020(2)"),
            (-0.5, 0.096, "-0.50(10)"),
            (1234.5, 20.0, "1.23(2)e+03"),
            (1.5e-9, 2e-11, "1.50(2)e-09"),
            (0.0, 1e-12, "0.0(10)e-12"),
            (-1e-5, 3e-4, "0.0000(3)"),
            (-0.4, 20.0, "0(2)e+01"),
            (0.0, 0.3, "0.0(3)"),
            (2.5, 0.0, "2.5"),
            (2.5, math.nan, "2.5(?)"),
            (math.nan, math.nan, "nan"),
        ],
    )
    def test_text(self, value, error, text):
        assert str(Estimate(value, error, 10)) == text

    def test_formats_and_notes(self):
        one = Estimate(9.3847, 0.0043, 1200, "beware")
        assert f"{one}" == "9.385(4)"
        assert f"{one:.3f}" == "9.385 ± 0.004"
        assert repr(one) == "Estimate(9.385(4), 1200 independent; beware)"

    def test_deviation(self):
        assert Estimate(1.0, 0.3, 9).deviation(0.5, 0.4) == pytest.approx(1.0)
        assert Estimate(1.0, 0.0, 9).deviation(1.0) == 0
        assert Estimate(1.0, 0.0, 9).deviation(2.0) == -math.inf
        assert math.isnan(Estimate(1.0, math.nan, 9).deviation(2.0))


class TestSeries:
    def test_it_comes_out_the_same_however_it_is_fed(self):
        values = np.random.default_rng(2).normal(size=(3 * MOST + 5, 2)) + 4
        ways = []
        for step in (1000, 7777, len(values)):
            series = Series(2)
            for k in range(0, len(values), step):
                series.add(values[k : k + step])
            ways.append((series.rows.copy(), series.total, series.mean(0)))
        for rows, total, mean in ways[1:]:
            assert (rows == ways[0][0]).all()
            assert (total == ways[0][1]).all()
            assert mean == ways[0][2]

    def test_memory_is_bounded_and_nothing_is_lost(self):
        series, values = Series(1), np.ones((10_000, 1))
        for _ in range(50):
            series.add(values)
        assert len(series.rows) <= MOST
        assert series.total[0] == 500_000
        assert series.mean(0) == Estimate(1.0, 0.0, len(series.rows))


def test_log_times():
    times = carom.log_times(1e-2, 1e2, 60)
    assert len(times) == 60
    assert (times[0], times[-1]) == (0.01, 100)
    assert np.diff(np.log(times)) == pytest.approx(np.log(1e4) / 59)
    for wrong in ((0, 1, 3), (2, 1, 3), (1, 2, 1)):
        with pytest.raises(carom.InputError):
            carom.log_times(*wrong)


def test_public_names():
    for name in observe.__all__:
        assert getattr(observe, name).__doc__
