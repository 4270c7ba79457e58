"""The passwords of a view."""

import os
import stat
import time

import pytest

import carom
from carom import scenes
from carom.view import LiveView, tokens


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    return tmp_path / "carom"


def test_any_free_port_gets_a_fresh_token_and_leaves_nothing(home):
    assert tokens.of_port(0, "control") != tokens.of_port(0, "control")
    assert not home.exists()


def test_a_port_keeps_its_token_and_nobody_else_reads_it(home):
    first = tokens.of_port(8000, "control")
    assert tokens.of_port(8000, "control") == first
    assert len({first, tokens.of_port(8001, "control"), tokens.of_port(8000, "watch")}) == 3
    for path in home.iterdir():
        assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_it_is_renewed_after_a_week(home):
    first = tokens.of_port(8000, "control")
    old = time.time() - tokens.KEPT - 60
    os.utime(home / "control-8000", (old, old))
    assert tokens.of_port(8000, "control") != first


@pytest.mark.parametrize("spoil", [lambda p: p.chmod(0o644), lambda p: p.write_text("short")])
def test_a_file_that_others_read_or_that_holds_no_token_is_replaced(home, spoil):
    first = tokens.of_port(8000, "control")
    spoil(home / "control-8000")
    second = tokens.of_port(8000, "control")
    assert second != first
    assert len(second) == len(first)
    assert stat.S_IMODE((home / "control-8000").stat().st_mode) == 0o600


def test_a_link_is_never_written_through(home, tmp_path):
    home.mkdir(mode=0o700)
    precious = tmp_path / "precious"
    precious.write_text("kept")
    (home / "control-8000").symlink_to(precious)
    tokens.of_port(8000, "control")
    assert precious.read_text() == "kept"


def test_a_folder_that_others_write_to_is_not_trusted(home):
    first = tokens.of_port(8000, "control")
    for mode in (0o770, 0o702):
        home.chmod(mode)
        assert tokens.of_port(8000, "control") != first
    home.chmod(0o700)
    assert tokens.of_port(8000, "control") == first


def test_a_folder_that_is_a_link_is_not_trusted(home, tmp_path):
    (tmp_path / "elsewhere").mkdir(mode=0o700)
    home.symlink_to(tmp_path / "elsewhere")
    assert tokens.of_port(8000, "control") != tokens.of_port(8000, "control")
    assert list((tmp_path / "elsewhere").iterdir()) == []


def test_a_link_is_never_read_through(home, tmp_path):
    known = tokens.fresh()
    (tmp_path / "known").write_text(known)
    (tmp_path / "known").chmod(0o600)
    home.mkdir(mode=0o700)
    (home / "control-8000").symlink_to(tmp_path / "known")
    assert tokens.of_port(8000, "control") != known


def test_a_pipe_holds_nobody_up(home):
    home.mkdir(mode=0o700)
    os.mkfifo(home / "control-8000", 0o600)
    assert len(tokens.of_port(8000, "control")) == len(tokens.fresh())


def test_a_relative_home_and_none_at_all(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("XDG_STATE_HOME", "here")
    first = tokens.of_port(8000, "control")
    assert not (tmp_path / "here").exists()
    assert tokens.of_port(8000, "control") == first

    def homeless():
        msg = "Could not determine home directory."
        raise RuntimeError(msg)

    monkeypatch.setattr("carom.view.tokens.Path.home", homeless)
    assert tokens.of_port(8000, "control") != first


def test_without_a_place_to_write_it_works_all_the_same(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "file"))
    assert len(tokens.of_port(8000, "control")) == len(tokens.fresh())


def test_a_view_at_a_port_is_known_again():
    with LiveView(carom.Simulation(scenes.phase_3())) as view:
        port = view._socket.getsockname()[1]
    urls = []
    for _ in range(2):
        with LiveView(carom.Simulation(scenes.phase_3()), port=port) as view:
            urls.append((view.url, view.watch_url))
    assert urls[0] == urls[1]
