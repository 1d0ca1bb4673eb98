// The page of each kind of folder, from the header to the parameters.

const summary = page.summary ?? {};
const main = document.getElementById('page');
const section = (title, ...children) => { const box = el('section', {}, title ? el('h2', {}, title) : '', ...children); main.append(box); return box; };
const command = {optimisation: 'optimize'}[page.kind] ?? page.kind;

// What went wrong, and what to do about it ----------------------------------------------------------------------------

/** Texts of the user guide: names between backticks, links as plain words. */
const marked = text => text.replace(/\[([^\]]*)\]\([^)]*\)/g, '$1').split('`').map((part, i) => i % 2 ? el('code', {}, part) : part);

/** The rows of the user guide's table about a reason: {code, meaning, advice}. */
function adviceOn(reason, ofRows) {
  const rows = page.reasons.split('\n').map(line => line.split('|').map(cell => cell.trim())).filter(cells => cells[1] === '`' + reason + '`');
  const list = rows.map(([, , code, meaning, advice]) => ({code, meaning: meaning.replace(/^\(\w+\) /, ''), advice}));
  const special = list.filter(({code}) => code.startsWith('(') && code.includes(command));
  const own = ofRows && special.length ? special : list.filter(({code}) => !code.startsWith('('));
  return own.length ? own : list;
}

function notice(kind, title, reason, message, ofRows = false) {
  const box = el('div', {class: `notice ${kind}`, role: 'note'}, el('p', {}, el('b', {}, title), message ? ` ${message}` : ''));
  for (const {meaning, advice} of reason ? adviceOn(reason, ofRows) : [])
    box.append(el('p', {class: 'small'}, ...marked(meaning), '. ', advice && advice !== 'none' ? el('span', {}, 'What to do: ', ...marked(advice), '.') : ''));
  main.append(box);
}

function notices() {
  const status = summary.status;
  if (!page.summary)
    notice('unfinished', 'Unfinished.', null, page.kind === 'run' ? 'The run has left no summary.json: it was killed, or is still running. What follows is what it has written so far.'
      : `The ${page.kind} has left no summary.json: it was killed, or is still running. The same command with --resume continues it.`);
  else if (status && status !== 'finished')
    notice(status, `${status[0].toUpperCase()}${status.slice(1)}: ${(page.kind === 'optimisation' ? summary.optimize?.reason : summary.reason) ?? 'the reason is not known'}.`,
      page.kind === 'optimisation' ? summary.optimize?.reason : summary.reason, summary.message);
  if (page.kind === 'run' && summary.status === 'finished' && known(summary.displacement) && !known(at(summary, 'displacement_error.total')))
    notice('unfinished', 'The error of the displacement is not known.', null, 'With "Error estimate" = true a second, finer run measures it.');
}

/** How many rows have which reason, with advice. */
function reasonsOfRows(explorer, name) {
  const reasons = explorer.columns.get(name), counts = new Map();
  for (let row = 0; reasons && row < explorer.rows; ++row) if (reasons.value(row)) counts.set(reasons.value(row), (counts.get(reasons.value(row)) ?? 0) + 1);
  for (const [reason, count] of [...counts].sort((a, b) => b[1] - a[1])) notice('unfinished', `${plural(count, page.kind === 'tradeoff' ? 'setting' : 'point')}: ${reason}.`, reason, '', true);
}

// Header and parameters -----------------------------------------------------------------------------------------------

function header() {
  document.title = `${page.folder} – crawler ${page.kind}`;
  const own = page.kind === 'optimisation' ? summary.optimize ?? {} : summary, status = summary.status ?? (page.summary ? '' : 'unfinished');
  const seconds = known(own.seconds) ? own.seconds : Object.values(own.seconds ?? {}).filter(known).reduce((a, b) => a + b, 0);
  const facts = [seconds ? `${show(seconds, 3)} s` : '', summary.ranks > 1 ? `${summary.ranks} processes` : '', summary.versions?.crawler ? `crawler ${summary.versions.crawler}` : '',
    page.kind === 'run' && summary.model ? `${summary.model} model` : ''];
  main.append(el('header', {}, el('div', {class: 'kind'}, page.kind), el('h1', {}, page.folder),
    el('div', {class: 'facts soft small'}, status ? el('span', {class: `status ${status}`}, status) : '', ...facts.filter(Boolean).map(text => el('span', {}, text)))));
}

