"""The list of mutations fits the package; ``python -m validation mutations`` applies them."""

from collections import Counter
from pathlib import Path

import pytest

from validation.mutations.lists import ALL
from validation.mutations.mutation import PACKAGE, ROOT, Mutation
from validation.mutations.run import main, quick, summary, tried

FEWEST, FEWEST_OF_A_FOLDER = 60, 5
TESTS = ROOT / "tests"


@pytest.mark.parametrize("mutation", ALL, ids=lambda one: one.name)
def test_mutation_applies_once_and_compiles(mutation):
    changed = mutation.applied()
    compile(changed, mutation.file, "exec")
    assert changed != (ROOT / PACKAGE / mutation.file).read_text(encoding="utf-8")
    for test in mutation.tests:
        file, _, name = test.partition("[")[0].partition("::")
        assert f"def {name}(" in (TESTS / file).read_text(encoding="utf-8") if name else True
        assert (TESTS / file).is_file()


def test_every_folder_has_its_mutations():
    """`demo` calls the others and has no physics of its own."""
    folders = {
        path.parent.relative_to(ROOT / PACKAGE).parts[0]
        for path in (ROOT / PACKAGE).glob("*/**/*.py")
    }
    counts = Counter(Path(one.file).parts[0] for one in ALL)
    assert len(ALL) >= FEWEST
    assert {name: counts[name] for name in folders - {"demo"}} == {
        name: max(counts[name], FEWEST_OF_A_FOLDER) for name in folders - {"demo"}
    }
    assert len({(one.file, one.old, one.new) for one in ALL}) == len(ALL)


def test_quick_takes_one_of_each_folder():
    assert len({one.folder for one in quick(ALL)}) == len(quick(ALL)) == 10


def test_changed_code_asks_for_a_new_list():
    outcome = tried(Mutation("theory/motion.py", "no such text", "", ("test_layout.py",), "old"))
    assert outcome.verdict == "error"
    assert "'no such text' stands there 0 times" in str(outcome)
    assert summary([outcome]).splitlines()[-1].split() == ["all", "0", "1"]


def test_list_and_unknown_text(capsys):
    assert main(["--list", "--only", "theory/axis.py"]) == 0
    assert capsys.readouterr().out.startswith("theory/axis.py: ")
    with pytest.raises(SystemExit):
        main(["--only", "nothing of the kind"])
    assert "no mutation has 'nothing of the kind'" in capsys.readouterr().err
