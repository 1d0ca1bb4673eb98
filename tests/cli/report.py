#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler report: its pages have the numbers of the folders that they are made of, and work in a browser, with and
without a pointer, wide and narrow, light and dark; texts of users stay texts; other folders are refused in a sentence.

    python3 report.py PATH_TO_CRAWLER
"""
import json
import pathlib
import re
import shutil
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from browser import Browser  # noqa: E402
from program import NO_PICTURES, call, checks, expect, prm, refused, sets  # noqa: E402
from tables import csv_rows, json_of, number_at  # noqa: E402

NASTY = "</script><script>window.broken = 1</script><img src=x onerror='window.broken = 1'>"
CHI, P = "Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent"
WAVE = f"# {NASTY}\n" + prm("Accuracy=1e-3", "Body/Length=1.00", "Active stress/Optimal wave/Choose wave by=wave speed")
FORMULAS = prm("Accuracy=1e-3", "Active stress/Generator=expression")
STRAIN = prm("Model=kinematic", "Accuracy=1e-4", "Active stress/Generator=prescribed strain",
             "Active stress/Prescribed strain/Given by=modes", "Active stress/Modes/Harmonics=1",
             "Active stress/Modes/Coefficients=0, 0.2, 0", "Optimize/Objective=merit",
             "Optimize/Variables=Active stress/Modes/Coefficients[*] : -1 to 1", "Optimize/Smallest strain=-0.3",
             "Optimize/Largest strain=0.3")
FOLDERS = ("run", "sweep", "checked", "tradeoff", "optimisation", "fit", "comparison")
PYTHON = pathlib.Path(__file__).resolve().parents[2] / "contrib/python"
STUDIES = pathlib.Path(__file__).resolve().parents[2] / "prm/studies"


class Program:
    """Calls crawler in a folder."""

    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def __call__(self, *arguments):
        return call([self.path, *arguments], self.folder, variables={} if arguments[0] in ("report", "fit") else NO_PICTURES)

    def study(self, command, scene, output, **entries):
        """Writes a parameter file and runs it; entries with _ for blanks and __ for slashes."""
        (self.folder / f"{command}.prm").write_text(scene, encoding="utf-8")
        named = {entry.replace("__", "/").replace("_", " "): value for entry, value in entries.items()}
        result = self(command, f"{command}.prm", "--quiet", "--output", output, *sets(named))
        expect(result.returncode in (0, 4), f"{output} is made ({result.returncode}) {result.stderr.strip()}")


def make_studies(program):
    """One folder of each kind, and some special ones."""
    program.study("run", WAVE, "run", Output__Sensitivities="all", Ground__Profile="1 + 0.5*sin(6*x)")
    axes = f"{P} : 0, 2, 3; {CHI} : 0.1, 0.3, 0.6, 0.65"
    program.study("sweep", WAVE, "sweep", Sweep__Axes=axes, Sweep__Keep_fields="5")
    program.study("sweep", WAVE, "checked", Sweep__Axes=f"{CHI} : 0.1, 0.6; {P} : 0, 2", **{"Sweep__Cross-check": "true"})
    program.study("tradeoff", WAVE, "tradeoff", Tradeoff__Models="perturbation, nonlinear", Tradeoff__Formulations="position",
                  Tradeoff__Meshes="uniform", Tradeoff__Engines="fused, batch", Tradeoff__Integrators="radau 5",
                  Tradeoff__Degrees="4", Tradeoff__Tolerances="1e-2, 1e-5", Tradeoff__Repetitions="1")
    program.study("optimize", STRAIN, "optimisation")
    shutil.copy(STUDIES / "fit_worm.csv", program.folder)
    program.study("fit", (STUDIES / "fit_worm.prm").read_text(encoding="utf-8"), "fit", Fit__Starts="2",
                  Fit__Variables=f"{P} : 0.5 to 5; Body/Friction coefficient : 0.5 to 2")
    shutil.copy(program.folder / "fit.prm", program.folder / "same.prm")
    result = program("fit", "fit.prm", "same.prm", "--quiet", "--output", "comparison", "--set", f"Fit/Variables={P} : 0.5 to 5")
    expect(result.returncode == 0, f"a comparison is made {result.stderr}")
    program.study("run", WAVE.replace("wave speed", "wave speed # <b>"), "<b>inverted", Body__Anchoring_exponent="0",
                  **{CHI.replace("/", "__").replace(" ", "_"): "0.6"})
    program.study("run", FORMULAS, "sudden", Active_stress__Expression__Active_stress="0.2*sin(2*pi*(s+t))",
                  Units__Length="mm", Units__Time="s")
    program.study("sweep", FORMULAS, "formulas",
                  Sweep__Axes='Active stress/Expression/Active stress : "0.1*sin(2*pi*(s+t))*(s<2)", "0.2*sin(2*pi*(s+t))*(s<2)"')


def page_data(folder):
    """What the page knows."""
    text = (folder / "report.html").read_text(encoding="utf-8")
    expect(len(re.findall("</script", text)) == 3 and "Chart.js v" in text and NASTY not in text, f"no text ends a script of {folder.name}")
    expect(not re.search(r"(src|href)=[\"']?(https?:)?//|@import|url\(", text), f"{folder.name} needs no network")
    return json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL)[1])


def column(data, name):
    """The values of a column of the table."""
    found = next(one for one in data["table"]["columns"] if one["name"] == name)
    return [found["values"][code] for code in found["codes"]] if "codes" in found else found["values"]


def test_content(program):
    """The data of the pages are those of the files."""
    for name in (*FOLDERS, "<b>inverted", "formulas"):
        result = program("report", name)
        expect(result.returncode == 0 and f"{name}/report.html" in result.stdout, f"{name} has a report {result.stderr.strip()}")
    folder = program.folder
    data = {name: page_data(folder / name) for name in (*FOLDERS, "<b>inverted", "formulas")}
    for name in FOLDERS:
        summary = json_of(folder / name / "summary.json")
        expect(data[name]["kind"] == name.replace("checked", "sweep") and {**data[name]["summary"], **summary} == data[name]["summary"], f"the summary of the {name}")
    expect(data["tradeoff"]["summary"]["recommendations"] and data["tradeoff"]["summary"]["pareto"], "advice where the study could not call Python")
    expect(data["run"]["runs"][0]["summary"] == data["run"]["summary"] and NASTY in data["run"]["parameters"]["original"],
           "the run and its parameter file, word for word")
    ground = data["run"]["runs"][0]["ground"]
    expect(np.allclose(ground["factor"], 1 + 0.5 * np.sin(6 * np.array(ground["x"])), atol=1e-4), "the ground of the run")
    entries = {one["entry"]: one for one in data["run"]["parameters"]["entries"]}
    expect(entries["Accuracy"]["value"] == "1e-3" and P not in entries and "Body/Length" not in entries and entries["Ground/Profile"]["default"] == "1",
           "entries that differ from their defaults, as numbers or as words")
    data["fit"]["table"], = data["fit"]["tables"]
    for name, file, columns in (("sweep", "results.csv", (P, CHI, "displacement", "errors.stress_power", "status", "reason")),
                                ("checked", "results.csv", (CHI, P, "outcome", "displacement")),
                                ("tradeoff", "tradeoff.csv", ("error", "seconds", "entries")),
                                ("optimisation", "results.csv", ("evaluation", "objective", "violation")),
                                ("fit", "residuals.csv", ("t", "place", "data", "model", "residual"))):
        rows = csv_rows(folder / name / file)
        good = all(value == (None if row[key] == "" else float(row[key]) if isinstance(value, (int, float)) else row[key])
                   for key in columns for value, row in zip(column(data[name], key), rows))
        expect(good and data[name]["table"]["all_rows"] == len(rows), f"the table of the {name}")
    expect([one["title"] for one in data["sweep"]["runs"]] == ["points/5"]
           and [one["title"] for one in data["optimisation"]["runs"]] == ["best"], "runs within studies")


def test_sudden_start(program):
    """The instant of large forces at a sudden start leaves the rest of the run to be seen; units have the user's names."""
    result = program("report", "sudden")
    data = page_data(program.folder / "sudden")
    kymograph = data["runs"][0]["kymograph"]
    times, n = np.array(kymograph["times"]), len(kymograph["places"])
    for name in ("friction_force", "velocity"):
        field = kymograph["fields"][name]
        values = field["step"] * np.reshape(field["values"], (-1, n))
        shown = max(map(abs, field["shown"]))
        longer = np.diff(times)[:, None] * (np.abs(values[1:]) > shown)
        expect(np.abs(values).max() > 3 * shown > 0 and longer.sum() / n < 0.03 * times[-1]
               and np.median(np.abs(values)) > 0.05 * shown, f"{name} of a sudden start: shown to {shown} of {np.abs(values).max()}")
    expect(data["units"] == {"length": "mm", "time": "s", "force": "force", "energy": "force mm"}, f"units {data['units']}")
    header = (program.folder / "sudden/statistics.csv").read_text(encoding="utf-8").splitlines()[0]
    expect(result.returncode == 0 and "time [s],step size [s],displacement [mm]" in header and "[force mm]" in header
           and re.search(r"displacement .* [+]- \S+ mm ", (program.folder / "sudden/log.txt").read_text(encoding="utf-8")), f"units of the user: {header}")