function parameters() {
  const {entries, original, effective} = page.parameters;
  const box = section('What was run');
  if (own_command()) box.append(el('pre', {}, own_command()));
  if (entries.length)
    box.append(el('p', {class: 'soft small'}, 'Entries that differ from their defaults:'), el('div', {class: 'scroll'}, el('table', {}, el('thead', {}, el('tr', {}, el('th', {}, 'entry'), el('th', {}, 'value'),
      el('th', {class: 'wide-only'}, 'default'), el('th', {class: 'wide-only'}, 'meaning'))),
      el('tbody', {}, ...entries.map(one => el('tr', {}, el('td', {class: 'entry'}, ...brokenAtSlashes(one.entry)), el('td', {class: 'entry text'}, one.value, el('span', {class: 'unit'}, ' ' + unitText(one.unit))),
        el('td', {class: 'entry text wide-only soft'}, one.default), el('td', {class: 'meaning wide-only'}, one.meaning)))))));
  for (const [name, text] of [['The parameter file (original.prm)', original], ['All entries as they were used (parameters.prm)', effective]])
    if (text) box.append(el('details', {}, el('summary', {}, name), el('pre', {tabindex: 0}, text)));
  for (const run of page.kind === 'run' || page.kind === 'optimisation' ? page.runs : [])
    if (run.summary) section(run.title ? `All numbers of ${run.title}` : 'All numbers', numbersTable(run.summary));
  const versions = Object.entries(summary.versions ?? {}).map(([name, version]) => `${name} ${version}`).join(', ');
  main.append(el('footer', {}, versions ? `Computed with ${versions}. ` : '', `Page made by crawler report ${page.program.crawler ?? ''} from ${page.path}.`));
}
function own_command() { return (page.kind === 'optimisation' ? summary.optimize?.command_line : summary.command_line) ?? ''; }

// Sweeps -------------------------------------------------------------------------------------------------------------

/** A row of a sweep as the object that summary.json is. */
function summaryOf(explorer, row) {
  const object = {};
  for (const column of explorer.columns.values()) {
    const words = column.name.split('.'), last = words.pop();
    let place = object;
    for (const word of words) place = typeof place[word] === 'object' && place[word] ? place[word] : place[word] = {};
    place[last] = column.value(row);
  }
  return object;
}

const quoted = text => `'${text.replace(/'/g, "'\\''")}'`;

/** The command that computes a point with all its files, to be called in the folder. */
function pointCommand(explorer, row) {
  const number = explorer.index.value(row);
  if (explorer.axes.includes('File'))
    return `${own_command().replace(/ --(resume|overwrite)\b/g, '')} --resume --set ${quoted(`Sweep/Keep fields=${number}`)}`;
  const sets = explorer.axes.map(name => ` \\\n  --set ${quoted(`${name}=${explorer.columns.get(name)?.value(row) ?? ''}`)}`);
  return `cd ${quoted(page.path)}\ncrawler run parameters.prm --output points/${number}${sets.join('')}`;
}

function pointDetails(panel, row, explorer) {
  if (Clock.current) Clock.current.running = false;
  const number = explorer.index.value(row), name = `points/${number}`, run = page.runs.find(one => one.title === name);
  panel.append(el('p', {}, ...explorer.axes.map(axis => explorer.columns.get(axis)).filter(Boolean).flatMap((column, i) => [i ? ', ' : '', column.title + ' = ', el('b', {}, column.words(row))])));
  const value = name => explorer.columns.get(name)?.value(row) ?? null, status = value('outcome') ?? value('status'), message = value('explanation') ?? value('message');
  if (status !== 'finished') panel.append(el('p', {}, el('b', {}, status ?? 'not computed yet'), message ? `: ${message}` : ''));
  if (value('verdict')) panel.append(answersOf(value));
  if (run) { showRun(panel, run); return; }
  const one = summaryOf(explorer, row);
  showTiles(panel, one);
  panel.append(el('p', {}, gaitInWords(one).join(' ')));
  if (explorer.columns.get('reason')?.value(row) === 'refused') return; // there is nothing to compute
  panel.append(page.more_runs.includes(name) ? el('p', {}, 'The files of this point are in ', el('a', {href: `${name}/`}, name), '; crawler report makes a page of them.')
    : el('p', {class: 'soft small'}, 'Body and kymograph of this point were not kept. This computes them; the next crawler report shows them here:'));
  if (!page.more_runs.includes(name)) panel.append(el('pre', {tabindex: 0}, pointCommand(explorer, row)));
}

