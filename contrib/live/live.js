// The live page: sliders make a parameter file, the program's own code computes it here, and the pictures of the report
// show the run.

/** Entries that a slider sets: name, range, how a place of the slider becomes a value. */
const SLIDERS = {
  p: {name: 'anchoring exponent p', low: -2, high: 4, step: 0.1, value: 2},
  strain: {name: 'strain m/k', low: 0.02, high: 0.6, step: 0.01, value: 0.3},
  stiffness: {name: 'stiffness k', low: -1.3, high: 1.3, step: 0.05, value: 0, of: x => Number((10 ** x).toPrecision(2))},
  speed: {name: 'wave speed c', low: 0.25, high: 4, step: 0.05, value: 1},
  waves: {name: 'waves on the body', low: 0.5, high: 4, step: 0.25, value: 1},
  segments: {name: 'segments', low: 2, high: 24, step: 1, value: 8},
  strides: {name: 'strides', low: 1, high: 6, step: 1, value: 3},
};

const section = (name, entries) => `  subsection ${name}
${Object.entries(entries).map(([entry, value]) => `    set ${entry} = ${value}`).join('\n')}
  end
`;
const stress = (generator, ...sections) => `subsection Active stress
  set Generator = ${generator}
${sections.join('')}end
`;
const exact = x => String(Number(x.toPrecision(12)));

/** A wave that comes up in half a period. */
const travelling = (v, amplitude) => section('Travelling wave', {Amplitude: exact(amplitude), 'Wave number': v.waves, 'Given by': 'wave speed',
  'Wave speed': v.speed, 'Ramp duration': exact(0.5 / (v.speed * v.waves))});

/** What moves the body: the sliders that matter, waves as whole numbers or not, and the lines of the parameter file. */
const SCENES = {
  optimal: {name: 'optimal wave (Fig. S1)', uses: ['strain', 'waves'], wholeWaves: true,
    text: v => stress('optimal wave', section('Optimal wave', {'Perturbation parameter': v.strain, 'Sine coefficients': '0, '.repeat(v.waves - 1) + '1',
      'Choose wave by': 'wave speed', 'Wave speed': v.speed}))},
  wave: {name: 'travelling stress', uses: ['strain', 'waves'], text: v => stress('travelling wave', travelling(v, v.strain * v.stiffness))},
  segments: {name: 'segments of a robot', uses: ['strain', 'waves', 'segments'],
    text: v => stress('segments', section('Segments', {'Number of segments': v.segments, Amplitude: exact(v.strain * v.stiffness), Frequency: exact(v.speed * v.waves),
      'Phase lag': exact(v.waves / v.segments), 'Rate limit': exact(5 * v.strain * v.stiffness * v.speed * v.waves), 'Ramp duration': exact(0.5 / (v.speed * v.waves))}))},
  strain: {name: 'prescribed strain', uses: ['strain', 'waves'],
    text: v => stress('prescribed strain', section('Prescribed strain', {'Given by': 'travelling wave'}), travelling(v, v.strain))},
};

for (const scene of Object.values(SCENES)) scene.sliders = SLIDERS;

