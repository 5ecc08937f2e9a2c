"""Memory that is available, and the error where that is too little."""

from __future__ import annotations

from pathlib import Path

import psutil

# limit and use of the control group of a container (Linux)
_GROUPS = (
    ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
    (
        "/sys/fs/cgroup/memory/memory.limit_in_bytes",
        "/sys/fs/cgroup/memory/memory.usage_in_bytes",
    ),
)


class TooLittleMemoryError(MemoryError):
    """What is to be computed needs more memory than is available."""


def available_memory() -> float:
    """Return the bytes that can be allocated before the operating system swaps or kills."""
    available = float(psutil.virtual_memory().available)
    for limit, used in _GROUPS:
        try:
            allowed, taken = Path(limit).read_text().strip(), Path(used).read_text()
        except OSError:
            continue
        if allowed.isdigit():  # 'max' where there is no limit
            available = min(available, float(allowed) - float(taken))
    return max(available, 0.0)
