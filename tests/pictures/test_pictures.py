"""Shapes of modes and responses, their files; spectra and orbits of runs."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib import pyplot
from models import centered_disc, disc_rotor
from PIL import Image

import exudyn_rotor as er
from exudyn_rotor.plotting import draw_surface, keep_apart

SPEED = 300.0
EQUAL = [er.Support(name, 2e7, damping=200.0) for name in ("left", "right")]
UNEQUAL = [er.Support(name, [[2e7, 0.0], [0.0, 8e6]], damping=200.0) for name in ("left", "right")]


@cache
def reduced() -> er.ReducedRotor:
    """Return a disc on a shaft along z with first-order elements."""
    return centered_disc(order=1).reduce(4)


@cache
def modes() -> er.MotionShapes:
    return er.mode_shapes(reduced(), SPEED, supports=EQUAL, modes=6, stiffening="tilt")


def test_modes_are_those_of_the_campbell_diagram():
    result = er.campbell(reduced(), [SPEED], supports=EQUAL, stiffening="tilt")
    order = np.argsort(result.frequencies_inertial[0], kind="stable")[:6]
    np.testing.assert_allclose(
        modes().frequencies, result.frequencies_inertial[0, order], rtol=1e-9, atol=1e-6
    )
    assert [label.split(", ")[1] for label in modes().labels] == result.whirl[0, order].tolist()
    assert "backward" in modes().table()


@pytest.mark.parametrize("index", range(6))
def test_a_drawn_mode_names_its_sense_and_covers_no_label(index):
    ax = modes().plot(index)
    ax.figure.canvas.draw()
    sense = modes().labels[index].split(", ")[1]
    wanted = sense if sense in ("forward", "backward") else "straight"
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [wanted, "centre line"]
    legend, whole = ax.get_legend().get_window_extent(), ax.figure.bbox
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        box = axis.label.get_window_extent()
        assert whole.x0 <= box.x0 < box.x1 <= whole.x1
        assert whole.y0 <= box.y0
        ticks = [text.get_window_extent() for text in axis.get_ticklabels()]
        assert not any(legend.overlaps(each) for each in [box, *ticks])
    pyplot.close(ax.figure)


@pytest.mark.parametrize("supports", [EQUAL, UNEQUAL])
def test_orbits_are_those_of_the_response(supports):
    """Of the places that the unbalance response looks at, forward and backward, any supports."""
    given = {"supports": supports, "own": False}
    heavy = [er.Unbalance("right", 1e-4)]
    shapes = er.response_shapes(reduced(), [SPEED], heavy, **given)
    response = er.unbalance_response(reduced(), [SPEED], heavy, at=["left", "right"], **given)
    found = [orbit for _, orbit in shapes.orbits(0, points=9)]
    largest = np.abs(found).max()
    ends = found[0], found[-1]
    for place, orbit in zip(("left", "right"), ends, strict=True):
        # the shaft is a thirtieth of its length further in, where its motion is the mean of a slice
        expected = response.orbit(SPEED, place)[::45]
        np.testing.assert_allclose(orbit[:, :2], expected, atol=0.1 * largest)
    # what the rotor frame sees, turned into space, is the same motion
    node = int(np.argmax(disc_rotor(1).nodes[:, 2]))
    at_node = er.unbalance_response(reduced(), [SPEED], heavy, at=[node], **given)
    for time in (0.0, 0.4 / SPEED):
        local = shapes.displacement(0, time)[node]
        seen = shapes.axis.rotation(SPEED * time) @ local
        orders = at_node.orders
        exact = sum(
            (at_node.phasor(None, "n1", n)[0] * np.exp(1j * n * SPEED * time)).real for n in orders
        )
        np.testing.assert_allclose(seen[0], exact, rtol=1e-6)


@pytest.mark.parametrize("speed", [SPEED, -SPEED])
def test_orbits_of_whirl_are_circles_of_their_sense(speed):
    """Forward whirl turns with the spin, whatever its sign; circles on equal supports."""
    shapes = er.mode_shapes(reduced(), speed, supports=EQUAL, modes=6)
    for index, label in enumerate(shapes.labels):
        word = label.split(", ")[1]
        if word not in ("forward", "backward"):
            continue
        _, orbit = max(shapes.orbits(index, 13), key=lambda pair: np.abs(pair[1]).max())
        radii = np.hypot(*orbit[:, :2].T)
        assert radii[0] > 0.1  # of the largest displacement, which is one
        np.testing.assert_allclose(radii, radii[0], rtol=0.05)
        turn = np.cross(orbit[0], orbit[1])[2] * np.sign(speed)
        assert (turn > 0.0) == (word == "forward")


def test_responses_tell_their_size_and_speed():
    """Masses of 2 kg on springs of 20 kN/m at the ends of a rod, U Ω²/(k − m Ω²) of one of them."""
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]
    rotor = er.SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    speeds = np.array([50.0, 80.0])
    # of springs that differ, along n2 the half: the larger semi-axis
    supports = [er.Support(name, np.diag([2e4, 8e4])) for name in ("left", "right")]
    shapes = er.response_shapes(rotor, speeds, er.Unbalance("left", 1e-4), supports=supports)
    sizes = 1e-4 * speeds**2 / (2e4 - 2.0 * speeds**2)
    assert shapes.labels == tuple(f"unbalance, largest {size:.3g} m" for size in sizes)


def test_animation_is_a_film_of_one_period(tmp_path):
    path = tmp_path / "mode.gif"
    modes().animate(path, 3)
    with Image.open(path) as film:
        assert film.n_frames == 25
        assert film.info["duration"] == 80
    assert list(tmp_path.iterdir()) == [path]


def run_up() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, motion and speed: unbalance of 3 µm, and a backward circle of 1 µm at 40 Hz."""
    time = np.arange(0.0, 4.0, 1e-3)
    speed = 2.0 * np.pi * (20.0 + 10.0 * time)
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time))])
    z = 3e-6 * np.exp(1j * angle) + 1e-6 * np.exp(-2j * np.pi * 40.0 * time)
    return time, np.column_stack([z.real, z.imag]), speed


