# SPDX-License-Identifier: LGPL-2.1-or-later
"""The limbless crawler in Python: runs, batches and sweeps in this process, and the results of the program's folders.

    import crawler
    result = crawler.run("prm/paper/fig_s1.prm", set={"Body/Elastic modulus": 2})
    result.displacement, result.displacement_error.total, result.fields.stretch

doc/python.md is the reference. Units are those of the scene, as in the parameter file.
"""
import atexit
import difflib
import functools
import importlib
import json
import numbers
import os
import re
import sys
import tempfile
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np

from .arguments import checked, numbers_in
from .needs import FileError, InputError
from .pictures import paper, plot, report
from .results import Numbers, Result, Study, fields_of, parameters_of, read, table_of

__all__ = ["FileError", "Gradient", "InputError", "Numbers", "Result", "RunFailed", "Study", "batch", "check", "entries",
           "fit", "gradient", "measured", "optimize", "paper", "plot", "read", "report", "run", "sweep", "to_prm"]

Scene = Union[str, os.PathLike, Mapping[str, Any]]  # name of a parameter file, its text, or a dict with its sections
Values = Mapping[str, Any]                          # of entries by their full names
Table = Any                                         # pandas.DataFrame, or a dict of arrays without pandas
if TYPE_CHECKING:
    from .fitting import Fit
    from .measured import Samples


