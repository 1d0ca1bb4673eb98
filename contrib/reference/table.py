#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Table of reference values; prints it and writes table.json beside this file.

Every row is the optimal wave with length = friction = 1, a_1 = 1 and no other coefficient. It is solved until the
displacement settles (N points) and twice more with 1.5 N and 2.25 N points (405 at most), other stages and so other
steps; a value is printed with the digits on which the last two agree, at most 13, and table.json lists the value and
that difference.
"""
import json
import math
import pathlib

from crawler_reference import optimal_wave, reference

HERE = pathlib.Path(__file__).parent
QUANTITIES = ("displacement", "stress_power", "dissipation", "elastic_energy", "paper_energy", "min_stretch",
              "max_stretch")
# name, exponent a, chi, speed, end time, elastic modulus, displacement in doc/theory.md as printed there, rtol
ROWS = (("Fig. S1", -1, 0.05, 1, 1, 1, "1.2505153917e-3", 1e-11),
        ("Fig. S1", -1, 0.1, 1, 1, 1, "5.020242991e-3", 1e-11),
        ("Fig. S1", -1, -0.1, 1, 1, 1, "5.043148e-3", 1e-11),
        ("Fig. S1", -1, 0.2, 1, 1, 1, "2.04422750e-2", 1e-11),
        ("Fig. S1", -1, 0.3, 1, 1, 1, "4.764510e-2", 1e-11),
        ("Fig. S1", -1, 0.4, 1, 1, 1, "9.0072529800e-2", 1e-11),
        ("Fig. S1", -1, -0.4, 1, 1, 1, "9.086315e-2", 1e-11),
        ("Fig. S1", -1, 0.5, 1, 1, 1, "0.155940", 1e-11),
        ("Fig. 2", -1, 0.4, 1, 20, 1, "1.801968240", 1e-11),
        ("prograde", 1, 0.4, -1, 1, 1, "8.1377661410e-2", 1e-11),
        ("a = -3", -3, 0.3, 1, 1, 1, "0.111869247645", 1e-11),
        ("a = 2", 2, 0.3, 1, 1, 1, "-8.1070868247e-2", 1e-11),
        ("stiff", -1, 0.3, 1, 1, 10, "4.8552305987e-2", 1e-11),
        ("soft", -1, 0.3, 1, 1, 0.01, "4.6416054195e-2", 1e-11),
        ("linear", 0, 0.4, 1, 1, 1, "0", 1e-11),
        ("extreme", -10, 0.3, 1, 1, 1, "0.140941", 1e-8),
        ("extreme", 10, 0.2, -1, 1, 1, "0.094131", 1e-11),
        ("extreme", 3, 0.4, -1, 1, 1, "0.162484", 1e-11),
        ("extreme", -3, 0.8, 1, 1, 1, "0.36128", 1e-6),
        ("extreme", -1, 0.4, 1, 1, 0.001, "0.088976", 1e-11))


def digits(value, error):
    """The value with the significant digits that an error of this size leaves, at most 13."""
    if abs(value) < max(1e-13, error):
        return "0"
    return f"{value:.{min(13, max(1, math.floor(math.log10(abs(value) / max(error, 1e-300)))))}g}"


def solve_row(name, exponent, chi, speed, end_time, modulus, theory, rtol):
    """One row as a dict: parameters, values, errors."""
    stress = optimal_wave(chi, speed, elastic_modulus=modulus)
    first = reference(stress, exponent, end_time, modulus, rtol=rtol)
    last = reference(stress, exponent, end_time, modulus, points=min(405, first["points"] * 9 // 4), rtol=0.3 * rtol)
    errors = {q: last["errors"][q] for q in QUANTITIES}
    # the energies close exactly in the continuum: what is left over counts as an error of both
    gap = abs(last["stress_power"] - last["dissipation"] - last["elastic_energy"])
    errors.update({q: max(errors[q], gap) for q in ("stress_power", "dissipation", "paper_energy")})
    return dict(name=name, exponent=exponent, chi=chi, speed=speed, end_time=end_time, elastic_modulus=modulus,
                values={q: last[q] for q in QUANTITIES}, errors=errors, points=last["points"], steps=last["steps"],
                seconds=round(first["seconds"] + last["seconds"], 1), theory=theory)


def main():
    """Print the table row by row, then write the file."""
    print("case | a | chi | c | T | k | displacement | doc/theory.md | relative difference | stress power | dissipation"
          " | min stretch | max stretch | points | seconds")
    rows = []
    for row in ROWS:
        r = solve_row(*row)
        v, known = r["values"], float(r["theory"])
        text = {q: digits(v[q], r["errors"][q]) for q in QUANTITIES}
        relative = abs(v["displacement"] - known) / (abs(known) or 1)
        print(*row[:6], text["displacement"], r["theory"], f"{relative:.1e}", text["stress_power"], text["dissipation"],
              text["min_stretch"], text["max_stretch"], r["points"], r["seconds"], sep=" | ", flush=True)
        rows.append(dict(r, digits=text))
    made = ("Optimal wave, length = friction = a_1 = 1: Chebyshev collocation of the stretch, Radau IIA in time, by "
            "table.py; errors are the differences between runs with N and 1.5 N points and other stages.")
    (HERE / "table.json").write_text(json.dumps({"made": made, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
