"""One wrong line of physics, put into a copy of the package, and the tests that must notice."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE = "exudyn_rotor"


@dataclass(frozen=True)
class Mutation:
    """A change of one place of the package.

    Attributes
    ----------
    file : str
        Path in the package.
    old, new : str
        Text that stands there exactly once, and what takes its place.
    tests : tuple of str
        Tests that must fail, narrow ones first: files or single tests, relative to ``tests``, of
        some parameters where ``[…]`` follows.
    why : str
        What is wrong about it.
    """

    file: str
    old: str
    new: str
    tests: tuple[str, ...]
    why: str

    @property
    def folder(self) -> str:
        """Folder of the package, two levels deep in ``linear``; 'top' for its own modules."""
        parts = Path(self.file).parent.parts
        return "/".join(parts) or "top"

    @property
    def name(self) -> str:
        """File and what is wrong, in a line."""
        return f"{self.file}: {self.why}"

    def applied(self, root: Path = ROOT) -> str:
        """Return the text of the file with the change in it.

        Raises
        ------
        ValueError
            If the old text does not stand there exactly once.
        """
        path = root / PACKAGE / self.file
        text = path.read_text(encoding="utf-8") if path.is_file() else ""
        count = text.count(self.old)
        if count != 1:
            raise ValueError(
                f"{self.file}: {self.old!r} stands there {count} times instead of once; bring the "
                f"list of mutations up to date ({self.why})"
            )
        return text.replace(self.old, self.new)


def mutations(file: str, tests: str, *changes: tuple[str, str, str]) -> list[Mutation]:
    """Return changes (why, old, new) of one file that the same tests must notice."""
    return [Mutation(file, old, new, tuple(tests.split()), why) for why, old, new in changes]
