"""On what a report was made: versions, machine, how to repeat it."""

from __future__ import annotations

import os
import platform
import re
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path

_NAME = "semispline"
_REQUIREMENT = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")


def environment() -> dict[str, str]:
    """Return names and texts: program, Python, system, processor, every library that is declared and installed."""
    found = {
        _NAME: version(_NAME),
        "Python": f"{platform.python_implementation()} {platform.python_version()}",
        "system": f"{platform.system()} {platform.release()}",
        "processor": f"{_processor()}, {os.cpu_count()} cores",
    }
    return found | {name: text for name in _declared() if (text := _installed(name))}


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    if information.is_file():
        for line in information.read_text(errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _declared() -> list[str]:
    """Return the names of all libraries in the metadata of the distribution, extras included."""
    required = distribution(_NAME).requires or []
    names = {match[0] for line in required if (match := _REQUIREMENT.match(line))}
    return sorted(names - {_NAME}, key=str.lower)


def _installed(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None
