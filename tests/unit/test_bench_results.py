"""Results of the benchmark: their file, their comparison, the machine they come from."""

import json
import os
from pathlib import Path

import pytest

from carom.bench import machine, results
from carom.errors import FileError, InputError

ROW = {
    "name": "fluid-1000-0.25", "n": 1000, "nanoseconds": [200.0, 100.0],
    "median_nanoseconds": 150.0, "best_nanoseconds": 100.0, "answer": [5, 0.5],
}  # fmt: skip


class TestMachine:
    def test_description(self):
        found = machine.description()
        assert found["cpu"]
        assert found["cores"] == os.cpu_count()
        assert found["simd"] in found["simd_levels"]
        json.dumps(found, allow_nan=False)

    def test_linux(self, monkeypatch, tmp_path):
        monkeypatch.setattr(machine, "CACHES", tmp_path)
        for k, (level, kind, size) in enumerate(
            [("1", "Data", "32K"), ("1", "Instruction", "64K"), ("2", "Unified", "1024K")]
        ):
            index = tmp_path / f"index{k}"
            index.mkdir()
            for name, text in {"level": level, "type": kind, "size": size}.items():
                (index / name).write_text(text + "\n", "ascii")
        cpuinfo = tmp_path / "cpuinfo"
        cpuinfo.write_text("model name\t: Quick 3000\ncpu MHz\t\t: 2596.126\n", "utf-8")
        monkeypatch.setattr(machine, "PROCESSORS", cpuinfo)
        found = machine.description()
        assert found["caches"] == {"L1": 32 * 1024, "L2": 1024 * 1024}
        assert (found["cpu"], found["clock_ghz"]) == ("Quick 3000", 2.6)

    def test_elsewhere(self, monkeypatch, tmp_path):
        monkeypatch.setattr(machine, "CACHES", tmp_path / "no")
        monkeypatch.setattr(machine, "PROCESSORS", tmp_path / "no")
        said = {"hw.l1dcachesize": "65536", "hw.l2cachesize": "4194304"}
        said["machdep.cpu.brand_string"] = "Apple M9"
        monkeypatch.setattr(machine, "_sysctl", lambda name: said.get(name, ""))
        found = machine.description()
        assert found["caches"] == {"L1": 65536, "L2": 4194304}
        assert (found["cpu"], found["clock_ghz"]) == ("Apple M9", None)


class TestResults:
    @pytest.fixture
    def data(self):
        return results.result([dict(ROW)], left_out=["large"])

    def test_a_file_comes_back(self, data, tmp_path):
        path = tmp_path / "result.json"
        results.write(path, data)
        assert results.read(path) == data
        assert sum(line.startswith('  {"name"') for line in path.read_text().splitlines()) == 1

    @pytest.mark.parametrize(
        ("change", "words"),
        [({"format": "other"}, "is no result of carom bench"),
         ({"format_version": 9}, "has version 9 of the format"),
         ({"rows": [{"name": "x"}]}, "something is missing"),
         ({"rows": 5}, "something is missing"), ({"machine": None}, "something is missing")],
    )  # fmt: skip
    def test_other_files_are_refused(self, data, tmp_path, change, words):
        path = tmp_path / "result.json"
        path.write_text(json.dumps({**data, **change}))
        with pytest.raises(InputError, match=words):
            results.read(path)

    @pytest.mark.parametrize("text", ["", "[]", "hello", "3"])
    def test_what_is_no_result_at_all(self, tmp_path, text):
        path = tmp_path / "result.json"
        path.write_text(text)
        with pytest.raises(InputError, match="is no result of carom bench"):
            results.read(path)

    def test_files_that_are_not_there(self, data, tmp_path):
        with pytest.raises(FileError, match="cannot read"):
            results.read(tmp_path / "no.json")
        with pytest.raises(FileError, match="cannot write"):
            results.write(tmp_path / "no" / "no.json", data)

    def test_compare(self, data):
        now = json.loads(json.dumps(data))
        now["rows"][0] |= {"median_nanoseconds": 75.0, "best_nanoseconds": 25.0, "answer": [5, 0.6]}
        now["rows"].append({**now["rows"][0], "name": "new"})
        now["machine"]["simd"] = "avx9"
        (only,) = results.compare(now, data)
        assert only == ("fluid-1000-0.25", 2.0, 4.0, False)
        assert results.geometric_mean([2.0, 0.5]) == pytest.approx(1)
        assert results.differences(data, data) == []
        assert results.differences(now, data) == [
            f"simd {data['machine']['simd']} before, avx9 now"
        ]


def test_the_kept_results_can_be_read():
    kept = Path(__file__).parents[2] / "benchmarks/results/speed.json"
    assert results.read(kept)["rows"]
