// Charts of Chart.js in the colours of the page, and what is painted over them.

/** Low and high of an axis with some room. */
function padded([low, high], log = false, part = 0.05) {
  if (log) { const room = Math.max((high / low) ** part, 1.05); return {low: low / room, high: high * room, log}; }
  const room = (high - low) * part || Math.abs(high) * 0.1 || 1;
  return {low: low - room, high: high + room, log};
}

/** Texts that have room in so many pixels: of a path the last word. */
function fitted(text, pixels) {
  const most = Math.max(4, Math.floor(pixels / 6.6)), short = text.length > most ? shortName(text) : text;
  return short.length > most ? short.slice(0, most - 1) + '…' : short;
}

const leadingDigits = x => Number((x / 10 ** Math.floor(Math.log10(x) + 1e-9)).toPrecision(6));
const tickText = (x, log) => log && (x >= 99 || x < 0.05) && leadingDigits(x) === 1 ? '10' + superscript(Math.round(Math.log10(x))) : show(x, 5);

/** An axis: from low to high, or with texts that are counted from 0; a bare one has no grid. */
function scaleOf(axis, {low, high, log, texts, title, hidden, bare, reverse, tickLength = 4}) {
  const decades = Math.log10(high / low), digits = decades < 1 ? [1, 2, 3, 4, 5, 6, 7, 8, 9] : decades < 3 ? [1, 2, 5] : [1];
  return {axis, display: !hidden, reverse, position: axis === 'x' ? 'bottom' : 'left', ...(texts ? {type: 'category', labels: texts, offset: true} : {type: log ? 'logarithmic' : 'linear', min: low, max: high}),
    grid: {drawBorder: false, drawOnChartArea: !bare, tickLength, color: tickLength === 4 ? ink('grid') : 'transparent'},
    title: {display: Boolean(title), color: ink('ink'), padding: 2, text: ({chart}) => fitted(title, axis === 'x' ? chart.width - 60 : chart.height - 30)},
    afterBuildTicks: own => { if (log) own.ticks = own.ticks.filter(({value}) => digits.includes(leadingDigits(value))); },
    afterFit: own => { if (axis === 'y' && !hidden) own.width = Math.max(own.width, 58); },
    ticks: {includeBounds: false, maxRotation: 0, autoSkipPadding: 24, callback(value) { return texts ? fitted(texts[value], axis === 'x' ? this.chart.width / texts.length : 160) : tickText(value, log); }}};
}

/** A line through points, with gaps where a number is not known. */
const lineOf = (label, xs, ys, colour, more) => ({label, data: Array.from(xs, (x, i) => ({x, y: ys[i]})), borderColor: colour, backgroundColor: colour, borderWidth: 1.6, pointRadius: 0, ...more});

// The tip says what find() knows of the place of the pointer, or numbers of the lines.
Chart.Interaction.modes.found = (chart, event) => chart.found(chart.own.find(event.x, event.y, chart));
Object.assign(Chart.defaults.plugins.tooltip, {caretSize: 6, caretPadding: 10, padding: 8, borderWidth: 1, boxWidth: 8, boxHeight: 8, boxPadding: 4, filter: ({chart, dataset}) => chart.own.find || dataset.label});
Object.assign(Chart.defaults.plugins.tooltip.callbacks, {
  title: ([item]) => item && (item.chart.own.find ? item.chart.words[0] : `${item.chart.own.axes().x.title}: ${show(item.parsed.x, 5)}`),
  label: ({chart, dataset, parsed}) => chart.own.find ? chart.words.slice(1) : `${dataset.label}: ${show(parsed.y, 6)}`});
Object.assign(Chart.defaults, {animation: false, parsing: false, maintainAspectRatio: false});

function recolour() {
  Object.assign(Chart.defaults, {color: ink('soft'), borderColor: ink('grid')});
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  Object.assign(Chart.defaults.plugins.tooltip, {backgroundColor: ink('paper'), borderColor: ink('line'), titleColor: ink('ink'), bodyColor: ink('ink'), multiKeyBackground: ink('paper')});
  for (const chart of Object.values(Chart.instances)) chart.redraw();
}
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', recolour);
recolour();

