"""Observables where they have no meaning, and what they all have in common."""

import json

import numpy as np
import pytest

import carom
from carom import observe
from carom.cli import main
from carom.observe import OBSERVABLES, Observable

BOX = carom.Box(9, 9, 9)
PERIODIC = carom.Periodic(9, 9, 9)
CLASSES = pytest.mark.parametrize("make", OBSERVABLES.values(), ids=list(OBSERVABLES))


def gas(walls=PERIODIC, n=27, **options):
    sim = carom.Simulation(walls=walls, **options)
    places = 2.0 * np.stack(np.meshgrid(*[np.arange(3)] * 3), -1).reshape(-1, 3)[:n] - 2
    sim.add_many(places, velocity=np.random.default_rng(1).normal(size=(n, 3)))
    return sim


@pytest.mark.parametrize(
    ("make", "options", "message"),
    [
        (observe.Compressibility, {"walls": carom.Open()}, "open space has no pressure"),
        (observe.Compressibility, {"walls": BOX}, "here are 6 walls; use WallPressure"),
        (observe.Compressibility, {"rule": carom.Smooth(0.9)}, "take restitution 1"),
        (observe.PressureTensor, {"walls": carom.Open()}, "open space has no pressure"),
        (observe.WallPressure, {}, "needs a wall of finite area"),
        (observe.WallPressure, {"walls": carom.Open()}, "needs a wall of finite area"),
        (observe.WallPressure, {"walls": carom.Plane((0, 0, 1), -5)}, "wall of finite area"),
        (observe.CollisionRate, {"collide": False}, "nothing to count where collide=False"),
        (observe.FreeTime, {"walls": BOX, "gravity": (0, 0, -1)}, "take gravity away"),
        (observe.FreePath, {"walls": BOX, "gravity": (0, 0, -1)}, "take gravity away"),
        (observe.Diffusion, {"walls": BOX}, "take carom.Periodic, as walls bound"),
        (observe.Diffusion, {"rule": carom.Smooth(0.9)}, "take restitution 1"),
        (observe.Diffusion, {"walls": carom.Periodic(9, 9, 10)}, "make all sides equal"),
        (observe.Diffusion, {"collide": False}, "all move and collide"),
        (observe.ShearViscosity, {"walls": BOX}, "here are 6 walls; take carom.Periodic"),
        (observe.BulkViscosity, {"walls": carom.Open()}, "x and y and z are open here"),
        (observe.ThermalConductivity, {"rule": carom.Smooth(0.9)}, "take restitution 1"),
        (observe.BulkViscosity, {"collide": False}, "of spheres that all move and collide"),
        (observe.MutualDiffusion, {}, "of two kinds of spheres .* and here is 1 kind"),
        (lambda: observe.ShearViscosity((0.1, 0.2)), {}, "between ends at 0.2, and spheres fly"),
        (observe.RDF, {"walls": BOX}, "or there is no mean density"),
        (observe.RDF, {"walls": carom.Open()}, "or there is no mean density"),
        (lambda: observe.RDF(reach=5), {}, "reach is 5, more than half the shortest side, 4.5"),
        (lambda: observe.RDF(reach=0.5), {}, "no two spheres can be"),
        (observe.DensityProfile, {"walls": carom.Open()}, "needs a box"),
        (observe.DensityProfile, {"walls": carom.Sphere(9)}, "needs a box"),
        (observe.TemperatureProfile, {"walls": carom.Cylinder(9, 9)}, "needs a box"),
    ],
)
def test_where_it_has_no_meaning(make, options, message):
    sim = gas(**options)
    with pytest.raises(carom.InputError, match=message) as refused:
        sim.run(duration=1, observe=make())
    assert str(refused.value).count(". ") == 0  # one sentence
    assert sim.time == 0


