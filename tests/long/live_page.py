#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The live page (doc/live_page.md): what it computes under node is what the program computes, to 1e-9; in a browser it
follows its sliders, complains of nothing and needs no network; what it cannot compute it refuses in a sentence.

    python3 live_page.py PATH_TO_CRAWLER BUILD_FOLDER_OF_THE_PAGE

Exit status 77 if emscripten or node is not installed.
"""
import json
import pathlib
import re
import shutil
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "contrib/python/crawler/plot")]
from browser import Browser  # noqa: E402
from plotting import Kymograph  # noqa: E402
from program import call, checks, expect  # noqa: E402
from tables import json_of  # noqa: E402

# Runs the parameter files of a list; of each the answer and the fields that the page shows.
NODE = """
const [core, files] = process.argv.slice(1);
require(core)().then(module => {
  const call = (name, ...text) => module.ccall(name, 'string', text.map(() => 'string'), text);
  const n = JSON.parse(call('crawler_entries')).n_points;
  console.log(JSON.stringify(JSON.parse(files).map(text => {
    const run = JSON.parse(call('crawler_run', text));
    run.fields = Object.fromEntries(['stretch', 'displacement', 'velocity', 'active_stress', 'friction_force'].map(name => {
      const from = module.ccall('crawler_field', 'number', ['string'], [name]) / 8;
      return [name, from ? Array.from(module.HEAPF64.subarray(from, from + n * run.times.length)) : []];
    }));
    return run;
  })));
});
"""
VALUES = {"p": 2, "strain": 0.3, "stiffness": 1, "speed": 1, "waves": 1, "segments": 8, "strides": 3}
SCENES = {"Fig. S1": ("optimal", {}), "a = 2": ("optimal", {"p": -1}), "a = -3": ("optimal", {"p": 4}),
          "a = 0": ("optimal", {"p": 1}), "travelling": ("wave", {"stiffness": 0.2, "waves": 2.5}),
          "segments": ("segments", {}), "given strain": ("strain", {"strain": 0.4}),
          **{name: (name, {}) for name in ("earthworm", "robot", "snail")}}  # the larva: within its bound only, see test_presets()
SLIDERS = ("p", "strain", "stiffness", "speed", "waves", "strides")
# What the page refuses, and a part of the sentence.
REFUSED = {"subsection Ground\n  set Profile = 1 + 0.5*sin(6*x)\nend\n": "muParser",
           "subsection Discretization\n  set Mesh = adaptive\nend\n": "PETSc",
           "subsection Body\n  set Elastic modulus = -1\nend\n": "a positive number is expected",
           "set Acuracy = 1e-3\n": "Accuracy"}


def numbers(json_object, before=""):
    """The numbers of a summary under keys with dots, but for what is of the process."""
    for key, value in json_object.items():
        name = f"{before}{key}"
        if isinstance(value, dict):
            yield from numbers(value, name + ".")
        elif isinstance(value, (int, float)) and not isinstance(value, bool) and not name.startswith("seconds"):
            yield name, value


def is_near(key, ours, theirs):
    """Bounds and residuals are small differences of numbers of the size 1; all else agrees relative to itself."""
    scale = 1. if key.startswith(("errors.", "displacement_error.")) or key == "ledger_residual" else max(abs(theirs), 1e-3)
    return abs(ours - theirs) <= 1e-9 * scale


def answers_of(core, texts):
    """What the page computes, by node."""
    return json.loads(call(["node", "-e", NODE, core, json.dumps(texts)]).stdout)


def test_numbers(program, core, texts):
    """Answers and fields of the page and of the program."""
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, ours) in enumerate(zip(texts, answers_of(core, [*texts.values()]))):
            path = pathlib.Path(folder, str(number))
            result = call([program, "run", "-", "--quiet", "--output", path], input=texts[name])
            if expect(result.returncode == 0 and "problem" not in ours,
                      f"{name} is computed by both {result.stderr.strip()} {ours.get('problem', '')}"):
                theirs = dict(numbers(json_of(path / "summary.json")))
                own = dict(numbers(ours["summary"]))
                common = {*own} & {*theirs}
                wrong = [key for key in common if not is_near(key, own[key], theirs[key])]
                expect(len(common) > 25 and {"displacement", "displacement_error.total", "steps"} <= common and not wrong,
                       f"{name}: {len(common)} numbers {[(key, own[key], theirs[key]) for key in wrong]}")
                compare_fields(name, ours, Kymograph(path, *ours["fields"]))


def compare_fields(name, ours, theirs):
    """The fields at all points and times."""
    for field, values in ours["fields"].items():
        expected = theirs[field]
        difference = np.abs(np.reshape(values, expected.shape) - expected).max()
        expect(difference <= 1e-9 * max(1., np.abs(expected).max()), f"{name}: {field} at {expected.size} points ({difference:.1e})")


def test_refusals(core):
    """What cannot be computed."""
    for (text, words), answer in zip(REFUSED.items(), answers_of(core, [*REFUSED])):
        problem = answer.get("problem", "it is computed")
        expect(words in problem and not any(answer["fields"].values()), f"refused: {problem}")


def page_of(browser, path, **look):
    """Opens the page; it has computed when this returns."""
    browser.open(path, **look)
    browser.ask("new Promise(done => { const wait = () => window.live ? done() : setTimeout(wait, 20); wait(); })")
    browser.settle()


def move(browser, key, steps):
    browser.ask(f"""(() => {{ const slider = document.getElementById({json.dumps(key)});
      slider.value = Number(slider.value) + {steps} * Number(slider.step); slider.dispatchEvent(new Event('input')); }})()""")
    browser.settle()


def choose(browser, scene):
    browser.ask(f"""(() => {{ const choice = document.querySelector('select'); choice.value = '{scene}';
      choice.dispatchEvent(new Event('change')); }})()""")
    browser.settle()


def test_presets(browser, page, folder):
    """Templates of crawler init, the link with the state, the file for crawler run."""
    look = "[document.querySelector('[data-key=displacement] data').value, document.querySelector('pre').textContent, document.querySelector('select').value]"
    for path in sorted((ROOT / "prm/templates").glob("*.prm")):
        text = path.read_text(encoding="utf-8")
        offered = browser.ask(f"[...document.querySelectorAll('optgroup option')].some(one => one.value === '{path.stem}')")
        expect(offered != any(f"subsection {study}" in text for study in ("Sweep", "Fit", "Optimize", "Table")),
               f"the template {path.stem} is {'' if offered else 'not '}offered")
        if offered:
            choose(browser, path.stem)
            expected, tolerance = map(float, re.search(r"# Expect: displacement (\S+), tolerance (\S+)", text).groups())
            displacement = float(browser.ask(look)[0])
            # Of the larva's steps every third is refused: round-off of exp() decides on which, so its digits are the browser's.
            expect(abs(displacement - expected) <= browser.ask("live.run.summary.displacement_error.total") + tolerance * abs(expected),
                   f"{path.stem}: the displacement is {displacement}")
            body = [line for line in text.splitlines() if not re.match("# (Expect|Next)|set Accuracy", line)]
            expect("\n".join(body) in browser.ask(look)[1], f"{path.stem}: the file is the template")
    choose(browser, "earthworm")
    for key, steps in (("Body/Length", 10), ("Body/Anchoring exponent", 3), ("Time/End time", -25)):
        before = browser.ask(look)
        move(browser, key, steps)
        expect(all(one != other for one, other in zip(before[:2], browser.ask(look))), f"numbers and file follow {key}")
    kept, link = browser.ask(look), browser.ask("live.link.href")
    expect("set Length               = 11.5" in kept[1] and "set End time = 7.07" in kept[1], f"values of sliders are in the file {kept[1]}")
    browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(folder))
    saved = folder / "crawler.prm"
    saved.unlink(missing_ok=True)
    browser.ask("live.download.click()")
    for _ in range(200):  # until the browser has written it
        browser.settle()
        if saved.exists() and saved.read_text(encoding="utf-8") == kept[1]:
            break
    expect(saved.exists() and saved.read_text(encoding="utf-8") == kept[1], "the file that is downloaded is the one that is shown")
    choose(browser, "segments")
    browser.ask("live.link.click()")
    browser.settle()
    there = browser.ask(look)
    browser.ask(f"void (location.href = {json.dumps(link)})")
    browser.wait_for("document.querySelector('select').value === 'earthworm'")
    browser.settle()
    expect(browser.ask(look) == kept and there[2] == "segments", "a link in the open page brings back the sliders")
    browser.ask("void history.back()")
    browser.wait_for("document.querySelector('select').value === 'segments'")
    browser.settle()
    expect(browser.ask(look) == there, "the way back does so, too")
    page_of(browser, page, fragment=link.partition("#")[2])
    expect(browser.ask(look) == kept, "a link in a new page, too")
    page_of(browser, page, fragment="scene=constructor&accuracy=1&p=x&strain=-1e9&speed=")
    expect(browser.ask("[live.scene, live.accuracy, live.values().p, live.values().strain, live.values().speed, live.run.summary.status]")
           == ["optimal", "1e-3", 2, 0.02, 1, "finished"], "a damaged link is a page at its start")


def test_browser(page, folder):
    """Sliders, choices, wide and narrow, light and dark. Returns the parameter files of the scenes."""
    with Browser() as browser:
        page_of(browser, page)
        texts = {name: browser.ask(f"parameterFile({json.dumps(scene)}, {json.dumps(VALUES | changes)}, '1e-4')")
                 for name, (scene, changes) in SCENES.items()}
        look = """[document.querySelector('[data-key=displacement] data').value, document.querySelector('pre').textContent,
                   document.querySelectorAll('.chart canvas')[0].toDataURL(), document.querySelectorAll('.chart canvas')[1].toDataURL()]"""
        before = browser.ask(look)
        for key in SLIDERS:
            move(browser, key, 2)
            after = browser.ask(look)
            expect(all(one != other for one, other in zip(before, after)), f"numbers, file and pictures follow {key}")
            before = after
        for scene in ("wave", "segments", "strain"):
            choose(browser, scene)
            expect(browser.ask("live.run.summary?.status") == "finished", f"{scene} is computed")
        test_presets(browser, page, folder)
        page_of(browser, page)
        browser.ask("document.querySelector('.play').click()")
        browser.settle()
        expect(browser.ask("live.clock.running"), "the body moves")
        for width, dark in ((1200, True), (360, False)):
            page_of(browser, page, width=width, dark=dark)
            browser.picture(folder / f"live_page_{width}.png")
            expect(browser.ask("document.documentElement.scrollWidth <= innerWidth"), f"nothing is cut off at a width of {width}")
        expect(not browser.complaints, f"no complaints {browser.complaints}")
        expect(all(one.startswith(("file:", "data:")) for one in browser.requests), "no network")
    return texts


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    if not shutil.which("node"):
        print("node is not installed")
        sys.exit(77)
    built = call([ROOT / "contrib/live/build.sh", folder])
    if built.returncode == 77:
        print(built.stderr)
        sys.exit(77)
    if expect(built.returncode == 0, f"the page is built {built.stdout[-2000:]} {built.stderr}"):
        core, page = folder / "crawler_live.js", folder / "crawler_live.html"
        texts = test_browser(page, folder)
        texts["prm/paper/fig_s1.prm"] = (ROOT / "prm/paper/fig_s1.prm").read_text(encoding="utf-8")
        texts["kinematic"] = "set Model = kinematic\n" + texts["given strain"]
        test_numbers(program, core, texts)
        test_refusals(core)
    checks.end()


main()
