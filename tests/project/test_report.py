"""The report is one file, holds what was given, and nothing in it is taken for HTML."""

from html.parser import HTMLParser

import numpy as np
import pytest
from matplotlib import pyplot
from point_rotors import ring_rotor
from small_results import STORED

from exudyn_rotor import Support, linear_model, report
from exudyn_rotor.results import Result

RESULTS = [kept for kept in STORED.values() if isinstance(kept, Result)]
VOID = {"meta", "img"}


class Page(HTMLParser):
    """What a browser would find."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open, self.links, self.headings, self.tags = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.links += [value for name, value in attributes if name in ("src", "href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] in ("h1", "h2"):
            self.headings.append(data)


@pytest.fixture
def written(tmp_path):
    def make(contents, **given):
        report(tmp_path / "report.html", contents, **given)
        return (tmp_path / "report.html").read_text(encoding="utf-8")

    return make


def test_every_result_is_shown_by_table_and_picture(written):
    """A stress field needs modal coordinates, a list of critical speeds has no picture."""
    before = pyplot.get_fignums()
    text = written({type(one).__name__: one for one in RESULTS}, title="All")
    page = Page(text)
    assert page.open == []
    assert page.headings[0] == "All"
    assert len(page.headings) == 1 + len(RESULTS)
    assert text.count("<pre>") == len(RESULTS)
    assert page.tags.count("img") == len(RESULTS) - 2
    assert pyplot.get_fignums() == before


def test_rotors_and_models_are_described(written):
    ring = ring_rotor(0.1, 0.2, 10.0).with_interface("mid", range(10))
    supports = [Support("mid", np.diag([4e5, 8e5]), 200.0)]
    reduced = ring.reduce(2)
    model, ax = linear_model(reduced, supports=supports), pyplot.figure().add_subplot()
    text = written(
        {"Rotor": [ring, reduced], "Support": supports, "Linear model": model, "Picture": ax}
    )
    assert Page(text).headings[1:] == ["Rotor", "Support", "Linear model", "Picture"]
    assert text.count("Support(") == 2
    assert "mass" in text


def test_wrong_input_leaves_the_old_file(written, tmp_path):
    kept = written({"a": "old"})
    for empty in ({}, {"a": []}):
        with pytest.raises(ValueError, match="contents: there are none"):
            written(empty)
    with pytest.raises(ValueError, match="units: 'knots' is unknown"):
        written({"a": "text"}, units="knots")
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == kept
    with pytest.raises(FileNotFoundError, match="path: the folder"):
        report(tmp_path / "nowhere" / "report.html", {"a": "text"})
    with pytest.raises(ValueError, match=r"path: needs the ending .html, got .*report.pdf"):
        report(tmp_path / "report.pdf", {"a": "text"})
