// A table of many points: a map, lines or dots over columns that can be chosen, and the details of one point.

const NOUN = {tradeoff: 'setting', optimisation: 'gait', fit: 'measured number'}[page.kind] ?? 'point';
const GOOD = ['finished', 'agree']; // green

class Explorer {
  /** @p table: that of the page; axes: names of what was varied; first: {x, y, colour}; logarithmic: names of columns; frame(explorer) may know better
   *  axes, decorate(explorer, axes) has more lines, details(panel, row, explorer) says what a row is; rows that fades(row, explorer)
   *  are grey. */
  constructor(parent, table, {axes, first, frame, fades, decorate, details, status, logarithmic = []}) {
    Object.assign(this, {parent, rows: table.rows, axes, logarithmic, frame, fades, decorate, details, columns: columnsOf(table.columns), filters: {}, selected: null});
    this.statusName = status;
    this.index = this.columns.get('index');
    const numeric = [...this.columns.values()].filter(column => column.different().length > 1 || axes.includes(column.name));
    const usable = numeric.filter(column => !(column.isText && column.texts.length > 60 && !axes.includes(column.name)));
    const options = usable.map(column => [column.name, withUnit(column.title, column.unit)]);
    const pick = wanted => wanted.find(name => usable.some(column => column.name === name)) ?? usable[0]?.name;
    this.x = pick(first.x);
    this.y = pick(first.y);
    this.colour = first.colour.length ? pick(first.colour) : '';
    const choose = key => value => { this[key] = value; this.update(); };
    this.controls = el('div', {class: 'controls'}, chooser('Across', options, this.x, choose('x')), chooser('Up', options, this.y, choose('y')),
      chooser('Colour', [['', 'none'], ...options], this.colour, choose('colour')));
    this.filterBox = el('div', {class: 'controls'});
    this.caption = el('figcaption');
    this.box = el('figure', {}, this.caption);
    this.panel = el('section', {class: 'details', 'aria-live': 'polite', hidden: true});
    parent.append(this.controls, this.filterBox, this.box, this.panel);
    this.update();
  }
  column(key) { return this.columns.get(this[key]); }
  isAxis(key) { return this.axes.includes(this[key]); }
  /** Sorts out how to show what was chosen. */
  update() {
    const others = this.axes.filter(name => ![this.x, this.y, this.colour].includes(name) && this.columns.get(name)?.different().length > 1);
    this.showFilters(others);
    const filters = others.filter(name => this.filters[name] !== undefined && this.filters[name] !== '');
    const x = this.column('x').numbers(), y = this.column('y').numbers(), list = [];
    for (let row = 0; row < this.rows; ++row)
      if (isFinite(x[row]) && isFinite(y[row]) && filters.every(name => this.columns.get(name).number(row) === Number(this.filters[name]))) list.push(row);
    this.list = list;
    this.cells = this.isAxis('x') && this.isAxis('y') && this.x !== this.y ? this.cellsOf(x, y) : null;
    this.lines = !this.cells && this.isAxis('x') && !this.isAxis('y') && (!this.colour || this.isAxis('colour')) ? this.linesOf() : null;
    this.order = [...list].sort((a, b) => x[a] - x[b] || y[a] - y[b]);
    this.place = new Map(this.order.map((row, i) => [row, i]));
    const what = this.cells ? 'a map' : this.lines ? 'lines' : 'dots';
    this.caption.replaceChildren(el('b', {}, list.length < this.rows ? `${list.length.toLocaleString('en')} of ${plural(this.rows, NOUN)}, ${what}.` : `${plural(list.length, NOUN)}, ${what}.`),
      list.length < this.rows && !filters.length ? ' The others have no such number.' : '', ' Point at one for its numbers, click for its details; arrow keys go from one to the next.');
    const status = this.columns.get(this.statusName);
    this.isOpen = this.axes.length && status && this.colour !== this.statusName ? row => ![null, 'finished'].includes(status.value(row)) : () => false;
    if (list.some(this.isOpen)) this.caption.append(' Crossed out: did not finish.');
    if (this.chart) this.chart.redraw();
    else this.chart = new Picture(this.box, {height: 520, label: 'map of all points', keys: event => this.keys(event), axes: () => this.axesNow = this.axesOf(), colours: () => this.colours(), legend: () => this.legend(),
      lines: () => this.linesNow(), paint: (c, chart) => this.paint(c, chart), overlay: (c, chart) => this.mark(c, chart),
      find: (x, y, chart) => { const row = this.find(x, y, chart); return row === null ? null : this.tipOf(row, chart); },
      press: (x, y, chart) => { const row = this.find(x, y, chart); if (row !== null) this.select(row); }});
  }
  showFilters(names) {
    for (const name of names) if (this.filters[name] === undefined) this.filters[name] = this.isAxis('x') && this.isAxis('y') ? String(this.columns.get(name).different()[0]) : '';
    this.filterBox.replaceChildren(...names.filter(name => this.columns.get(name).different().length < 500).map(name => {
      const column = this.columns.get(name);
      return chooser(shortName(name), [['', 'all'], ...column.different().map(value => [String(value), column.isText ? column.texts[value] : show(value)])],
        this.filters[name], value => { this.filters[name] = value; this.update(); });
    }));
  }
  /** A row for each pair of values, if that is a grid: {xs, ys, rows}. */
  cellsOf(x, y) {
    const xs = this.column('x').different(), ys = this.column('y').different();
    if (xs.length < 2 || ys.length < 2 || xs.length * ys.length > 4 * this.list.length) return null;
    const xIndex = new Map(xs.map((value, i) => [value, i])), yIndex = new Map(ys.map((value, i) => [value, i]));
    const rows = new Int32Array(xs.length * ys.length).fill(-1);
    for (const row of this.list) {
      const cell = yIndex.get(y[row]) * xs.length + xIndex.get(x[row]);
      if (rows[cell] < 0) rows[cell] = row;
    }
    return {xs, ys, rows};
  }
  /** Rows that differ in x only, in its order. */
  linesOf() {
    const x = this.column('x').numbers(), others = this.axes.filter(name => name !== this.x && this.columns.has(name)).map(name => this.columns.get(name)), groups = new Map();
    for (const row of this.list) {
      const key = others.map(column => column.number(row)).join();
      groups.set(key, [...(groups.get(key) ?? []), row]);
    }
    if (groups.size > 200 || groups.size > this.list.length / 2) return null;
    return [...groups.values()].map(rows => rows.sort((a, b) => x[a] - x[b]));
  }
  /** Lines and dots of a few kinds have a colour each. */
  isFew(column) { return !this.cells && column.different().length <= 7; }
  hasFewColours(column) { return column.isText || this.isFew(column); }
  /** Texts with their colours. */
  legend() {
    const column = this.column('colour');
    if (!column || !this.hasFewColours(column)) return [];
    if (!column.isText) return [[withUnit(column.title, column.unit) + ':', 'transparent'], ...column.different().map((value, i) => [show(value, 4), series(i)])];
    const counts = column.texts.map(() => 0);
    for (const row of this.list) if (isFinite(column.number(row))) ++counts[column.number(row)];
    return column.texts.map((text, i) => [`${fitted(text, 400)} (${counts[i]})`, this.colourOf(i)]).filter((_, i) => counts[i] > 0);
  }
  /** How rows are coloured: {scale, title} of a colour bar, if there is one. */
  colours() {
    const column = this.column('colour');
    if (!column) { this.css = () => series(0); return; }
    if (this.hasFewColours(column)) {
      const inks = new Map(), others = column.isText && column.texts.filter(text => !GOOD.includes(text)), hues = ['c2', 'c1', 'c4', 'c5', 'c6', 'c7'];
      this.colourOf = !column.isText ? x => series(column.different().indexOf(x)) : i => ink(GOOD.includes(column.texts[i]) ? 'c3' : hues[others.indexOf(column.texts[i]) % hues.length]);
      this.css = row => { const x = column.number(row); return inks.get(x) ?? inks.set(x, isFinite(x) ? this.colourOf(x) : ink('unknown')).get(x); };
      return;
    }
    // What points that did not finish have reached is no result, and must not spread the scale.
    const ended = this.list.filter(row => !this.isOpen(row)), values = (ended.length ? ended : this.list).map(row => column.number(row)), [low, high] = range(values);
    const log = low > 0 && high / low > 1000, scale = colourScale(low, high, {log}), unknown = ink('unknown');
    this.css = row => ended.length && this.isOpen(row) ? unknown : scale.css(column.number(row));
    const grey = [values.some(value => !isFinite(value)) && 'not known', ended.length < this.list.length && 'not finished'].filter(Boolean);
    return {scale, title: withUnit(column.title, column.unit) + (grey.length ? ` (grey: ${grey.join(' or ')})` : '')};
  }
  axesOf() {
    const axis = key => {
      const column = this.column(key), title = withUnit(column.title, column.unit);
      if (column.isText) return {texts: column.texts, title, reverse: key === 'y'};
      const [low, high] = range(this.list.map(row => column.number(row)));
      const list = column.different(), n = list.length - 1, step = Math.log(list[n] / list[0]) / n;
      const geometric = n > 1 && list.every((value, i) => i === 0 || Math.abs(Math.log(value / list[i - 1]) / step - 1) < 0.01);
      const log = low > 0 && high / low > 2.5 && (geometric || high / low > 1000 || this.logarithmic.includes(column.name));
      const part = this.cells ? 0.5 / (key === 'x' ? this.cells.xs : this.cells.ys).length : 0.04;
      return {...padded([low, high], log, part), title};
    };
    const axes = {x: axis('x'), y: axis('y')};
    return {...axes, ...this.frame?.(this, axes)};
  }
  /** The pixels at which the cells of sorted values meet. */
  edges(values, scale) {
    const p = values.map(scale), list = [p[0] - (p[1] - p[0]) / 2];
    for (let i = 1; i < p.length; ++i) list.push((p[i - 1] + p[i]) / 2);
    return [...list, p[p.length - 1] + (p[p.length - 1] - p[p.length - 2]) / 2];
  }
  linesNow() {
    const [x, y] = ['x', 'y'].map(key => this.column(key).numbers()), closed = (this.lines ?? []).map(rows => rows.filter(row => !this.isOpen(row))).filter(rows => rows.length);
    return [...closed.map(rows => lineOf('', rows.map(row => x[row]), rows.map(row => y[row]), this.css(rows[0]))), ...(!this.cells && this.decorate?.(this, this.axesNow) || [])];
  }
  paint(c, chart) {
    const x = this.column('x').numbers(), y = this.column('y').numbers(), size = this.list.length > 5000 ? 2 : this.list.length > 300 ? 5 : 7, grey = ink('unknown');
    if (this.cells) {
      const {xs, ys, rows} = this.cells, px = this.edges(xs, value => chart.x(value)), py = this.edges(ys, value => chart.y(value));
      for (let j = 0; j < ys.length; ++j)
        for (let i = 0; i < xs.length; ++i) {
          const row = rows[j * xs.length + i];
          if (row < 0) continue;
          c.fillStyle = this.css(row);
          c.fillRect(px[i], py[j + 1], px[i + 1] - px[i] + 0.6, py[j] - py[j + 1] + 0.6);
        }
    } else for (const row of this.list) {
      c.fillStyle = this.fades?.(row, this) ? grey : this.css(row);
      const px = chart.x(x[row]), py = chart.y(y[row]);
      if (size < 5) c.fillRect(px - size / 2, py - size / 2, size, size);
      else { c.beginPath(); c.arc(px, py, size / 2, 0, 7); c.fill(); }
    }
    for (const row of this.list.filter(this.isOpen)) this.cross(c, chart.x(x[row]), chart.y(y[row]));
    if (this.lines) this.errorBars(c, chart, x, y);
  }
  cross(c, x, y) {
    const r = this.list.length > 3000 ? 1.5 : 4;
    c.strokeStyle = ink('ink');
    c.lineWidth = 1;
    c.beginPath(); c.moveTo(x - r, y - r); c.lineTo(x + r, y + r); c.moveTo(x - r, y + r); c.lineTo(x + r, y - r); c.stroke();
  }
  errorBars(c, chart, x, y) {
    const bounds = this.columns.get(boundKey(this.y));
    if (!bounds || this.list.length > 500) return;
    for (const row of this.list) {
      const px = chart.x(x[row]), bound = bounds.number(row), top = chart.y(y[row] + bound);
      c.fillStyle = this.css(row);
      if (isFinite(bound) && !this.isOpen(row)) c.fillRect(px - 0.5, top, 1, chart.y(y[row] - bound) - top);
    }
  }
  /** The row at a pixel. */
  find(px, py, chart) {
    if (this.cells) {
      const {xs, ys, rows} = this.cells, ex = this.edges(xs, value => chart.x(value)), ey = this.edges(ys, value => chart.y(value));
      const i = ex.findIndex(edge => px < edge) - 1, j = ey.findIndex(edge => py > edge) - 1;
      return i >= 0 && j >= 0 && rows[j * xs.length + i] >= 0 ? rows[j * xs.length + i] : null;
    }
    const x = this.column('x').numbers(), y = this.column('y').numbers();
    let best = null, nearest = 20 ** 2;
    for (const row of this.list) {
      const distance = (chart.x(x[row]) - px) ** 2 + (chart.y(y[row]) - py) ** 2;
      if (distance < nearest) [best, nearest] = [row, distance];
    }
    return best;
  }
  tipOf(row, chart) {
    this.hovered = row;
    return {x: chart.x(this.column('x').number(row)), y: chart.y(this.column('y').number(row)), words: this.words(row)};
  }
  mark(c, chart) {
    for (const [row, colour] of [[chart.getActiveElements().length ? this.hovered : null, 'soft'], [this.selected, 'ink']]) {
      if (row === null || row === undefined) continue;
      const px = chart.x(this.column('x').number(row)), py = chart.y(this.column('y').number(row));
      for (const [name, width] of [['paper', 4], [colour, 2]]) {
        c.strokeStyle = ink(name);
        c.lineWidth = width;
        c.beginPath(); c.arc(px, py, 7, 0, 7); c.stroke();
      }
    }
  }
  keys(event) {
    const move = {ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (!move || !this.order.length) return false;
    let row = this.selected !== null && this.place.has(this.selected) ? this.selected : null;
    if (row === null) row = this.order[0];
    else if (this.cells) {
      const {xs, ys, rows} = this.cells, i = xs.indexOf(this.column('x').number(row)) + move[0], j = ys.indexOf(this.column('y').number(row)) + move[1];
      if (i >= 0 && i < xs.length && j >= 0 && j < ys.length && rows[j * xs.length + i] >= 0) row = rows[j * xs.length + i];
    } else row = this.order[Math.max(0, Math.min(this.order.length - 1, this.place.get(row) + move[0] + move[1]))];
    this.select(row);
    this.chart.say(this.tipOf(row, this.chart));
    return true;
  }
  title(row) { return `${NOUN[0].toUpperCase()}${NOUN.slice(1)} ${this.index ? this.index.value(row) : row + 1}`; }
  /** The tip of a row. */
  words(row) {
    const names = [...new Set([...this.axes, this.x, this.y, this.colour])].filter(name => this.columns.has(name)).slice(0, 8);
    const status = this.columns.get(this.statusName)?.value(row), reason = this.columns.get('reason')?.value(row);
    return [this.title(row), ...names.map(name => {
      const column = this.columns.get(name), bound = this.columns.get(boundKey(name))?.value(row);
      return `${shortName(column.title)}: ${known(bound) ? showWith(column.value(row), bound) + ` ± ${show(bound, 2)} ${unitText(column.unit)}` : column.words(row)}`;
    }), status && status !== 'finished' && !names.includes(this.statusName) ? status + (reason ? ': ' + reason : '') : ''].filter(Boolean).join('\n');
  }
  select(row) {
    this.selected = row;
    this.chart.draw();
    const body = el('tbody');
    for (const column of this.columns.values()) {
      const value = column.value(row), bound = this.columns.get(boundKey(column.name))?.value(row);
      if (value === null || column === this.index || /^errors\.|^displacement_error\.total$/.test(column.name)) continue;
      body.append(el('tr', {}, el('td', {class: 'entry'}, ...brokenAtSlashes(column.title)), el('td', {class: column.isText ? '' : 'value'}, exactly(value, known(bound) ? showWith(value, bound) : show(value)), known(bound) ? ` ± ${show(bound, 2)}` : '',
        el('span', {class: 'unit'}, ' ' + unitText(column.unit))), el('td', {class: 'meaning wide-only'}, column.meaning)));
    }
    this.panel.hidden = false;
    this.panel.replaceChildren(el('h2', {}, this.title(row)));
    this.details?.(this.panel, row, this);
    this.panel.append(el('details', {}, el('summary', {}, 'All numbers of this row'), el('div', {class: 'scroll'}, el('table', {}, body))));
  }
}
