// What a fit has found: values and profiles, what the data do not tell, and the data beside the best run.

// A table; on a narrow screen a block for each row, in which each cell has its heading before it.
const tableOf = (heads, rows) => el('div', {class: 'scroll'}, el('table', {class: 'stacks'}, el('thead', {}, el('tr', {}, ...heads.map(name => el('th', {}, name)))),
  el('tbody', {}, ...rows.map(cells => el('tr', {}, ...cells.map((cell, i) => el('td', i ? {class: 'value', 'data-head': heads[i]} : {class: 'entry'}, ...[cell].flat())))))));
const sentence = text => `${text[0].toUpperCase()}${text.slice(1)}.`;
const told = () => Object.entries(summary.variables ?? {}).filter(([, one]) => one.determined);

function showValues() {
  if (!summary.variables) return; // a fit that was killed
  const unit = entry => unitText(page.parameters.entries.find(one => one.entry === entry.replace(/\[[^\]]*\]$/, ''))?.unit), between = (ends, one) => !ends ? '–'
    : [0, 1].flatMap(i => [i ? ' to ' : '', ends[i] === null ? 'the limit' : exactly(ends[i], showWith(ends[i], one.deviation))]);
  const box = section('Values'), rows = Object.entries(summary.variables ?? {}).map(([entry, one]) => [[...brokenAtSlashes(entry)],
    one.determined === false ? 'not determined by the data' : [exactly(one.value, showWith(one.value, one.deviation)), known(one.deviation) ? ` ± ${show(one.deviation, 2)}` : one.at_limit ? ' at the limit' : '', el('span', {class: 'unit'}, ' ' + unit(entry))],
    show(one.numerical_error, 2), show(one.bias, 2), between(one.interval_68, one), between(one.interval_95, one), `${show(one.from)} to ${show(one.to)}`]);
  box.append(tableOf(['entry', 'value ± deviation', 'numerical error', 'bias', '68 %', '95 %', 'range'], rows));
  const {goodness: fit = {}} = summary;
  if (known(fit.chi_square)) box.append(el('p', {}, `${plural(fit.n_data, 'measured number')}, ${plural(fit.degrees_of_freedom, 'degree')} of freedom. `, fit.deviation_is_given
    ? `Chi-square is ${show(fit.chi_square, 5)}; noise alone gives as much or more with the probability ${show(fit.probability, 2)}.`
    : `The standard deviation of a datum is ${show(fit.series[0].deviation, 3)}, from the residuals: whether the scene fits cannot be told.`,
    fit.series.length > 1 ? '' : ` Residuals that are neighbours in time have the correlation ${show(fit.series[0].correlation_in_time, 2)}.`));
  if (fit.series?.length > 1 && known(fit.chi_square)) box.append(tableOf(['data', 'numbers', 'chi-square', 'deviation of one', 'correlation in time'],
    fit.series.map(one => [one.kind, exactly(one.n_data), exactly(one.chi_square, show(one.chi_square, 5)), show(one.deviation, 3), show(one.correlation_in_time, 2)])));
  for (const text of [...summary.undetermined ?? [], ...summary.notes ?? []]) box.append(el('div', {class: 'notice unfinished', role: 'note'}, el('p', {}, sentence(text))));
}

/** The rise of chi-square with each variable held off its best value and the others free. */
function showProfiles() {
  const lines = told().filter(([, one]) => known(one.deviation)).map(([entry, one]) => [entry, one.profile.map(([x]) => (x - one.value) / one.deviation), one.profile.map(([, rise]) => rise)]).filter(([, x]) => x.length > 1);
  if (!lines.length) return;
  const box = figure('Profiles.', 'Chi-square with a variable held there and the others free; where it has risen by 1 and 3.84 (grey) the intervals of 68 % and 95 % end. Dashed: the parabola of a linear model.');
  section('How well the data tell them', box);
  const [low, high] = range(lines.flatMap(([, x]) => x)), parabola = Array.from({length: 101}, (_, i) => low + i / 100 * (high - low)), axis = padded([low, high]);
  new Picture(box, {height: 290, label: 'profiles of chi-square',
    axes: () => ({x: {...axis, title: 'value less the best one, in standard deviations'}, y: {low: 0, high: Math.min(9, Math.max(5, ...lines.flatMap(([, , rise]) => rise))), title: 'rise of chi-square'}}),
    lines: () => [...lines.map(([entry, x, rise], i) => lineOf(shortName(entry), x, rise, series(i))), lineOf('', parabola, parabola.map(x => x * x), ink('soft'), {borderWidth: 1, borderDash: [4, 4]}),
      ...[1, 3.8415].map(rise => lineOf('', [axis.low, axis.high], [rise, rise], ink('line'), {borderWidth: 2}))]});
}