@pytest.mark.parametrize(
    ("action", "message"),
    [
        (lambda: observe.DensityProfile(axis="w"), "axis is 'w'"),
        (lambda: observe.DensityProfile(bins=1), "bins is 1; it must be at least 2"),
        (lambda: observe.DensityProfile(bins=10**9), "it must be at least 2 and at most 1000"),
        (lambda: observe.RDF(reach=-1), "reach is -1"),
        (lambda: observe.MSD(at=[0, 1]), "lags are above 0"),
        (lambda: observe.Diffusion(between=(1, 2, 3)), "two lags, not 3"),
        (lambda: observe.ShearViscosity(5), "between must be two lags, not 5"),
        (lambda: observe.BulkViscosity((0, 1)), "the first lag of between is 0"),
        (lambda: observe.ThermalConductivity((2, 1)), "the second lag of between is 1"),
        (lambda: observe.PressureTensor(every=-1), "every is -1"),
        (lambda: observe.Temperature(every=1, at=[2]), "both given"),
        (lambda: observe.Temperature(every=1e-300), "Temperature would look .* each 1e-300"),
        (lambda: observe.MSD(at=[1e-300, 2e-300]), "MSD would look .* each 2e-300"),
    ],
)
def test_bad_options(action, message):
    sim = gas()
    with pytest.raises(carom.InputError, match=message):
        sim.run(duration=1, observe=action())


def test_spheres_it_is_not_about():
    mixed, several = gas(), gas()
    mixed.mass = np.where(np.arange(27) < 9, 2.0, 1.0)
    for make in (observe.SpeedDistribution, observe.HFunction, observe.Diffusion,
                 observe.ThermalConductivity):  # fmt: skip
        with pytest.raises(carom.InputError, match="of one radius and mass, and here are 2"):
            mixed.run(duration=1, observe=make())
    several.mass = 1 + np.arange(27.0)
    with pytest.raises(carom.InputError, match="radius or mass, and here are 27 kinds"):
        several.run(duration=1, observe=observe.MutualDiffusion())
    for make in (observe.CollisionRate, observe.Temperature):
        with pytest.raises(carom.InputError, match="here are 27; give spheres at most 16"):
            several.run(duration=1, observe=make())
    still = gas()
    still.velocity = (0, 0, 0)
    for make in (observe.Compressibility, observe.SpeedDistribution, observe.HFunction,
                 observe.VACF):  # fmt: skip
        with pytest.raises(carom.InputError, match=r"give (them )?velocities"):
            still.run(duration=1, observe=make())


MOVING = (observe.CollisionRate, observe.Temperature, observe.FreeTime, observe.FreePath,
          observe.MSD, observe.VACF)  # fmt: skip


@pytest.mark.parametrize("make", MOVING)
def test_fixed_spheres_alone(make):
    sim = carom.Simulation(walls=PERIODIC)
    sim.add_many([(0, 0, 0), (3, 0, 0)], fixed=True)
    with pytest.raises(carom.InputError, match="of spheres that move, and all are fixed"):
        sim.run(duration=10, observe=make())


def test_a_solid_has_no_natural_lags_of_mutual_diffusion():
    sim = carom.Simulation(carom.scenes.fluid(n=108, packing_fraction=0.494))
    sim.radius = np.where(np.arange(108) < 54, 0.5, 0.505)
    with pytest.raises(carom.InputError, match=r"here it is 0\.50.*; give between="):
        sim.run(duration=1, observe=observe.MutualDiffusion())
    sim.run(duration=1, observe=observe.MutualDiffusion(between=(1, 4)))


@pytest.mark.parametrize("make", [observe.Compressibility, observe.PressureTensor])
def test_fixed_spheres_among_others(make):
    sim = gas(n=20)
    sim.add((3.5, 3.5, 3.5), fixed=True)
    with pytest.raises(carom.InputError, match="of spheres that all move; make none fixed"):
        sim.run(duration=10, observe=make())


@CLASSES
def test_nothing_measured_yet(make):
    with pytest.raises(carom.InputError, match="measured nothing yet"):
        make().result()


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (observe.MSD(at=[5]), "MSD has seen no sample in 0.1: the first is due after 5"),
        (observe.VACF(at=[5]), "no sample"),
        (observe.Diffusion(between=(0.05, 5)), "needs a run of 5 at least, and has seen 0.1"),
        (observe.Temperature(every=5), "no sample"),
        (observe.RDF(every=5), "no sample"),
        (observe.PressureTensor(every=5), "no sample"),
        (observe.FreeTime(), "(no collision|no sphere collide twice) in 0.1"),
        (observe.SpeedDistribution(every=5), "no sample"),
        (observe.DensityProfile(every=5), "no sample"),
    ],
)
def test_too_short_a_run(made, message):
    sim = gas()
    sim.run(duration=0.1, observe=made)
    with pytest.raises(carom.InputError, match=message):
        made.result()