def test_refused(program):
    """One sentence and the right code for everything else."""
    folder = program.folder
    (folder / "empty").mkdir()
    shutil.copytree(folder / "run", folder / "no_json")
    (folder / "no_json/summary.json").write_text("{", encoding="utf-8")
    shutil.copytree(folder / "run", folder / "no_picture")
    vts = (folder / "run/kymograph.vts").read_text(encoding="utf-8")
    (folder / "no_picture/kymograph.vts").write_text(vts[:len(vts) // 2], encoding="utf-8")
    shutil.copytree(folder / "sweep", folder / "no_table")
    (folder / "no_table/results.h5").write_bytes((folder / "sweep/results.h5").read_bytes()[:3000])
    shutil.copytree(folder / "run", folder / "full")
    (folder / "full/report.html").unlink()
    (folder / "full/report.html/x").mkdir(parents=True)
    for name, code, words in (("nothing", 2, "does not exist"), ("run.prm", 2, "is a file"), ("empty", 2, "has no results"),
                              ("no_json", 6, "summary.json\" is damaged"), ("no_picture", 6, "kymograph.vts\" is damaged"),
                              ("no_table", 6, "results.h5\""), ("full", 6, "cannot write \"full/report.html\"")):
        result = program("report", name)
        refused(result, words, code=code)
        expect(not result.stdout, f"{name}: {result.stdout}")
    for arguments, words in (((), "the folder is missing"), (("run", "sweep"), "one folder is expected"),
                             (("run", "--set", "Accuracy=1"), "unknown option \"--set\""), (("run", "--", "-ts_view"), "takes no PETSc")):
        refused(program("report", *arguments), words)


def test_library(program):
    """Chart.js cannot end its script, and if it is missing a sentence names its package."""
    def report(library):
        words = ["from crawler import needs", f"needs.CHART_LIBRARIES = [pathlib.Path({str(library)!r})]",
                 "from crawler.report.command import main", "needs.run_script(main)"]
        return call([sys.executable, "-c", "; ".join(["import pathlib, sys", f"sys.path.insert(0, {str(PYTHON)!r})", *words]), "report", "run"],
                    program.folder, variables={"CRAWLER_PROGRAM": program.path})
    own = program.folder / "own.js"
    refused(report(own), "apt install libjs-chart.js", code=69)
    own.write_text("window.Chart = '</script><b>';", encoding="utf-8")
    report(own)
    expect("'<\\/script><b>'" in (program.folder / "run/report.html").read_text(encoding="utf-8"), "the library cannot end its script")
    program("report", "run")


def test_unfinished(program):
    """A run and a sweep that were killed: what is there is shown."""
    shutil.copytree(program.folder / "run", program.folder / "killed run")
    shutil.copytree(program.folder / "sweep", program.folder / "killed sweep")
    for name in ("killed run", "killed sweep"):
        (program.folder / name / "summary.json").unlink()
        result = program("report", name, "--quiet")
        expect(result.returncode == 0 and not result.stdout and page_data(program.folder / name)["summary"] is None, f"{name} has a report")


def test_large(program, browser):
    """A table of 1e5 points: below 10 MB, with what matters most, and a pointer that paints next to nothing."""
    folder, n = program.folder / "large", 100000
    folder.mkdir()
    shutil.copy(program.folder / "sweep/parameters.prm", folder)
    random = np.random.default_rng(1)
    with h5py.File(program.folder / "sweep/results.h5") as source, h5py.File(folder / "results.h5", "w") as file:
        group = file.create_group("results", track_order=True)
        for name, data in source["results"].items():
            values = data[:][np.arange(n) % len(data)]
            if name == "index":
                values = np.arange(n, dtype=float)
            elif values.dtype.kind == "f":
                values = values * (1 + 0.1 * random.random(n))
            copy = group.create_dataset(name, data=values)
            for key, value in data.attrs.items():
                copy.attrs[key] = value
    result = program("report", "large")
    data = page_data(folder)
    names = {one["name"] for one in data["table"]["columns"]}
    expect(result.returncode == 0 and (folder / "report.html").stat().st_size < 1e7 and data["table"]["rows"] == n
           and {P, CHI, "status", "reason", "displacement", "displacement_error.total"} <= names and data["table"]["left_out"],
           f"1e5 points: {(folder / 'report.html').stat().st_size} bytes, {len(names)} columns")
    browser.open(folder / "report.html")
    drawing, pointing, tip = browser.ask(PAINTING)
    expect(drawing > 1000 > pointing and "Point" in tip and browser.ask(BLANK) == 0,
           f"{drawing} calls draw the points, {pointing} show one of them: {tip!r}")


# The charts of a page, and the words of a chart's tip.
HELPERS = """Object.defineProperty(window, 'CHARTS', {get: () => Object.values(Chart.instances)});
window.TIP = ({tooltip}) => tooltip.opacity ? [...tooltip.title, ...tooltip.body.flatMap(one => one.lines)].join('\\n') : ''"""
# How often something is painted for all points, and for one that is pointed at.
PAINTING = """(() => { const chart = CHARTS.find(one => one.own.keys), kind = CanvasRenderingContext2D.prototype, own = {}; let calls = 0;
  for (const name of Object.getOwnPropertyNames(kind)) {
    const one = Object.getOwnPropertyDescriptor(kind, name);
    if (typeof one.value !== 'function') continue;
    own[name] = one;
    kind[name] = function (...values) { ++calls; return one.value.apply(this, values); };
  }
  chart.redraw();
  const drawing = calls;
  chart.say(chart.own.find(chart.x(0.32), chart.y(2.1), chart));
  const tip = TIP(chart), pointing = calls - drawing;
  for (const name in own) Object.defineProperty(kind, name, own[name]);
  return [drawing, pointing, tip]; })()"""
ALL_KNOWN_NUMBERS = """[...document.querySelectorAll('[data-key] data')].map(one => [one.closest('[data-key]').dataset.key, Number(one.value)])"""
# How many charts look (nearly) the same without lines and what is painted.
BLANK = """CHARTS.filter(one => one.width > 60).filter(one => {
  const {own, ctx, canvas} = one, image = () => { one.redraw(); return new Uint32Array(ctx.getImageData(0, 0, canvas.width, canvas.height).data.buffer); };
  const painted = image();
  one.own = {...own, paint: null, overlay: null, lines: () => (own.lines?.() ?? []).map(line => ({...line, data: []}))};
  const blank = image();
  one.own = own;
  one.redraw();
  return painted.filter((colour, i) => colour !== blank[i]).length < 50; }).length"""
# How many axes have numbers that reach into the title beside them or into each other.
CRAMPED = """CHARTS.filter(one => one.width > 60).flatMap(one => Object.values(one.scales)).filter(scale => {
  if (!scale.options.display) return false;
  const {ctx} = scale.chart;
  ctx.font = `12px ${Chart.defaults.font.family}`;
  const shown = scale.ticks.map((tick, i) => [scale.getPixelForTick(i), scale.axis === 'x' ? ctx.measureText(tick.label).width : 12]).sort((a, b) => a[0] - b[0]);
  const widest = Math.max(...scale.ticks.map(tick => ctx.measureText(tick.label).width));
  return !shown.length || shown.some(([at, size], i) => i > 0 && at - size / 2 < shown[i - 1][0] + shown[i - 1][1] / 2)
    || scale.axis === 'y' && scale.width < widest + (scale.options.title.display ? 20 : 4); }).length"""
BRIGHTNESS = """(() => { const c = getComputedStyle(document.documentElement).backgroundColor.match(/\\d+/g).map(Number);
  return (c[0] + c[1] + c[2]) / 3; })()"""


def test_in_browser(browser, folder):
    """Each page in all four ways."""
    for name in (*FOLDERS, "<b>inverted", "sudden", "formulas", "killed run", "killed sweep"):
        for width, dark in ((1280, False), (1280, True), (360, False), (360, True)):
            browser.complaints.clear()
            browser.requests.clear()
            browser.open(folder / name / "report.html", width, 900, dark)
            way = f"{name}, {width} pixels, {'dark' if dark else 'light'}"
            expect(not browser.complaints, f"{way}: no complaints {browser.complaints}")
            expect(browser.ask("document.documentElement.scrollWidth") <= width, f"{way}: nothing is cut off")
            expect(browser.ask(BLANK) == 0 and browser.ask("CHARTS.length") > 0, f"{way}: no blank picture")
            expect((browser.ask(BRIGHTNESS) < 60) == dark, f"{way}: colours")
            expect(browser.ask("[...document.querySelectorAll('.stacks')].every(one => one.scrollWidth <= one.parentElement.clientWidth)"), f"{way}: tables of fits are whole")
            expect(browser.ask(CRAMPED) == 0, f"{way}: titles of axes have room")
        expect(browser.ask("window.broken") is None and browser.ask("document.querySelectorAll('img, h1 b').length") == 0,
               f"{name}: texts stay texts")
        expect(all(url.startswith("file:") for url in browser.requests), f"{name}: nothing is loaded")
        expect(browser.ask("document.querySelector('h1').textContent") == name, f"{name} is the title")
        if name == "tradeoff":
            expect(browser.ask("(({x, y}) => x.type === 'logarithmic' && y.type === 'logarithmic')(CHARTS.find(one => one.own.label === 'map of all points').scales)"), "times and errors are logarithmic")


def test_run_in_browser(browser, folder):
    """Numbers, and time by keys and by the pointer."""
    browser.open(folder / "run/report.html")
    summary = json_of(folder / "run/summary.json")
    shown = browser.ask(ALL_KNOWN_NUMBERS)
    expect(len(shown) > 40 and all(number_at(summary, key) == value for key, value in shown), f"{len(shown)} numbers are those of summary.json")
    text = browser.ask("document.body.innerText")
    expect("retrograde" in text and "What matters" in text and f"crawler {summary['versions']['crawler']}" in text, "gait in words, sensitivities, version")
    time = "document.querySelector('output').textContent"
    before = browser.ask(time)
    browser.ask("document.querySelector('input[type=range]').focus()")
    browser.key("ArrowRight")
    later = browser.ask(time)
    expect(later != before, f"a key moves the time from {before} to {later}")
    browser.ask("document.querySelector('button.play').focus()")
    browser.key(" ")
    browser.wait_for(f"{time} !== {json.dumps(later)}")
    expect(browser.ask("document.querySelector('button.play').textContent") == "Pause", "the body moves")
    browser.key(" ")
    expect(browser.ask("document.querySelector('button.play').textContent") == "Play", "and stops")
    x, y, width, height = browser.ask("(() => { const r = CHARTS.find(one => one.own.label === 'kymograph').canvas.getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; })()")
    browser.ask(f"window.scrollTo(0, {y})")
    browser.mouse(x + width / 2, height / 4, click=True)
    expect("stretch" in browser.ask("TIP(CHARTS.find(one => one.own.label === 'kymograph'))"), "the kymograph has numbers")
    browser.open(folder / "<b>inverted/report.html")
    text = browser.ask("document.body.innerText")
    expect("inverted_inside" in text and "What to do: a property of the model" in text, "a failure comes with advice")


def test_fit_in_browser(browser, folder):
    """Values, profiles, correlation, starts; data with the run through them, and the map of residuals."""
    browser.open(folder / "fit/report.html")
    summary = json_of(folder / "fit/summary.json")
    shown = browser.ask("[...document.querySelectorAll('td data')].map(one => Number(one.value))")
    for one in summary["variables"].values():
        expect({one["value"], *one["interval_95"]} <= set(shown), f"{one} is shown")
    expect(summary["correlation"][0][1] in shown and all(one["residuals"] in shown for one in summary["starts"]), "correlation and starts")
    captions = browser.ask("[...document.querySelectorAll('figcaption')].map(one => one.textContent)")
    expect(any("540 measured numbers, dots" in text for text in captions) and any("a map" in text for text in captions), f"data and residuals: {captions}")
    browser.open(folder / "comparison/report.html")
    shown = browser.ask("[...document.querySelectorAll('td data')].map(one => Number(one.value))")
    for row in json_of(folder / "comparison/summary.json")["comparison"]:
        fit = json_of(folder / "comparison" / row["folder"] / "summary.json")
        expect({row["aic"], row["bic_less_least"], fit["variables"][P]["value"]} <= set(shown), f"{row} is shown")
    expect(browser.ask(BLANK) == 0 and not browser.complaints, f"bars of the criteria {browser.complaints}")


def test_map_in_browser(browser, folder):
    """Points by pointer and keys: stored ones with their kymograph, others with their command."""
    browser.open(folder / "sweep/report.html", 1200, 1000)
    rows = csv_rows(folder / "sweep/results.csv")
    chart = "CHARTS.find(one => one.own.keys)"
    x, y = browser.ask(f"(() => {{ const c = {chart}, r = c.canvas.getBoundingClientRect(); return [r.x + c.x(0.3), r.y + c.y(2)]; }})()")
    browser.mouse(x, y)
    tip = browser.ask(f"TIP({chart})")
    expect("Point 5" in tip and f"displacement: {float(rows[5]['displacement']):.3f}"[:18] in tip, f"the tip of a point: {tip!r}")
    browser.mouse(x, y, click=True)
    panel = "document.querySelector('.details')"
    expect("Kymograph" in browser.ask(f"{panel}.innerText") and browser.ask(BLANK) == 0, "a stored point shows its body")
    shown = browser.ask(ALL_KNOWN_NUMBERS)
    stored = json_of(folder / "sweep/points/5/summary.json")
    expect(shown and all(number_at(stored, key) == value for key, value in shown), "its numbers are those of its summary.json")
    browser.ask(f"{chart}.canvas.focus()")
    browser.key("ArrowRight")
    text = browser.ask(f"{panel}.innerText")
    expect("Point 6" in text and f"--set '{P}=2'" in text and f"--set '{CHI}=0.6'" in text and "--output points/6" in text,
           "a key goes to the next point, which says how to compute it")
    numbers = dict(browser.ask(ALL_KNOWN_NUMBERS))
    expect(numbers["displacement"] == float(rows[6]["displacement"]), "and has its numbers")
    browser.key("ArrowDown")
    expect("Point 2" in browser.ask(f"{panel}.innerText") and "inverted" in browser.ask(f"{panel}.innerText"), "a point that inverted says so")
    browser.ask("(() => { const up = document.querySelectorAll('select')[1]; up.value = 'displacement'; up.dispatchEvent(new Event('change')); })()")
    browser.ask(f"(() => {{ const colour = document.querySelectorAll('select')[2]; colour.value = '{P}'; colour.dispatchEvent(new Event('change')); }})()")
    expect("lines" in browser.ask("document.querySelector('figcaption').textContent"), "other columns make lines")
    expect(not browser.complaints, f"no complaints {browser.complaints}")


def test_point_command(program, browser):
    """The command that the page gives for a point does what it says."""
    folder = program.folder / "sweep"
    browser.open(folder / "report.html", 1200, 1000)
    command = browser.ask("pointCommand({axes: ['%s', '%s'], index: new Column(page.table.columns.find(one => one.name === 'index')),"
                          " columns: columnsOf(page.table.columns)}, 1)" % (P, CHI))
    result = call(["bash", "-c", command.replace("crawler run", f"'{program.path}' run")], program.folder)
    expect(result.returncode == 0 and (folder / "points/1/summary.json").is_file(), f"{command} {result.stderr}")
    program("report", "sweep")
    expect([one["title"] for one in page_data(folder)["runs"]] == ["points/1", "points/5"], "the next report has this point")


def main(folder):
    program = Program(str(pathlib.Path(sys.argv[1]).resolve()), folder)
    make_studies(program)
    test_content(program)
    test_sudden_start(program)
    test_refused(program)
    test_library(program)
    test_unfinished(program)
    with Browser() as browser:
        browser.call("Page.addScriptToEvaluateOnNewDocument", source=HELPERS)
        test_in_browser(browser, program.folder)
        test_run_in_browser(browser, program.folder)
        test_fit_in_browser(browser, program.folder)
        test_map_in_browser(browser, program.folder)
        test_point_command(program, browser)
        test_large(program, browser)


checks.run((main,))