function showCorrelation() {
  const names = Object.keys(summary.variables ?? {}), {correlation} = summary;
  if (names.length < 2 || !correlation) return;
  section('Correlation of the values', el('p', {class: 'soft'}, 'Near 1 or −1: what one does, the other can undo.'),
    tableOf(['', ...names.map(shortName)], names.map((name, i) => [[...brokenAtSlashes(name)], ...names.map((_, j) => exactly(correlation[i][j], show(correlation[i][j], 3)))])));
}

/** The best run through the data of each place. */
function linesOfBestRun(explorer) {
  if (explorer.x !== 't' || explorer.y !== 'data') return [];
  const [t, place, model] = ['t', 'place', 'model'].map(name => explorer.columns.get(name)), lines = new Map();
  for (const row of explorer.list) { const key = place?.number(row); lines.set(key, [...lines.get(key) ?? [], row]); }
  return [...lines.values()].map(rows => rows.sort((a, b) => t.number(a) - t.number(b)))
    .map(rows => lineOf('', rows.map(row => t.number(row)), rows.map(row => model.number(row)), ink('ink'), {borderWidth: 1}));
}

function showFit() {
  showValues();
  showProfiles();
  showCorrelation();
  for (const table of page.tables ?? []) {
    const details = () => {}, of = page.tables.length > 1 ? `: ${table.kind}` : '', box = section(`Data and the best run${of}`);
    new Explorer(box, table, {axes: [], details, decorate: linesOfBestRun, first: {x: ['t'], y: ['data'], colour: ['place', 't']}});
    box.append(el('p', {class: 'soft small'}, 'Dots: the data. Lines: the best run.'));
    new Explorer(section(`Residuals${of}`, el('p', {class: 'soft'}, 'Data less run. Patches or stripes are what the scene does not describe; noise has none.')), table,
      {axes: ['t', 'place'], details, first: {x: ['place', 't'], y: table.columns.some(column => column.name === 'place') ? ['t'] : ['residual'], colour: ['residual']}});
  }
  const starts = summary.starts ?? [];
  if (starts.length === 1) section('Starts', el('p', {}, '1 start: the minimum may be local (Fit/Starts).'));
  else if (starts.length) section('Starts', tableOf(['start', 'residuals (root mean square)', ...Object.keys(starts[0].values).map(shortName)],
    starts.map(one => [String(one.start + 1), one.reason || exactly(one.residuals), ...Object.values(one.values).map(value => exactly(value))])));
}

/** Which of several scenes the data prefer: the criteria, as bars too, and what each fit has found. */
function showComparison() {
  const rows = summary.comparison ?? [], criteria = [['aic', 'AIC'], ['bic', 'BIC']], far = Math.max(10, ...rows.flatMap(one => criteria.map(([key]) => one[`${key}_less_least`])));
  const box = section('Which scene the data prefer', el('p', {class: 'soft'}, 'Information criteria of Akaike and Bayes, and by how much they are above the least one; a difference of 10 is strong evidence.'),
    tableOf(['scene', 'variables', 'chi-square', 'degrees of freedom', 'AIC', 'BIC', 'AIC less least', 'BIC less least'], rows.map(one => [el('a', {href: `${one.folder}/`}, one.scene),
      ...[one.variables, one.chi_square, one.degrees_of_freedom, one.aic, one.bic, one.aic_less_least, one.bic_less_least].map(value => exactly(value))])));
  const chart = figure('Criteria.', 'One more than the difference from the least; grey: a difference of 10.');
  box.append(chart);
  new Picture(chart, {type: 'bar', horizontal: true, height: 90 + 50 * rows.length, label: 'information criteria',
    axes: () => ({x: {low: 1, high: 1.3 * (1 + far), log: true, title: '1 + difference from the least'}, y: {texts: rows.map(one => one.scene)}}),
    lines: () => criteria.map(([key, name], i) => ({label: name, backgroundColor: series(i), barThickness: 10, minBarLength: 4, data: rows.map((one, row) => ({x: 1 + one[`${key}_less_least`], y: row}))})),
    overlay: (c, own) => { c.fillStyle = ink('unknown'); c.fillRect(own.x(11), own.chartArea.top, 2, own.chartArea.height); }});
  const entries = [...new Set(rows.flatMap(one => Object.keys(page.fits[one.folder].variables ?? {})))];
  const words = one => !one ? '–' : one.determined === false ? 'not determined by the data' : [exactly(one.value, showWith(one.value, one.deviation)), known(one.deviation) ? ` ± ${show(one.deviation, 2)}` : ''];
  section('Values', tableOf(['entry', ...rows.map(one => one.scene)], entries.map(entry => [[...brokenAtSlashes(entry)], ...rows.map(one => words(page.fits[one.folder].variables?.[entry]))])));
  for (const {scene, folder} of rows) for (const text of page.fits[folder].notes ?? []) main.append(el('div', {class: 'notice unfinished', role: 'note'}, el('p', {}, el('b', {}, scene), ` ${sentence(text)}`)));
}