@pytest.mark.parametrize("name", ["compressibility", "collision-rate", "free-time", "free-path"])
def test_no_time_at_all(name):
    sim, made = gas(), OBSERVABLES[name]()
    sim.run(duration=0, observe=made)
    with pytest.raises(carom.InputError, match="no time has passed; run longer"):
        made.result()


@CLASSES
def test_each_has_a_result_that_can_be_kept(make, tmp_path):
    walls = BOX if make is observe.WallPressure else carom.Periodic(6.2, 6.2, 6.2)
    sim, made = gas(walls), make()
    assert isinstance(made, Observable)
    if make is observe.MutualDiffusion:
        sim.species = np.arange(27) % 2
    before = sim.state
    sim.run(collisions=12_000, observe=made)
    twin = gas(walls)
    twin.run(collisions=12_000)
    assert (sim.state.position == twin.state.position).all()
    assert (before.radius == sim.radius).all()
    table = made.table()
    for name in table.columns:
        assert len(table[name]) == len(table) > 0
    for name in table.units:
        assert name in table.columns
    for suffix in ("csv", "json", "npz"):
        made.save(tmp_path / f"it.{suffix}")
    data = json.loads((tmp_path / "it.json").read_text("utf-8"))
    assert list(data["columns"]) == list(table.columns)
    assert len(made.to_pandas()) == len(table)
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    assert made.plot().get_title() == table.title
    pyplot.close("all")


def run(capsys, *words):
    with pytest.raises(SystemExit) as ended:
        main(["run", *words])
    out, err = capsys.readouterr()
    return ended.value.code, " ".join(out.split()), err


class TestCommandLine:
    FLUID = ("fluid", "--n", "200", "--collisions", "2e4")

    def test_a_table(self, capsys):
        names = "Compressibility,collision_rate, max-overlap,energy"
        status, out, err = run(capsys, *self.FLUID, "--observe", names)
        assert (status, err) == (0, "")
        assert "compressibility │ 3.9" in out
        assert "3.98398" in out  # Kolafa, Labik and Malijevsky
        assert "rate (theory)" in out
        assert "max-overlap" in out
        assert "compressibility · theory: Kolafa, Labik and Malijevsky" in out
        assert "is shown; --json has all" in out

    def test_json(self, capsys):
        names = "compressibility,diffusion,rdf"
        words = ("fluid", "--n", "200", "--collisions", "2e3", "--json", "--observe", names)
        status, out, _ = run(capsys, *words)
        data = json.loads(out)
        assert status == 0
        assert data["observed"]["compressibility"]["columns"]["value"][0] == pytest.approx(4, abs=1)
        assert data["observed"]["diffusion"]["error"].startswith("Diffusion has seen no sample in")
        assert list(data["observed"]) == names.split(",")
        _, plain, _ = run(capsys, *self.FLUID, "--json")
        assert "observed" not in json.loads(plain)

    @pytest.mark.parametrize(
        ("names", "message"),
        [
            ("presure", "there is no observable 'presure'; did you mean 'wall-pressure'?"),
            (",", "names with commas between them: bulk-viscosity, collision-rate, "),
            ("", "names with commas between them: bulk-viscosity, "),
            ("msd,msd", "--observe names msd twice"),
            ("wall-pressure", "WallPressure needs a wall of finite area"),
        ],
    )
    def test_bad_names(self, capsys, names, message):
        status, out, err = run(capsys, *self.FLUID, "--observe", names)
        assert (status, out) == (2, "")
        assert message in err
        assert err.count("\n") == 1

    def test_all_are_named(self):
        classes = {
            value for value in vars(observe).values()
            if isinstance(value, type) and issubclass(value, Observable) and value is not Observable
        }  # fmt: skip
        assert set(OBSERVABLES.values()) == classes
