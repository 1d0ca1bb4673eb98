// A run: its numbers, in tiles, in words and in a table; its curves; its sensitivities.

/** A number of a summary with its bound and unit. */
function numberWithBound(summary, key, unit) {
  const value = at(summary, key), bound = at(summary, boundKey(key));
  return [exactly(value, known(value) ? showWith(value, bound) : show(value)), known(bound) ? ` ± ${show(bound, 2)}` : '',
    unitText(unit) ? el('span', {class: 'unit'}, ' ' + unitText(unit)) : ''];
}

function tile(name, summary, key) {
  const value = at(summary, key), bound = at(summary, boundKey(key));
  if (!known(value)) return null;
  const unit = page.entries.find(entry => entry.key === key)?.unit;
  return el('div', {class: 'tile'}, el('div', {class: 'name'}, name),
    el('div', {class: 'number', 'data-key': key}, exactly(value, showWith(value, Math.max(bound ?? 0, Math.abs(value) * 1e-6)))),
    el('div', {class: 'bound'}, known(bound) ? `± ${show(bound, 2)} ` : '', el('span', {class: 'unit'}, unitText(unit))));
}

function showTiles(parent, summary) {
  parent.append(el('div', {class: 'tiles'}, ...[['Displacement', 'displacement'], ['Speed', 'gait.speed'],
    ['Cost of transport', 'gait.cost_of_transport.stress_power'], ['Work', 'stress_power'],
    ['Smallest stretch', 'min_stretch.value'], ['Largest stretch', 'max_stretch.value']].map(([name, key]) => tile(name, summary, key))));
}

/** What the gait does, in sentences. */
function gaitInWords(summary) {
  const gait = summary.gait, words = [];
  if (!gait || !known(gait.period)) return words;
  const d = gait.displacement, to = d === 0 ? 'does not move on' : `moves ${show(Math.abs(gait.body_lengths), 4)} body lengths towards its ${d > 0 ? 'head (larger s)' : 'tail (smaller s)'}`;
  words.push(`In each stride (period ${show(gait.period, 5)}${unitBehind('time')})${gait.period_from === 'stretch' ? ' (a period found in its motion)' : ''} the body ${to}; ` +
    `${show(gait.strides, 4)} stride${gait.strides === 1 ? ' fits' : 's fit'} into the run.`);
  const wave = gait.wave ?? {};
  const direction = {retrograde: 'The wave of stretch is retrograde: it travels against the motion, as in an earthworm.',
    prograde: 'The wave of stretch is prograde: it travels with the motion, as in a snail.', standing: 'The wave of stretch stands still.'}[wave.direction];
  if (direction) words.push(direction + (known(wave.speed) ? ` Its speed is ${show(wave.speed, 4)}${unitBehind('length/time')}, and ${show(100 * wave.coherence, 3)} % of it travels.` : '') +
    (known(gait.slip) ? ` A slip of ${show(gait.slip, 4)}: the body keeps ${show(100 * (1 - gait.slip), 3)} % of the speed of its wave.` : ''));
  const cost = gait.cost_of_transport ?? {};
  if (known(cost.stress_power)) words.push(`Each ${unitBehind('length').trim() || 'unit of length'} costs the work ${show(cost.stress_power, 4)}${unitBehind('energy')}` +
    (known(cost.positive_power) ? `; ${show(cost.positive_power, 4)}${unitBehind('energy')} if actuators cannot take energy back.` : '.'));
  if (known(gait.efficiency)) words.push(`It goes ${show(100 * gait.efficiency, 3)} % as far as any gait could with this work and these strains.`);
  return words;
}

/** A column with its name in statistics.csv. */
function showCurves(parent, run, clock, fields) {
  const columns = run.statistics && columnsOf(run.statistics), time = columns?.get('time')?.numbers();
  if (!time || time.length < 2) {
    parent.append(el('p', {class: 'soft small'}, 'There are no curves over time: statistics.csv does not exist (Output/Statistics = true makes it).'));
    return;
  }
  const end = time[time.length - 1];
  const add = (title, text, names, height) => {
    const lines = names.map(([name, words]) => [columns.get(name), words ?? name]).filter(([column]) => column);
    if (!lines.length) return;
    const box = figure(title, text);
    parent.append(box);
    const least = 1e-12 * run.length, all = lines.flatMap(([column]) => range(column.numbers())).concat(-least, least);
    const chart = new Picture(box, {height, label: title,
      axes: () => ({x: {low: 0, high: end, title: withUnit('time t', 'time')}, y: {...padded(range(all)), title: withUnit(lines.length > 1 ? 'energy' : lines[0][1], lines[0][0].unit)}}),
      lines: () => lines.map(([column, words], i) => lineOf(words, time, column.numbers(), series(i))),
      overlay: (c, own) => {
        if (!clock || !fields) return;
        c.fillStyle = ink('soft');
        c.fillRect(own.x(clock.t), own.chartArea.top, 1, own.chartArea.height);
      },
      press: (x, y, own) => clock?.set(own.inverse(x, y)[0])});
    clock?.listeners.push(() => chart.draw());
  };
  add('Centre of mass.', 'How far it has come.', [['displacement', 'displacement D']], 210);
  const residual = at(run.summary, 'ledger_residual');
  add('Energy balance.', known(residual) ? `Work is what friction takes and what the body stores, up to ${show(residual, 2)} of it.` : '',
    [['stress power', 'work of the active stress'], ['dissipation', 'lost to friction'], ['elastic energy', 'stored in the body']], 260);
}