def test_spectra_part_forward_from_backward():
    time, motion, speed = run_up()
    found = er.spectra(time, motion, speed, length=0.2, overlap=0.75)
    spacing = np.diff(found.frequencies)[0]
    ahead = np.where(found.frequencies > 0.0, found.amplitudes, 0.0)
    strongest = found.frequencies[np.argmax(ahead, axis=1)]
    np.testing.assert_allclose(strongest, found.speeds, atol=0.6 * spacing)
    behind = np.argmin(np.abs(found.frequencies + 2.0 * np.pi * 40.0))
    np.testing.assert_allclose(found.amplitudes[:, behind], 1e-6, rtol=0.02)
    np.testing.assert_allclose(found.speeds, np.interp(found.times, time, speed), rtol=1e-9)
    assert len(found.table().splitlines()) == len(found.times) + 1


@pytest.mark.parametrize(
    ("units", "per_speed", "per_rate"),
    [("Hz", 0.5 / np.pi, 0.5 / np.pi), ("rpm", 30.0 / np.pi, 0.5 / np.pi), ("SI", 1.0, 1.0)],
)
def test_spectra_in_engineering_units(units, per_speed, per_rate):
    """Motion that runs twice as fast as the spin of 100 and 200 rad/s is on the line of order 2."""
    found = er.Spectra([0.5, 1.5], [100.0, 200.0], [0.0, 200.0, 400.0], [[0, 1, 0], [0, 0, 1]])
    speeds, rates = per_speed * found.speeds, per_rate * 2.0 * found.speeds
    figure, cascade = pyplot.subplots()
    found.plot(cascade, orders=[2.0], units=units)
    np.testing.assert_allclose(cascade.lines[0].get_xydata(), np.column_stack([rates, speeds]))
    first = found.table(units=units).splitlines()[1].split()
    np.testing.assert_allclose([float(word) for word in first[1:3]], [speeds[0], rates[0]], 1e-4)
    pyplot.close(figure)


def test_amplitude_of_one_signal():
    """A harmonic on a line of the spectrum, and a constant that is taken out."""
    time = np.arange(0.0, 1.0, 1e-3)
    found = er.spectra(time, 5.0 + 2.0 * np.cos(2.0 * np.pi * 50.0 * time), 300.0, length=0.5)
    best = np.argmax(found.amplitudes[0])
    np.testing.assert_allclose(found.frequencies[best], 2.0 * np.pi * 50.0, rtol=1e-9)
    np.testing.assert_allclose(found.amplitudes[0, best], 2.0, rtol=1e-9)
    assert found.amplitudes[:, 0].max() < 1e-9


def test_cascade_is_drawn():
    found = er.spectra(*run_up(), length=0.4)
    ax = found.plot(orders=(1.0, -1.0))
    assert ax.get_xlim()[1] > 50.0
    assert len(ax.collections[0].get_paths()) == len(found.times)
    pyplot.close(ax.figure)


TIME = np.linspace(0.0, 1.0, 101)
POINT = er.SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), np.zeros((1, 3)), "z")
POINT = POINT.with_interface("left", [0]).reduce(0)


def responses(speed, target=POINT):
    heavy, spring = er.Unbalance("left", 1e-4), er.Support("left", 1e4)
    return er.response_shapes(target, speed, heavy, supports=spring)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: modes().animate("mode.mp4"), "path: needs the ending .gif, got 'mode.mp4'"),
        (lambda: replace(modes(), motion=0.0 * modes().motion).plot(1), "shape 1, .* no motion"),
        (lambda: responses([0.0, 1.0]), "speeds: needs spin speeds above zero"),
        (lambda: responses(1.0, POINT.without_shapes()), "target: its linear model has no mesh"),
        (lambda: responses(100.0), "response_shapes: there is no steady motion"),
        (
            lambda: er.spectra(TIME, TIME[:5], 1.0, length=0.5),
            r"motion: needs the shape \(101,\) or",
        ),
        (lambda: er.spectra(TIME, TIME, 1.0, length=5.0), "length: a window of 5 s has 500 steps"),
        (lambda: er.spectra(TIME**2, TIME, 1.0, length=5.0), "time: needs two instants or more"),
        (
            lambda: er.plot_orbit(np.zeros((3, 2)), [0.0, 1.0, 0.5]),
            "angle: needs a spin angle that",
        ),
        (lambda: draw_surface(np.zeros((3, 3)), [], TIME[:3], "x"), "triangles: there are none"),
    ],
)
def test_what_cannot_be_drawn_is_told(call, words):
    with pytest.raises((ValueError, RuntimeError), match=words):
        call()


def test_labels_that_would_overlap_are_moved_up():
    ax = pyplot.figure().add_subplot()
    labels = [ax.annotate("peak", (0.5, 0.5), (0, 4), textcoords="offset points") for _ in range(3)]
    keep_apart(labels)
    heights = [label.get_window_extent().y0 for label in labels]
    assert np.all(np.diff(heights) >= labels[0].get_window_extent().height)
    pyplot.close(ax.figure)
