"""Evaluation by standards: amplification, margins, placement of unbalance, stability level I."""

from validation.mutations.mutation import mutations

EVALUATION = [
    *mutations(
        "evaluation/separation.py",
        "test_evaluation.py",
        (
            "half power taken for half the size",
            "if curve[end] < HALF_POWER * size:",
            "if curve[end] < 0.5 * size:",
        ),
        (
            "margin above without its 10 %",
            "np.minimum(0.10 + margin, beyond)",
            "np.minimum(margin, beyond)",
        ),
        (
            "speeds below the operating range are not asked for",
            "limits * (1.0 + _LARGEST",
            "limits * (1.0 - _LARGEST",
        ),
        (
            "margin below as a share of the critical speed",
            "1.0 - peaks / low",
            "low / peaks - 1.0",
        ),
        (
            "margin above as a share of the critical speed",
            "peaks / high - 1.0",
            "1.0 - high / peaks",
        ),
        ("one side of a peak taken for both", "peak / (2.0 * known.mean())", "peak / known.sum()"),
        ("half power beyond a valley", "if curve[end] > curve[end - 1]:", "if False:"),
    ),
    *mutations(
        "evaluation/placement.py",
        "test_evaluation.py",
        ("opposite unbalances side by side", "angle + np.pi * number", "angle"),
        ("unbalance falls with the speed for ever", "min(speed, _FASTEST)", "speed"),
        ("levers exchanged", "np.array([1.0 - share, share])", "np.array([share, 1.0 - share])"),
    ),
    *mutations(
        "evaluation/coupled_modes.py",
        "test_evaluation.py",
        (
            "cross-coupling feeds backward whirl",
            "[[0.0, multiple * q], [-multiple * q, 0.0]]",
            "[[0.0, -multiple * q], [multiple * q, 0.0]]",
        ),
        (
            "modes followed by their shapes alone",
            "linear_sum_assignment(unlike + away)",
            "linear_sum_assignment(unlike)",
        ),
        (
            "mode that is made more stable",
            "end.decrements < start.decrements - ROUNDING",
            "end.decrements > start.decrements",
        ),
    ),
    *mutations(
        "evaluation/level_one.py",
        "test_evaluation.py",
        ("other modes not looked at", "if modes.decrements[lowest] < -ROUNDING:", "if False:"),
        ("axial stages as impellers", '"axial": 1.5', '"axial": 3.0'),
        (
            "slope of the limit between the regions",
            "2.69 - 0.0115 * density",
            "2.69 - 0.0105 * density",
        ),
    ),
]