/** All numbers and words of a summary, in its order. */
function numbersTable(summary) {
  const body = el('tbody');
  for (const {key, unit, meaning} of page.entries) {
    const value = at(summary, key);
    if (value === null || typeof value === 'object' || /^errors\.|^displacement_error\.total|^inversion\.error|^message/.test(key)) continue;
    body.append(el('tr', {}, el('td', {}, nameOf(key)), el('td', {class: 'value', 'data-key': key}, ...numberWithBound(summary, key, unit)), el('td', {class: 'meaning wide-only'}, meaning)));
  }
  return el('div', {class: 'scroll'}, el('table', {}, el('thead', {}, el('tr', {}, el('th', {}, 'number'), el('th', {}, 'value ± bound of its error'), el('th', {class: 'wide-only'}, 'meaning'))), body));
}

function showSensitivities(parent, run) {
  const list = Object.entries(run.summary?.sensitivities ?? {});
  if (!list.length) return;
  parent.append(el('h2', {}, 'What matters'), el('p', {}, 'How the displacement changes with an entry: the derivative, and by how many per cent for one per cent of the entry.'));
  const most = Math.max(...list.map(([, one]) => Math.abs(one.elasticity ?? 0))) || 1, body = el('tbody');
  for (const [entry, one] of list)
    body.append(el('tr', {}, el('td', {class: 'entry'}, ...brokenAtSlashes(entry)), el('td', {class: 'value'}, ...(known(one.value) ? [exactly(one.value, showWith(one.value, one.error)), ` ± ${show(one.error, 2)}`] : ['not known'])),
      el('td', {class: 'value'}, known(one.elasticity) ? show(one.elasticity, 3) + ' %' : '–'),
      el('td', {class: 'wide-only', style: 'min-width:10rem'}, known(one.elasticity) ? el('span', {class: one.elasticity < 0 ? 'bar minus' : 'bar', style: `width:${Math.abs(one.elasticity) / most * 10}rem`}) : one.reason ?? '')));
  parent.append(el('div', {class: 'scroll'}, el('table', {}, el('thead', {}, el('tr', {}, ...['entry', 'dD / d entry', 'per %', ''].map((name, i) => el('th', {class: i === 3 && 'wide-only'}, name)))), body)));
  const columns = run.along_body && columnsOf(run.along_body), s = columns?.get('s')?.numbers();
  const lines = ['elastic modulus', 'friction'].filter(name => columns?.has(name));
  if (!s || !lines.length) return;
  const box = figure('Where on the body it matters.', 'Change of the displacement for a relative change of stiffness or friction there, per length.');
  parent.append(box);
  new Picture(box, {height: 250, label: 'sensitivities along the body', lines: () => lines.map((name, i) => lineOf(name, s, columns.get(name).numbers(), series(i))),
    axes: () => ({x: {low: 0, high: run.length, title: withUnit('place s on the body', 'length')}, y: {...padded(range([0, ...lines.flatMap(name => range(columns.get(name).numbers()))])), title: 'sensitivity'}})});
}

/** Everything of one run but for its table of numbers. */
function showRun(parent, run) {
  const {summary} = run;
  if (summary) {
    showTiles(parent, summary);
    parent.append(el('p', {}, gaitInWords(summary).join(' ')));
  }
  let clock = null, fields = null, curves = parent;
  if (run.kymograph?.fields.stretch && run.kymograph.fields.displacement) {
    fields = new Fields(run);
    const period = at(summary, 'gait.period');
    clock = new Clock(fields.end, known(period) && period < fields.end ? period : fields.end);
    curves = showBody(parent, run, clock, fields).right;
  } else parent.append(el('p', {class: 'soft small'}, 'There is no moving body here: ' + (summary?.status === 'stopped' ? 'the run was stopped, and kymograph.vts is written at its end; the same command with --resume continues it.' : 'kymograph.vts is missing (snapshots and Output/Kymograph = true make it).')));
  showCurves(curves, run, clock, fields);
  showSensitivities(parent, run);
}