def __getattr__(name):
    """Loads the module measured at its first use, since it needs scipy."""
    if name == "measured":
        return importlib.import_module(".measured", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


class RunFailed(RuntimeError):
    """Exception: a run did not finish, and check=True was given. `result` describes its end."""

    def __init__(self, result):
        super().__init__(f"{result.reason}: {result.message}")
        self.result = result


@functools.cache
def _compiled():
    """Returns the compiled part, imported at its first use: it brings 200 libraries, whose functions are bound
    later."""
    flags = sys.getdlopenflags()
    sys.setdlopenflags(os.RTLD_LAZY)
    try:
        from . import _core
    except ImportError as error:
        raise InputError(f"the compiled part of the Python package cannot be loaded ({error}); contrib/setup.sh builds it for Debian's "
                         "Python") from None
    finally:
        sys.setdlopenflags(flags)
    atexit.register(_core.end)
    return _core


@functools.cache
def entries() -> dict[str, dict[str, str]]:
    """Entries of a parameter file by their full names, each a dict with default, expected, unit, documentation."""
    return {one.pop("entry"): one for one in json.loads(_compiled().entries())}


@checked
def check(scene: Scene, *, set: Values | None = None, **keywords) -> dict[str, str]:
    """Entries of a scene as used, by their full names; nothing is computed. Raises the same errors as run()."""
    effective, notes = _compiled().check(_source(scene, _overrides(set, keywords)))
    _warn(notes)
    return parameters_of(effective)


@checked
def run(scene: Scene, *, set: Values | None = None, fields: bool | Sequence[float] = True, places: Sequence[float] | None = None,
        output: str | os.PathLike | None = None, overwrite: bool = False, check: bool = False, verbose: bool = False, **keywords) -> Result:
    """Computes one scene, with the same bits as `crawler run`, and returns its Result.

    scene: the name of a parameter file, its text, or a dict with sections as in the file.
    set, keywords: other values of entries, {"Body/Elastic modulus": 2} or elastic_modulus=2 where that names one entry.
    fields: True, the fields over s and t and the statistics that the scene asks for (Output); False, none, which is
    fastest; or the times [time] of the fields, increasing.
    places: with times, the points of the fields [length], increasing, instead of 201 equidistant points.
    output: a folder for the files that `crawler run` writes; otherwise nothing is written.
    check: raises RunFailed if a run does not finish; otherwise see Result.status, reason and message.
    verbose: prints the messages of the program.
    Raises InputError and FileError with the message of the program.
    """
    overrides = _overrides(set, keywords)
    times = None
    if isinstance(fields, np.bool_):
        fields = bool(fields)
    if fields is False:
        overrides = ["Output/Number of snapshots=0", "Output/Statistics=false", *overrides]
    elif fields is not True:
        times = numbers_in(fields, "fields").tolist()
    if places is not None:
        if times is None:
            raise InputError('"places" is for "fields" with times, but those are missing')
        places = numbers_in(places, "places").tolist()
    source = _source(scene, overrides)
    if output is not None:
        if times is not None:
            raise InputError('"fields" has times, but with "output" True or False is expected')
        _command("run", source, output, overwrite, verbose)
        return _checked(read(output), check)
    answer = _compiled().run(source, times, places)
    result = _result(answer)
    if "times" in answer:
        result.fields = fields_of(answer["times"], result.parameters["Body/Length"], answer["fields"], places)
    if "statistics" in answer:
        result.statistics = table_of({re.sub(r" \[.*", "", name): column for name, column in
                                      zip(answer["statistics_names"], answer["statistics"].T)})
    if "local" in answer:
        result.local_sensitivities = Numbers(answer["local"])
    if verbose:
        print("\n".join(answer["lines"]))
    return _checked(result, check)


@checked
def batch(scenes: Iterable[Scene], *, set: Values | None = None, check: bool = False, **keywords) -> list[Result]:
    """Computes many scenes side by side in vector registers, without fields; returns the list of their Results.

    Displacements agree with those of run() within their error bounds, and do not depend on the neighbours. set and
    keywords hold for all scenes. Scenes that differ in some numbers only are faster in sweep().
    """
    if isinstance(scenes, (Mapping, str, os.PathLike)):
        raise InputError("this is one scene, but a list of scenes is expected; run() computes one")
    overrides = _overrides(set, keywords)
    answers = _compiled().batch([_source(scene, overrides, f"scenes[{i}]") for i, scene in enumerate(scenes)])
    return [_checked(_result(answer), check) for answer in answers]


@checked
def sweep(scene: Scene, axes: Mapping[str, Any] | None = None, *, design: str | None = None, set: Values | None = None,
          output: str | os.PathLike | None = None, overwrite: bool = False, verbose: bool = False, **keywords) -> Table:
    """Computes all points of a sweep; returns the table of `crawler sweep`, a pandas.DataFrame (a dict of arrays
    without pandas).

    axes: {"Body/Elastic modulus": [1, 2, 4], ...}, or the values in words, "linspace(1, 4, 10)"; None: Sweep/Axes of
    the scene. design: "grid", "zip", "random" or "latin hypercube". Points that fail are rows with status and
    reason. output: a folder for the files of `crawler sweep`.
    """
    overrides = _overrides(set, keywords)
    if axes is not None:
        _require_names(axes)
        overrides.append("Sweep/Axes=" + "; ".join(f"{_full_name(name)} : {_axis(values, name)}"
                                                   for name, values in axes.items()))
    if design is not None:
        overrides.append(f"Sweep/Design={design}")
    source = _source(scene, overrides)
    if output is None:
        table, notes = _compiled().sweep(source)
        _warn(notes)
        return table_of(table)
    _command("sweep", source, output, overwrite, verbose)
    return read(output).table


class Gradient(NamedTuple):
    """Number of a run and its derivatives by entries; lists in the order of the entries given."""
    value: float
    derivatives: np.ndarray  # [entry], in units of the number per unit of the entry
    errors: np.ndarray       # [entry], bounds of their errors
    result: Result


@checked
def gradient(scene: Scene, by: str | Sequence[str], *, of: str = "displacement", set: Values | None = None, **keywords) -> Gradient:
    """Returns a number of a run and its derivatives, as a Gradient: for user-defined objectives and fits.

    by: entries by their full names, or one. of: displacement, stress_power, dissipation,
    positive_power, paper_energy, gait.displacement, or gait.speed. The derivatives are those of Output/Sensitivities
    (doc/sensitivities.md): by the adjoint, whose cost hardly depends on the number of entries, or by differences of runs.
    Raises InputError as run() does, and where a derivative does not exist; RunFailed if the run does not finish.
    """
    by = [by] if isinstance(by, str) else list(by)
    if not by or not all(isinstance(entry, str) for entry in by):
        raise InputError("the entries are missing; a list of full names is expected, as [\"Body/Elastic modulus\"]")
    by, known = [_full_name(entry) for entry in by], _compiled().differentiated_numbers
    if of not in known:
        raise InputError(f'of is "{of}", but one of {", ".join(known)} is expected')
    result = run(scene, set={**(set or {}), "Output/Sensitivities": ", ".join(by)}, fields=False, check=True, **keywords)
    found = []
    for entry in by:
        one = (result.sensitivities or {}).get(entry) or {}
        one = one if of == "displacement" else one.get(of) or {}
        if one.get("value") is None:
            raise InputError(f'"{of}" has no derivative by "{entry}" here: {one.get("reason") or "it is not known"}')
        found.append((one["value"], np.nan if one.get("error") is None else one["error"]))
    derivatives, errors = np.array(found).T
    return Gradient(result[of], derivatives, errors, result)


@checked
def optimize(scene: Scene, variables: Mapping[str, tuple[float, float]] | None = None, *, set: Values | None = None,
             output: str | os.PathLike | None = None, overwrite: bool = False, verbose: bool = False, **keywords) -> Study:
    """Finds the best gait within limits, as `crawler optimize` does (doc/optimize.md), and returns a Study: best, the
    Results of the best gaits; optimize.optima, for each case the objective, the variables and, of each limit, its value
    and multiplier; starts and table.

    variables: {"Active stress/Segments/Phase lag": (0.05, 0.45), ...}, entries and their ranges; None: those of the scene
    (Optimize/Variables). objective="speed", starts=8, work=0.1, ... are entries of section Optimize. output: a folder for
    the files of `crawler optimize`. Raises InputError and FileError; a failed search has status and reason.
    """
    overrides = _overrides(set, keywords, "Optimize/")
    if variables is not None:
        overrides.append(f"Optimize/Variables={_ranges(variables)}")
    source = _source(scene, overrides)
    if output is not None:
        _command("optimize", source, output, overwrite, verbose)
        return read(output)
    with tempfile.TemporaryDirectory() as folder:
        _command("optimize", source, os.path.join(folder, "optimum"), False, verbose)
        return read(os.path.join(folder, "optimum"))


@checked
def fit(scene: Scene, data: Union[str, os.PathLike, "Samples", Sequence, None] = None, variables: Mapping[str, tuple[float, float]] | None = None, *,
        set: Values | None = None, workers: int = 1, verbose: bool = False, **keywords) -> "Fit":
    """Estimates numbers of a scene, with their uncertainty, from measured data, as `crawler fit` does (doc/fit.md);
    returns a Fit.

    data: the name of a file, or measured.Samples, e.g. from measured.read_samples(name, unit_of_t="1/30") for a file in
    other units; for several kinds a list, with standard_deviation=[0.01, 0.02] for each; None: that of the scene
    (Fit/Data). variables: {entry: (from, to), ...}; None: Fit/Variables. starts=8, standard_deviation=0.01, ... are
    entries of section Fit; with one start the minimum may be local. workers: number of processes that share the starts;
    the result does not depend on it.
    Fit.variables has, for each, value, deviation, intervals and numerical error; Fit.undetermined the combinations that
    the data do not determine. Raises InputError, FileError, and RuntimeError where the fit fails.
    """
    for option, _, _ in importlib.import_module(".measured.options", __name__).READING:
        if (name := option.replace("-", "_")) in keywords:
            raise InputError(f'"{name}" is for the reading of a file: data = measured.read_samples(NAME, {name}=...) is expected (the entry of a table: '
                             "set={...} with its full name)")
    overrides = _overrides(set, keywords, "Fit/")
    if variables is not None:
        overrides.append(f"Fit/Variables={_ranges(variables)}")
    fitting = importlib.import_module(".fitting", __name__)
    model, notes = fitting.prepared(scene, overrides, data)
    found = fitting.find(model, print if verbose else lambda text: None, workers=workers)
    _warn([*notes, *found.notes])
    return found


def _ranges(variables):
    """Entries and their ranges in words."""
    if not isinstance(variables, Mapping) or not all(isinstance(one, (list, tuple, np.ndarray)) and len(one) == 2 for one in variables.values()):
        raise InputError(f"the variables are {variables!r}, but a dict of entries and their ranges (from, to) is expected")
    return "; ".join(f"{_full_name(name)} : {_text(low, name)} to {_text(high, name)}" for name, (low, high) in variables.items())


@checked
def to_prm(scene: Mapping[str, Any]) -> str:
    """Writes a dict as the text of a parameter file."""
    nested = {}
    for name, value in _flat(scene):
        *sections, entry = name.split("/")
        place = nested
        for section in sections:
            place = place.setdefault(section, {})
            if not isinstance(place, dict):
                raise InputError(f'"{name}" is set, but "{section}" has a value and is no section')
        if entry in place:
            raise InputError(f'"{name}" is set twice, but is expected only once')
        place[entry] = value
    return "\n".join(_lines(nested, "")) + "\n"


def _require_names(settings):
    for name in settings:
        if not isinstance(name, str):
            raise InputError(f"the entry {name!r} is set, but its name is expected, as \"Body/Length\"")


def _flat(scene, before=""):
    _require_names(scene)
    for name, value in scene.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{before}{name}/")
        else:
            yield before + name, _text(value, before + name)


def _lines(nested, indent):
    for name, value in nested.items():
        if not isinstance(value, dict):
            yield f"{indent}set {name} = {value}"
    for name, value in nested.items():
        if isinstance(value, dict):
            yield f"{indent}subsection {name}"
            yield from _lines(value, indent + "  ")
            yield f"{indent}end"


def _text(value, name):
    """Text of a value in a parameter file."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    if isinstance(value, (str, os.PathLike)):
        text = " ".join(os.fspath(value).split("\n"))
        if "#" in text:
            raise InputError(f'"{name}" is "{text}", but "#" begins a comment in a parameter file')
        return text
    if isinstance(value, np.ndarray) and value.ndim == 0:
        return _text(value.item(), name)
    if isinstance(value, (list, tuple, range, np.ndarray)):
        if any(isinstance(one, (list, tuple, range)) or isinstance(one, np.ndarray) and one.ndim for one in value):
            raise InputError(f'"{name}" has a list in a list, but one list is expected')
        return ", ".join(_text(one, name) for one in value)
    raise InputError(f'"{name}" is {value!r}, but a number, a text, True, False or a list is expected')


def _axis(values, name):
    """Values of an axis in words; those that contain a comma, a colon or a semicolon are quoted."""
    if isinstance(values, (str, numbers.Number, Mapping)) or not hasattr(values, "__iter__"):
        return _text(values, name)
    texts = [_text(one, name) for one in values]
    for text in texts:
        if '"' in text:
            raise InputError(f"\"{name}\" is {text}, but a value of an axis has no double quotes")
    return ", ".join(f'"{text}"' if re.search("[,;:]", text) else text for text in texts)


def _full_name(name, section=""):
    """Entry with this full name, or the only one with this keyword, if there are several that in a section."""
    if "/" in name or name in entries() or name == "File":
        return name
    found = [entry for entry in entries() if _keyword(entry) == name]
    found = [entry for entry in found if section and entry.startswith(section)] or found
    if len(found) == 1:
        return found[0]
    if found:
        raise InputError(f'"{name}" may be any of ' + ", ".join(f'"{entry}"' for entry in found) +
                         "; the full name is expected, in set={...}")
    near = difflib.get_close_matches(name, map(_keyword, entries()), n=1, cutoff=0.)[0]
    raise InputError(f'there is no entry "{name}"; the nearest is "{near}"')


def _keyword(entry):
    return entry.split("/")[-1].lower().replace(" ", "_").replace("-", "_")


def _overrides(settings, keywords, section=""):
    pairs = [*_flat(settings or {}), *((_full_name(name, section), value) for name, value in keywords.items())]
    return [f"{name}={_text(value, name)}" for name, value in pairs]


def _source(scene, overrides, name="scene"):
    """Input of the compiled part; name: of a scene without a file, for messages."""
    if isinstance(scene, Mapping):
        text = to_prm(scene)
    elif isinstance(scene, str) and re.search(r"\n|^\s*(set|subsection|include)\s", scene):
        text = scene
    elif isinstance(scene, (str, os.PathLike)):
        name, text = os.fspath(scene), None
    else:
        raise InputError(f"the scene is {scene!r}, but the name of a parameter file, its text or a dict is expected")
    return _compiled().Source(name, text, overrides)


def _warn(notes):
    """Issues warnings at the line that called this package."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).split(".")[0] == __name__:
        level, frame = level + 1, frame.f_back
    for note in notes:
        warnings.warn(note.removeprefix("Note: "), stacklevel=level)


def _result(answer):
    _warn(answer["notes"])
    return Result(json.loads(answer["summary"]), answer["parameters"])


def _checked(result, check):
    if check and result.status != "finished":
        raise RunFailed(result)
    return result


def _command(name, source, output, overwrite, verbose):
    if not os.fspath(output):
        raise InputError('"output" is empty, but the name of a folder is expected')
    stopped = 5  # exit code
    code, notes = _compiled().command(name, source, os.fspath(output), overwrite, not verbose)
    _warn(notes)
    if code != stopped:
        return
    try:
        if read(output).reason != "signal":
            return
    except FileError:
        pass  # stopped before there were files
    raise KeyboardInterrupt