/**
 * A chart with axes() and lines(). Over these are paint(context, chart), which is kept until the next redraw(), and
 * overlay(context, chart). find(x, y, chart) says what is at a pixel, {x, y, words}; press(x, y, chart) follows a click;
 * colours() is {scale, title} of a colour bar, legend() has texts with colours.
 */
class Picture extends Chart {
  constructor(parent, own) {
    const {height = 260, type = 'line', keys} = own;
    for (const chart of Object.values(Chart.instances)) if (!chart.canvas.isConnected) chart.destroy();
    const canvas = el('canvas', keys ? {tabindex: 0, role: 'application', onkeydown: event => keys(event) && event.preventDefault()} : {role: 'img'});
    parent.append(el('div', {class: 'chart', style: `height:${height}px`}, canvas));
    const picture = {id: 'picture', afterUpdate: chart => { chart.image = null; }, afterDatasetsDraw: chart => chart.own && chart.paint()};
    super(canvas, {type, data: {datasets: []}, plugins: [picture]});
    this.own = own;
    this.redraw();
  }
  x(value) { return this.scales.x.getPixelForValue(value); }
  y(value) { return this.scales.y.getPixelForValue(value); }
  inverse(x, y) { return [this.scales.x.getValueForPixel(x), this.scales.y.getValueForPixel(y)]; }
  /** Draws everything anew. */
  redraw() {
    const {label, keys, axes, lines, find, press, legend, horizontal} = this.own, {x, y} = axes(), bar = this.bar = this.own.colours?.(), entries = legend?.();
    this.data.datasets = [...(find ? [{data: [{x: NaN, y: NaN}], pointRadius: 0, pointHoverRadius: 0}] : []), ...(lines?.() ?? [])];
    const names = entries?.map(([text]) => text) ?? this.data.datasets.map(({label}) => label).filter(Boolean);
    this.canvas.setAttribute('aria-label', `${[label, ...names].join(', ')}${keys ? '; arrow keys move' : ''}`);
    this.options = {indexAxis: horizontal ? 'y' : 'x', interaction: find ? {mode: 'found'} : {mode: 'nearest', axis: 'x', intersect: false}, onClick: event => press?.(event.x, event.y, this),
      scales: {x: scaleOf('x', x), y: scaleOf('y', y), ...(bar && {colour: scaleOf('x', {...bar.scale, title: bar.title, bare: true, tickLength: 16})})},
      plugins: {tooltip: {enabled: !horizontal, displayColors: !find, ...(find && {yAlign: ({tooltipItems: [item]}) => item?.element.y < 150 ? 'top' : 'bottom'})}, legend: {position: 'bottom', align: 'start', display: names.length > (entries ? 0 : 1),
        labels: {boxWidth: 12, boxHeight: 8, filter: ({text}) => text, ...(entries && {generateLabels: () => entries.map(([text, colour]) => ({text, fillStyle: colour, strokeStyle: colour}))})}, ...(entries && {onClick: null})}}};
    this.update();
  }
  paint() {
    const {own: {paint, overlay}, ctx, width, height, currentDevicePixelRatio: ratio, chartArea: area, scales: {colour}} = this;
    if (paint && !this.image && area.width > 0) {
      this.image = el('canvas', {width: ctx.canvas.width, height: ctx.canvas.height});
      const c = this.image.getContext('2d');
      c.scale(ratio, ratio);
      if (colour) this.bar.scale.list.forEach((one, i) => { c.fillStyle = `rgb(${one.join()})`; c.fillRect(colour.left + i * colour.width / 256, colour.top + 4, colour.width / 256 + 1, 10); });
      c.rect(area.left - 1, area.top - 1, area.width + 2, area.height + 2);
      c.clip();
      paint(c, this);
    }
    if (this.image) ctx.drawImage(this.image, 0, 0, width, height);
    ctx.font = `12px ${Chart.defaults.font.family}`;
    overlay?.(ctx, this);
  }
  /** The item of the library for what find() has found: its first point goes there. */
  found(one) {
    if (!one) return [];
    this.words = one.words.split('\n');
    return [{element: Object.assign(this.getDatasetMeta(0).data[0], {x: one.x, y: one.y, skip: false}), datasetIndex: 0, index: 0}];
  }
  /** Shows its tip. */
  say(one) {
    const items = this.found(one);
    this.setActiveElements(items);
    this.tooltip.setActiveElements(items, one);
    this.draw();
  }
}