/** What the runs of a point say that is cross-checked. */
function answersOf(value) {
  const body = ['', 'position ', 'stretch ', 'refined '].filter(run => value(`${run}status`)).map(run => el('tr', {}, el('td', {}, run || 'run'), el('td', {}, value(`${run}status`), value(`${run}reason`) ? `: ${value(`${run}reason`)}` : ''),
    ...['displacement', 'promised error', 'error ratio', 'inversion.t', 'min_stretch.value'].map(number => el('td', {class: 'value'}, exactly(value(run + number), show(value(run + number), number.includes('error') ? 2 : 8))))));
  return el('div', {class: 'scroll'}, el('table', {}, el('thead', {}, el('tr', {}, ...['answer', 'status', withUnit('displacement', 'length'), 'promised error', 'measured over promised', 'inverted at t', 'least stretch'].map(name => el('th', {}, name)))), el('tbody', {}, ...body)));
}

function showPoints() {
  const box = section(''), {table} = page;
  if (!table) { box.append(el('p', {}, 'There is no table of points yet.')); return; }
  const axes = table.columns.filter(column => column.meaning.startsWith('axis of the')).map(column => column.name), [last, before] = [...axes].reverse();
  const isChecked = table.columns.some(column => column.name === 'verdict'), value = ['displacement', 'status'];
  const explorer = new Explorer(box, table, {axes, status: isChecked ? 'outcome' : 'status', details: pointDetails,
    first: before ? {x: [last], y: [before], colour: isChecked ? ['outcome'] : value} : {x: [last, 'index'], y: value, colour: []}});
  const status = explorer.columns.get('status');
  let computed = 0;
  for (let row = 0; status && row < table.rows; ++row) computed += status.value(row) !== null;
  const words = [`${plural(table.all_rows, 'point')} over ${axes.map(shortName).join(' and ')}`, computed < table.rows ? `${computed.toLocaleString('en')} of ${table.rows.toLocaleString('en')} are computed` : '',
    table.rows < table.all_rows ? `this page has ${table.rows.toLocaleString('en')} of them, evenly chosen` : ''].filter(Boolean).join('; ') + '.';
  box.prepend(el('p', {}, words));
  if (table.left_out.length) box.append(el('details', {class: 'small'}, el('summary', {}, `${plural(table.left_out.length, 'column')} left out, to keep this page small`), el('p', {class: 'soft'}, `${table.left_out.join(', ')}. The table in the folder has them.`)));
  if (summary.cross_check) {
    const {checked, silent_wrong_answers: wrong, largest_error_ratio: ratio} = summary.cross_check;
    box.prepend(el('p', {}, `${plural(checked ?? 0, 'point')} checked by a second answer; `, el('b', {}, wrong ? `${plural(wrong, 'silent wrong answer')}.` : 'no silent wrong answers.'), known(ratio) ? ` The largest measured error is ${show(ratio, 3)} of what was promised.` : ''));
  }
  reasonsOfRows(explorer, 'reason');
}

// Tradeoff --------------------------------------------------------------------------------------------------------------

const inTime = seconds => !known(seconds) ? '–' : seconds < 1e-3 ? `${show(seconds * 1e6, 3)} µs` : seconds < 1 ? `${show(seconds * 1e3, 3)} ms` : `${show(seconds, 3)} s`;

/** Pareto fronts, and the errors that cannot be told from 0. */
function linesOfFronts(explorer, {x: {low, high}}) {
  if (explorer.x !== 'seconds' || explorer.y !== 'shown error') return [];
  const [x, y, engine] = ['seconds', 'shown error', 'engine'].map(name => explorer.columns.get(name)), front = new Set(summary.pareto ?? []), bar = at(summary, 'reference.relative_bar');
  const fronts = [false, true].map((batch, i) => {
    const rows = explorer.list.filter(row => front.has(explorer.index.value(row)) && (engine.value(row) === 'batch') === batch).sort((a, b) => x.number(a) - x.number(b));
    return lineOf('', rows.map(row => x.number(row)), rows.map(row => y.number(row)), ink('ink'), {stepped: true, borderWidth: 1.3, borderDash: i ? [6, 4] : []});
  });
  return known(bar) ? [...fronts, lineOf('', [low, high], [bar, bar], ink('raised'), {fill: 'start'})] : fronts;
}

