"""What is compiled for one instruction set must not leak into code for another.

The linker keeps one copy of an inline function. If that is the copy of a file compiled for AVX-512,
a machine without it stops at an illegal instruction, in code that has nothing to do with it.
"""

import platform
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CMAKE = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
OPTIONS = dict(
    re.findall(r'core/simd/(\w+)\.cpp PROPERTIES COMPILE_OPTIONS\s+"([^"]+)"', CMAKE),
    baseline="",
)
COMPILERS = [name for name in ("g++", "clang++") if shutil.which(name)]


@pytest.mark.skipif(shutil.which("nm") is None, reason="nm lists the symbols, and is not installed")
@pytest.mark.skipif(not COMPILERS, reason="neither g++ nor clang++ is installed")
@pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="instruction sets are those of x86-64"
)
@pytest.mark.parametrize("optimization", ["-O0", "-O2", "-O3"])
@pytest.mark.parametrize("level", OPTIONS)
@pytest.mark.parametrize("compiler", COMPILERS)
def test_each_instruction_set_exports_one_function(compiler, level, optimization, tmp_path):
    out = tmp_path / "loops.o"
    flags = [flag for flag in OPTIONS[level].split(";") if flag]
    source = ROOT / "core" / "simd" / f"{level}.cpp"
    command = [compiler, "-std=c++20", "-fPIC", "-Wno-psabi", optimization, *flags]
    subprocess.run([*command, "-c", str(source), "-o", str(out)], check=True)
    listed = subprocess.run(
        ["nm", "--defined-only", "--extern-only", "-C", str(out)],
        check=True,
        capture_output=True,
        text=True,
    )
    symbols = [line.split(maxsplit=2)[1:] for line in listed.stdout.splitlines()]
    assert symbols == [["T", f"carom::{level}::kernels()"]]


def test_every_instruction_set_is_looked_at():
    assert set(OPTIONS) == {path.stem for path in ROOT.glob("core/simd/*.cpp")} - {"kernels"}
