"""`carom show RUN.gsd`: who gets the page, and what is said."""

import json
import urllib.error
import urllib.request

import pytest

import carom
from carom import scenes
from carom.cli import main, replaying
from carom.view.playing import play


def fetch(address, host=None):
    request = urllib.request.Request(address, headers={} if host is None else {"Host": host})
    try:
        with urllib.request.urlopen(request, timeout=10) as answer:
            return answer.status, answer.headers, answer.read().decode()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.headers, ""


def test_only_who_knows_the_address_gets_the_page():
    seen = []

    def ready(address):
        root = address.rsplit("/", 1)[0]
        seen.append((address, fetch(address)))
        assert fetch(root + "/")[0] == 404
        assert fetch(root + "/main.js")[0] == 404
        assert fetch(address, host="evil.example")[0] == 403
        raise KeyboardInterrupt

    for _ in range(2):
        play("<p>Σ", open_browser=False, on_ready=ready)
    (one, (status, headers, text)), (two, _) = seen
    assert (status, text) == (200, "<p>Σ")
    assert headers["Content-Security-Policy"] == "frame-ancestors 'none'"
    assert headers["Content-Type"] == "text/html; charset=utf-8"
    assert one.startswith("http://127.0.0.1:")
    names = [address.rsplit("/", 1)[1] for address in (one, two)]
    assert len(names[0]) > 20
    assert names[0] != names[1]


@pytest.fixture
def recording(tmp_path):
    path = tmp_path / "run.gsd"
    with carom.Simulation(scenes.build("two-balls")) as sim:
        sim.record(path, every=1)
        sim.run(until=3)
    return path


def command(*words):
    with pytest.raises(SystemExit) as end:
        main(["show", *map(str, words)])
    return end.value.code


def test_the_command_plays_a_recording(recording, monkeypatch, capsys):
    played = []

    def instead(page, *, on_ready, **options):
        played.append((page, options))
        on_ready("http://127.0.0.1:1/secret")

    monkeypatch.setattr(replaying, "play", instead)
    assert command(recording, "--no-browser", "--port", 81) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert said == f"carom plays {recording} at http://127.0.0.1:1/secret (Ctrl-C ends it)"
    page, options = played[0]
    assert "<title>Two balls</title>" in page
    assert options == {"host": "127.0.0.1", "port": 81, "open_browser": False}
    assert command(recording, "--json") == 0
    assert json.loads(capsys.readouterr().out) == {
        **{"address": "http://127.0.0.1:1/secret", "scene": "Two balls", "n": 2}
    }
    assert played[1][1]["open_browser"] is True


def test_progress_shows_on_a_terminal_only(recording, monkeypatch, capsys):
    monkeypatch.setattr(replaying, "play", lambda page, **options: None)
    assert command(recording) == 0
    assert capsys.readouterr().err == ""
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert command(recording) == 0
    assert "Two balls" in capsys.readouterr().err
    assert command(recording, "--quiet") == 0
    assert capsys.readouterr().err == ""


def test_mistakes_get_a_sentence(recording, capsys):
    assert command(recording, "--n", 5) == 2
    assert "a recording has no options, but there is '--n'" in capsys.readouterr().err
    for words in (("--method", "tick"), ("--tick", 1), ("--seed", 3)):
        assert command(recording, *words) == 2
        assert f"has no options, but there is '{words[0]}'" in capsys.readouterr().err
    assert command("nowhere.gsd") == 1
    assert "nowhere.gsd" in capsys.readouterr().err
