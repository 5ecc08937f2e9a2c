"""The report is one file, holds what was given, and nothing in it is taken for HTML."""

from html.parser import HTMLParser

import numpy as np
import pytest
from matplotlib import pyplot
from point_rotors import ring_rotor
from small_results import STORED

from exudyn_rotor import (
    Foundation,
    Support,
    linear_model,
    report,
)
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


@pytest.fixture(scope="module")
def ring():
    return ring_rotor(0.1, 0.2, 10.0).with_interface("mid", range(10))


def test_every_result_is_shown_by_table_picture_and_columns(written):
    """A stress field needs modal coordinates, a list of critical speeds has no picture."""
    before = pyplot.get_fignums()
    text = written(RESULTS, title="All")
    page = Page(text)
    assert page.open == []
    assert page.headings[0] == "All"
    assert len(page.headings) == 1 + len(RESULTS)
    assert text.count("<pre>") == text.count('download="') == len(RESULTS)
    assert page.tags.count("img") == len(RESULTS) - 2
    assert pyplot.get_fignums() == before


def test_rotor_supports_and_model_are_described(written, ring):
    """Two rings of 10 kg, r = 0.1 m, at ± 0.2 m: I_p = m r², I_t = m (r²/2 + l²)."""
    supports = [
        Support("mid", np.diag([4e5, 8e5]), 200.0),
        Support("mid", damping=([0.0, 100.0], [1.0, 2.0]), frame="rotor"),
        Support("mid", lambda speed: 1e4 + speed),
    ]
    reduced = ring.reduce(2)
    frame = Foundation.from_modes([300.0], 0.01, {"mid": [[1.0], [0.0], [0.0]]})
    models = [linear_model(reduced, supports=supports[:1], foundation=f) for f in (None, frame)]
    text = written([ring, reduced, supports, *models])
    assert "polar 0.1, mean transverse 0.45 kg m²" in text
    assert "[400000, 0; 0, 800000] N/m" in text
    assert "200 N s/m" in text
    assert "N s/m, by a table of 2 speeds, 0 to 954.93 rpm\n" in text
    assert "N/m, by a function of the speed<" in text
    assert "centrifugal stiffening: tilt\nfree motions: translation along axis" in text
    assert "Foundation(1 coordinates, 47.75 to 47.75 Hz, points: mid)" in text
    assert Page(text).headings[1:] == ["Rotor", "Rotor", "Supports", *["Linear model"] * 2]


def test_wrong_input_leaves_the_old_file(written, tmp_path):
    kept = written("old")
    for contents, message in (
        (3, r"contents\[0\]: needs a rotor, .* got 3"),
        ({"a": ["text", None]}, r"contents\[0\]\['a'\]: needs a rotor"),
        ([Result], r"contents\[0\]: needs a rotor"),
    ):
        with pytest.raises(TypeError, match=message):
            written(contents)
    for empty in ({"a": []}, [[]], {"a": [STORED["StabilityMap"], ()]}):
        with pytest.raises(ValueError, match=r"contents\[0\].*: there are none"):
            written(empty)
    with pytest.raises(ValueError, match="contents: there are none"):
        written([])
    with pytest.raises(TypeError, match="raised: needs warnings or texts, got 3"):
        written("text", raised=[3])
    with pytest.raises(ValueError, match="units: 'knots' is unknown"):
        written("text", units="knots")
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == kept
    with pytest.raises(FileNotFoundError, match="path: the folder"):
        report(tmp_path / "nowhere" / "report.html", "text")
    with pytest.raises(ValueError, match=r"path: needs the ending .html, got .*report.pdf"):
        report(tmp_path / "report.pdf", "text")
