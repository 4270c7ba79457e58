"""Which machine this is, as far as it says."""

import os
import platform
import subprocess
import sys
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from carom._core import simd, simd_levels

#: Where Linux describes the caches of the first core.
CACHES = Path("/sys/devices/system/cpu/cpu0/cache")
PROCESSORS = Path("/proc/cpuinfo")
#: What macOS calls them.
CACHES_OF_MACOS = {"L1": "hw.l1dcachesize", "L2": "hw.l2cachesize", "L3": "hw.l3cachesize"}


def description() -> dict[str, Any]:
    """Processor, caches, memory, system, Python, carom.

    Returns
    -------
    dict
        With entries ``cpu``; ``clock_ghz`` (nominal, or None); ``cores``; ``caches`` (bytes of
        ``L1`` for data, ``L2``, ``L3``, as far as known); ``memory`` (bytes, or None);
        ``system``; ``python``; ``numpy``; ``carom``; ``compiler`` (of the core, or None);
        ``simd`` in use and ``simd_levels`` to choose from.
    """
    return {
        "cpu": _processor(),
        "clock_ghz": _clock(),
        "cores": os.cpu_count(),
        "caches": _caches(),
        "memory": memory(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "numpy": np.__version__,
        "carom": version("carom"),
        "compiler": _compiler(),
        "simd": simd(),
        "simd_levels": simd_levels(),
    }


def memory() -> int | None:
    """Bytes of memory this machine has; None if it does not tell."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return None


def peak_memory() -> int | None:
    """Most memory this process has had at once, bytes; None if it is not told.

    Linux's ``getrusage`` would include what the parent had when this process was made.
    """
    try:
        for line in Path("/proc/self/status").read_text("ascii").splitlines():
            if line.startswith("VmHWM:"):
                return 1024 * int(line.split()[1])
    except OSError:
        pass
    if sys.platform == "darwin":
        import resource

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return None


def _processor() -> str:
    return (
        _cpuinfo("model name")
        or _sysctl("machdep.cpu.brand_string")
        or platform.processor()
        or platform.machine()
    )


def _clock() -> float | None:
    megahertz = _cpuinfo("cpu MHz")
    return round(float(megahertz) / 1000, 2) if megahertz else None


def _caches() -> dict[str, int]:
    """Bytes of each cache that one core sees."""
    found = {}
    for index in sorted(CACHES.glob("index*")):
        level, kind, size = (
            index.joinpath(name).read_text("ascii").strip() for name in ("level", "type", "size")
        )
        if kind != "Instruction" and size.endswith("K"):
            found[f"L{level}"] = 1024 * int(size[:-1])
    for level, name in CACHES_OF_MACOS.items():
        size = "" if found.get(level) else _sysctl(name)
        if size:
            found[level] = int(size)
    return found


def _compiler() -> str | None:
    """What the compiled core says of its compiler; builds may leave the remark out."""
    core = find_spec("carom._core")
    assert core is not None
    assert core.origin is not None
    remark = Path(core.origin).read_bytes()
    for sign in (b"GCC: (", b"clang version "):
        start = remark.find(sign)
        if start >= 0:
            return remark[start : remark.index(b"\0", start)].decode("ascii", "replace")
    return None


def _cpuinfo(name: str) -> str:
    """The first value of this name that Linux tells of its processors."""
    try:
        lines = PROCESSORS.read_text("utf-8").splitlines()
    except OSError:
        return ""
    return next((line.partition(":")[2].strip() for line in lines if line.startswith(name)), "")


def _sysctl(name: str) -> str:
    """What macOS says under this name."""
    if sys.platform != "darwin":
        return ""
    done = subprocess.run(["sysctl", "-n", name], capture_output=True, text=True, check=False)
    return done.stdout.strip()