/** A template of crawler init: each of its numbers has a slider from half to twice the value, p the usual one. */
function templateScene(name, text) {
  const sections = [], sliders = {}, lines = [];
  for (const line of text.split('\n')) {
    const [, before, entry, number, after] = /^(\s*set (.*?)\s*= )(-?[\d.]+)(\s*(?:#.*)?)$/.exec(line) ?? [];
    if (/^set Accuracy/.test(line)) continue;
    if (/^\s*subsection /.test(line)) sections.push(line.trim().slice(11));
    if (/^\s*end\b/.test(line)) sections.pop();
    const key = [...sections, entry].join('/'), start = Number(number);
    const step = /^Number of/.test(entry) ? Math.round : x => Number(x.toPrecision(3));
    if (entry === 'Anchoring exponent') sliders[key] = {...SLIDERS.p, value: start};
    else if (start) sliders[key] = {name: entry, low: -1, high: 1, step: 0.02, value: 0, of: x => x ? step(start * 2 ** x) : start};
    if (sliders[key]) sliders[key].note = after.replace(/^\s*#\s*/, '');
    lines.push(sliders[key] ? v => `${before}${v[key] ?? number}${after}` : () => line);
  }
  return {name, sliders, uses: [], file: v => lines.map(line => line(v)).join('\n')};
}
for (const [name, text] of Object.entries(page.templates)) SCENES[name] = templateScene(name, text);

/** The parameter file of a scene with these values. */
function parameterFile(scene, v, accuracy) {
  return `set Accuracy = ${accuracy}
${SCENES[scene].file?.(v) ?? `subsection Body
  set Elastic modulus    = ${v.stiffness}
  set Anchoring exponent = ${v.p}
end
${SCENES[scene].text(v)}subsection Time
  set End time = ${exact(v.strides / (v.speed * v.waves))}
end
`}subsection Output
  set Number of snapshots = 1
  set Statistics          = false
end
`;
}

/** The program in WebAssembly. */
class Core {
  constructor(module) {
    this.module = module;
    const {entries, n_points} = JSON.parse(module.ccall('crawler_entries', 'string', [], []));
    page.entries = entries;
    this.places = Array.from({length: n_points}, (_, i) => i / (n_points - 1));
  }
  /** What a run of the parameter file gives, with the seconds that it took. */
  run(text) {
    const start = performance.now(), run = JSON.parse(this.module.ccall('crawler_run', 'string', ['string'], [text]));
    if (run.times?.length) run.live = this.fields(run);
    run.milliseconds = performance.now() - start;
    return run;
  }
  fields(run) {
    const n = run.times.length * this.places.length, fields = {};
    for (const name of [...Object.keys(FIELDS), 'displacement']) {
      const from = this.module.ccall('crawler_field', 'number', ['string'], [name]);
      if (from) fields[name] = Float32Array.from(this.module.HEAPF64.subarray(from / 8, from / 8 + n));
    }
    return new LiveFields(run, this.places, fields);
  }
}

/** The fields of a run that has just been computed. */
class LiveFields extends Fields {
  constructor(run, places, fields) {
    super({...run, kymograph: {places, times: run.times.map(t => t / run.end_time), fields: {}}});
    Object.assign(this, {fields, shown: run.shown});
    this.fields.position = fields.displacement.map((u, i) => u + this.places[i % this.n]);
  }
}

const ACCURACIES = ['1e-2', '1e-3', '1e-4', '1e-6'];

/** The page itself. */
class LivePage {
  constructor(core, parent) {
    Object.assign(this, {core, parent});
    parent.append(el('header', {}, el('div', {class: 'kind'}, 'live'), el('h1', {}, 'A crawler that answers at once'),
      el('p', {class: 'soft'}, 'Move a slider: the program itself, compiled for the browser, chooses mesh and steps for the accuracy you ask for, computes the run, and bounds its error.')));
    const choices = el('div', {class: 'controls'},
      chooser('Driven by', [], '', scene => { this.choose(scene); this.ask(); }),
      chooser('Accuracy', ACCURACIES.map(x => [x, x]), '', accuracy => { this.accuracy = accuracy; this.ask(); }),
      this.link = el('a', {title: 'The address of this page with all its sliders: to keep or to pass on'}, 'Link to this'),
      this.download = el('a', {class: 'button', download: 'crawler.prm'}, 'Download .prm'),
      this.cost = el('span', {class: 'soft cost', role: 'status'}));
    [this.scenes, this.accuracies] = choices.querySelectorAll('select');
    const options = own => Object.entries(SCENES).filter(([, {file}]) => !file === own).map(([key, {name}]) => el('option', {value: key}, name));
    this.scenes.append(...options(true), el('optgroup', {label: 'Templates of crawler init'}, ...options(false)));
    this.sliders = el('div', {class: 'sliders'});
    this.problem = el('div', {class: 'problem'});
    this.body = el('div');
    this.numbers = el('div');
    this.text = el('pre');
    parent.append(choices, this.sliders, this.problem, this.body,
      el('details', {class: 'details'}, el('summary', {}, 'All numbers, with the bounds of their errors'), this.table = el('div')),
      el('details', {class: 'details'}, el('summary', {}, 'The parameter file'), el('p', {class: 'soft small'}, 'crawler run computes the same with it, and writes files.'), this.text),
      el('footer', {}, 'Computed on this device; nothing is sent anywhere. Formulas, tables, adaptive meshes and plug-ins need the program.'));
    this.table.parentElement.addEventListener('toggle', () => this.showTable());
    window.addEventListener('hashchange', () => { if (location.hash !== this.link.getAttribute('href')) { this.follow(); this.ask(); } });
    this.follow();
    this.compute();
  }
  /** Takes the state from the address; what it does not say, or says wrongly, is as at the start. */
  follow() {
    const state = new URLSearchParams(location.hash.slice(1)), scene = state.get('scene'), accuracy = state.get('accuracy');
    this.accuracy = this.accuracies.value = ACCURACIES.includes(accuracy) ? accuracy : '1e-3';
    this.inputs = null;
    this.choose(Object.hasOwn(SCENES, scene) ? scene : 'optimal');
    for (const [key, {input}] of Object.entries(this.inputs))
      if (state.get(key) && isFinite(state.get(key))) input.value = state.get(key);
  }
  /** Shows a scene; its own sliders, if it has others than the one before. */
  choose(scene) {
    const before = this.inputs && SCENES[this.scene].sliders, {sliders} = SCENES[scene];
    this.scene = this.scenes.value = scene;
    if (sliders === before) return;
    this.inputs = {};
    this.sliders.replaceChildren(...Object.entries(sliders).map(([key, slider]) => this.slider(key, slider)));
  }
  slider(key, {name, low, high, step, value, note}) {
    const input = el('input', {type: 'range', min: low, max: high, step, value, id: key, oninput: () => this.ask()}), output = el('output');
    const label = el('label', {title: note}, name, input, output);
    this.inputs[key] = {input, output, label};
    return label;
  }
  values() {
    const scene = SCENES[this.scene];
    return Object.fromEntries(Object.entries(scene.sliders).map(([key, {of}]) => {
      let value = Number(this.inputs[key].input.value);
      if (of) value = of(value);
      if (key === 'waves' && scene.wholeWaves) value = Math.max(1, Math.round(value));
      return [key, value];
    }));
  }
  /** Computes once before the next picture, however many sliders have moved. */
  ask() {
    this.asked ??= requestAnimationFrame(() => { this.asked = null; this.compute(); });
  }
  compute() {
    const values = this.values(), scene = SCENES[this.scene];
    for (const [key, {output, label}] of Object.entries(this.inputs)) {
      output.textContent = show(values[key], 4);
      label.classList.toggle('off', ['strain', 'waves', 'segments'].includes(key) && !scene.uses.includes(key));
    }
    const text = parameterFile(this.scene, values, this.accuracy), run = this.core.run(text);
    this.text.textContent = text;
    this.link.href = '#' + new URLSearchParams({scene: this.scene, accuracy: this.accuracy,
      ...Object.fromEntries(Object.entries(this.inputs).map(([key, {input}]) => [key, input.value]))});
    this.download.href = 'data:text/plain;charset=utf-8,' + encodeURIComponent(text);
    this.run = run;
    this.problem.replaceChildren();
    const {summary} = run;
    if (run.problem || summary.status !== 'finished')
      this.problem.append(el('div', {class: `notice ${run.problem ? 'failed' : summary.status}`},
        el('p', {}, run.problem ?? `${summary.status}: ${summary.message ?? summary.reason}`)));
    this.cost.textContent = `${show(run.milliseconds, 3)} ms` + (summary ? `, ${summary.model} model` : '');
    this.body.style.opacity = run.live ? 1 : 0.25;
    if (run.live) this.showRun(run);
    this.showTable();
    this.parent.dataset.runs = Number(this.parent.dataset.runs ?? 0) + 1;
  }
  showRun(run) {
    const period = at(run.summary, 'gait.period'), end = run.live.end;
    run.pace = known(period) && period < end ? period : end;
    if (!this.shown) {
      this.clock = new Clock(end, run.pace);
      this.shown = showBody(this.body, run, this.clock, run.live);
      this.shown.right.append(this.numbers);
    } else {
      const part = this.clock.t / this.clock.end;
      this.clock.t = part * end;
      this.shown.use(run, run.live);
    }
    this.numbers.replaceChildren();
    showTiles(this.numbers, run.summary);
    this.numbers.append(el('p', {class: 'small'}, gaitInWords(run.summary).join(' ')));
    if (run.notes.length) this.numbers.append(el('p', {class: 'soft small'}, run.notes.join(' ')));
  }
  showTable() {
    if (this.table.parentElement.open && this.run.summary) this.table.replaceChildren(numbersTable(this.run.summary));
  }
}

if (typeof document !== 'undefined')
  crawlerCore().then(module => { window.live = new LivePage(new Core(module), document.getElementById('page')); });