function showTradeoff() {
  const {reference} = summary, all = [...(summary.recommendations ?? []).map(one => [one, false]), ...(summary.batch_recommendations ?? []).map(one => [one, true])];
  if (reference) section('', el('p', {}, 'Reference: displacement ', exactly(reference.displacement, showWith(reference.displacement, reference.bar)), ` ± ${show(reference.bar, 2)}`,
    ` by ${reference.answer?.method ?? '?'}${reference.check.method ? `, checked by ${reference.check.method}` : ' alone'}. ${summary.points - (summary.statuses.missing ?? 0)} of ${summary.points} settings were tried.`));
  if (all.length) section('What to use', el('p', {class: 'soft'}, 'The cheapest setting that is good enough; click for its lines of the parameter file.'), el('div', {class: 'scroll'}, el('table', {},
    el('thead', {}, el('tr', {}, ...['for', 'setting', 'error', 'time of a run'].map(name => el('th', {}, name)))), el('tbody', {}, ...all.map(([one, batch]) => el('tr', {},
      el('td', {class: 'value'}, tickText(one.accuracy, true), batch ? ' in a batch' : ''), el('td', {class: 'entry'}, one.prm ? el('details', {style: 'margin:0'}, el('summary', {}, one.setting), el('pre', {}, one.prm)) : one.setting),
      el('td', {class: 'value'}, exactly(one.error, show(one.error, 2))), el('td', {class: 'value'}, exactly(one.seconds, inTime(one.seconds)))))))));
  const box = section('All settings');
  if (!page.table) { box.append(el('p', {}, 'There is no table of settings: it is written at the end.')); return; }
  const explorer = new Explorer(box, page.table, {axes: [], status: 'status', decorate: linesOfFronts, logarithmic: ['seconds', 'shown error', 'memory'], first: {x: ['seconds'], y: ['shown error'], colour: ['engine', 'model']},
    details: (panel, row, own) => panel.append(el('p', {}, ['model', 'formulation', 'mesh', 'engine', 'integrator'].map(name => own.columns.get(name)?.value(row)).filter(Boolean).join(', '), '; ', own.columns.get('message')?.value(row) ?? ''),
      el('pre', {tabindex: 0}, (own.columns.get('entries')?.value(row) ?? '').replaceAll('; ', '\n')))});
  box.append(el('p', {class: 'soft small'}, 'Lines: the Pareto fronts of single runs and (dashed) of batches. Shaded: errors below the uncertainty of the reference.'));
  reasonsOfRows(explorer, 'reason');
}

// Optimisation ----------------------------------------------------------------------------------------------------------

/** The tolerance of limits, relative to them. */
const admissible = () => Math.max(1e-5, Number(page.parameters.entries.find(one => one.entry === 'Optimize/Tolerance')?.value ?? 0));
const wordsOfCase = one => Object.entries(one.case ?? {}).map(([name, value]) => `${name.split('/').pop()} ${typeof value === 'number' ? show(value) : value}`).join(', ');

/** The best gait so far of each start: {x, y, row} by case and start. */
function bestSoFar(explorer) {
  const [x, y, start, number, excess] = ['evaluation', 'objective', 'start', 'case', 'violation'].map(name => explorer.columns.get(name)), starts = new Map();
  const direction = page.parameters.entries.find(one => one.entry === 'Optimize/Direction')?.value, isCost = summary.optimize?.objective === 'cost of transport';
  const signs = new Map((summary.optimize?.optima ?? []).map(one => [one.number, (one.case?.['Optimize/Direction'] ?? direction) === 'backward' ? -1 : 1]));
  for (const row of [...explorer.list].sort((a, b) => x.number(a) - x.number(b))) {
    if (excess && excess.number(row) > admissible()) continue;
    const sign = (signs.get(number?.number(row)) ?? 1) * (isCost ? -1 : 1);
    const key = `${number?.number(row)} ${start?.number(row)}`, line = starts.get(key) ?? starts.set(key, {x: [], y: [], row}).get(key), best = line.y[line.y.length - 1];
    line.x.push(x.number(row));
    line.y.push(best === undefined || sign * y.number(row) > sign * best ? y.number(row) : best);
  }
  return [...starts.values()];
}
const showsProgress = explorer => explorer.x === 'evaluation' && explorer.y === 'objective';
const linesOfBest = explorer => !showsProgress(explorer) ? []
  : bestSoFar(explorer).map(line => lineOf('', line.x, line.y, explorer.colour === 'violation' ? ink('ink') : explorer.css(line.row), {stepped: true}));
/** Gaits far off the lines would hide how these rise. */
function frameOfBest(explorer, {x, y}) {
  const ends = showsProgress(explorer) ? bestSoFar(explorer).flatMap(line => range(line.y)) : [];
  return ends.length ? {x, y: {...padded(range(ends), false, 0.15), title: y.title}} : {};
}

function showOptimum(box, one, folder, unit) {
  const rows = (object, value) => Object.entries(object ?? {}).map(([name, x]) => el('tr', {}, el('td', {class: 'entry'}, ...brokenAtSlashes(name)), ...value(x)));
  box.append(el('p', {}, wordsOfCase(one) ? `With ${wordsOfCase(one)} t` : 'T', `he best ${summary.optimize.objective} is `, el('b', {'data-key': 'optimum'}, exactly(one.objective)), ` ${unitText(unit)}`.trimEnd(),
    known(one.efficiency) ? `, ${show(100 * one.efficiency, 3)} % of the upper bound for this work and these strains` : '',
    summary.optimize.objective === 'periodic merit' && known(one.stride_efficiency) ? ` (the last stride ${show(100 * one.stride_efficiency, 3)} % with its dissipation)` : '', '. ',
    one.is_admissible ? 'It is within all limits. ' : el('b', {}, `It exceeds a limit, by ${show(one.violation, 2)} of it. `), one.has_converged ? '' : el('b', {}, `The optimiser did not converge${one.message ? ': ' + one.message : ''}. `),
    'Its files are in ', el('a', {href: `${folder}/`}, `${folder}/`), ', its parameter file is ', el('a', {href: folder.replace('best', 'optimum') + '.prm'}, folder.replace('best', 'optimum') + '.prm'), '.'));
  const table = (names, body) => el('div', {class: 'scroll'}, el('table', {}, el('thead', {}, el('tr', {}, ...names.map(name => el('th', {}, name)))), el('tbody', {}, ...body)));
  box.append(el('div', {class: 'two'}, el('div', {}, el('h3', {}, 'Limits'), Object.keys(one.limits ?? {}).length
    ? table(['limit', 'value', 'what one unit more would add'], rows(one.limits, limit => [el('td', {class: 'value'}, exactly(limit.value)), el('td', {class: 'value'}, exactly(limit.multiplier))])) : el('p', {class: 'soft'}, 'none')),
    el('div', {}, el('h3', {}, 'Variables'), table(['entry', 'value'], rows(one.variables, value => [el('td', {class: 'value'}, exactly(value))])))));
}

function showOptimisation() {
  const box = section('How the gait became better'), optima = summary.optimize?.optima ?? [];
  let explorer = null;
  if (page.table) {
    explorer = new Explorer(box, page.table, {axes: [], status: 'problem', decorate: linesOfBest, frame: frameOfBest, fades: (row, own) => own.columns.get('violation')?.number(row) > admissible(), first: {x: ['evaluation'], y: ['objective'], colour: optima.length > 1 ? ['case'] : ['start', 'violation']},
      details: (panel, row, own) => panel.append(el('p', {}, own.columns.get('problem')?.value(row) ?? ''))});
    box.append(el('p', {class: 'soft small'}, 'Dots: all gaits that were tried, grey if they exceed a limit. Lines: the best so far within the limits.'));
  } else box.append(el('p', {}, 'There is no table of gaits: it is written when all starts have ended.'));
  if (!optima.length) return;
  const best = section('The best gait'), place = el('div');
  const pick = i => {
    if (Clock.current) Clock.current.running = false;
    place.replaceChildren();
    const folder = wordsOfCase(optima[i]) ? `best-${optima[i].number}` : 'best', run = page.runs.find(one => one.title === folder);
    showOptimum(place, optima[i], folder, explorer?.columns.get('objective')?.unit);
    if (run) showRun(place, run);
  };
  if (optima.length > 1) best.append(el('div', {class: 'controls'}, chooser('Case', optima.map((one, i) => [String(i), `${one.number}: ${wordsOfCase(one)}`]), '0', pick)));
  best.append(place);
  pick(0);
}

header();
notices();
if (page.kind === 'run') showRun(main, page.runs[0]);
else ({sweep: showPoints, tradeoff: showTradeoff, optimisation: showOptimisation, fit: showFit, comparison: showComparison})[page.kind]();
parameters();
