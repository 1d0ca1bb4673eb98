// Axes, charts on canvases, and what moves above them.

/** Ticks at 1, 2, 5 times powers of ten; of logarithmic axes at powers of ten. */
function ticks(low, high, count, log) {
  const list = [];
  if (log) {
    const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9);
    if (last > first) {
      const step = Math.ceil((last - first + 1) / count), factors = last - first < 3 && count > 4 ? [1, 2, 5] : [1];
      for (let e = first - 1; e <= last; e += step) list.push(...factors.map(m => m * 10 ** e));
      return list.filter(x => x >= low * 0.999 && x <= high * 1.001);
    }
  }
  const raw = (high - low) / Math.max(count, 1), power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(m => m * power).find(s => s >= raw * 0.999);
  for (let i = Math.ceil(low / step - 1e-6); i <= Math.floor(high / step + 1e-6); ++i) list.push(i * step);
  return list;
}
const tickText = (x, log) => log && (x >= 99 || x < 0.05) && Math.abs(Math.log10(x) % 1) < 1e-9
  ? '10' + superscript(Math.round(Math.log10(x))) : show(x, 5);

/** A scale from numbers to pixels. */
function scaleOf(low, high, from, to, log) {
  const of = log ? Math.log10 : x => x, back = log ? x => 10 ** x : x => x;
  const a = of(low), b = of(high);
  const scale = x => from + (of(x) - a) / (b - a) * (to - from);
  scale.inverse = pixel => back(a + (pixel - from) / (to - from) * (b - a));
  return Object.assign(scale, {low, high, log});
}

/** What is drawn anew, in this order, when the colours of the page change: {box, draw}. */
let charts = [];
function redrawAll() {
  charts = charts.filter(({box}) => box.isConnected);
  for (const chart of charts) chart.draw();
}
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redrawAll);

/**
 * A canvas with axes, and a second one above it for what follows the pointer. paint(chart) draws within the axes,
 * overlay(chart) above; hover(x, y) in pixels says what the tip shows (nothing: none).
 */
class Chart {
  constructor(parent, options) {
    Object.assign(this, {height: 260, margin: {left: 58, right: 14, top: 8, bottom: 42}}, options);
    this.below = el('canvas', {role: 'img', 'aria-label': options.label});
    this.above = el('canvas', options.keys ? {tabindex: 0, role: 'application', 'aria-label': `${options.label}; arrow keys move`} : {'aria-hidden': 'true'});
    this.tip = el('div', {class: 'tip', hidden: true, role: options.keys ? 'status' : null});
    this.box = el('div', {class: 'chart', style: `height:${this.height}px`}, this.below, this.above, this.tip);
    parent.append(this.box);
    this.above.addEventListener('pointermove', event => this.point(event));
    this.above.addEventListener('pointerleave', () => { this.tip.hidden = true; this.left?.(); });
    this.above.addEventListener('click', event => this.press?.(event.offsetX, event.offsetY));
    if (options.keys) this.above.addEventListener('keydown', event => this.keys(event) && event.preventDefault());
    charts.push(this);
    new ResizeObserver(() => this.draw()).observe(this.box);
  }
  point(event) {
    const text = this.hover?.(event.offsetX, event.offsetY);
    if (text) this.say(text, event.offsetX, event.offsetY);
    else this.tip.hidden = true;
  }
  say(text, x, y) {
    this.tip.textContent = text;
    this.tip.hidden = false;
    this.tip.style.left = Math.max(0, Math.min(x + 14, this.width - this.tip.offsetWidth - 2)) + 'px';
    this.tip.style.top = (y + 18 + this.tip.offsetHeight > this.height ? Math.max(0, y - this.tip.offsetHeight - 10) : y + 18) + 'px';
  }
  size(canvas) {
    const ratio = devicePixelRatio || 1;
    canvas.width = Math.round(this.width * ratio);
    canvas.height = Math.round(this.height * ratio);
    const context = canvas.getContext('2d');
    context.scale(ratio, ratio);
    context.font = `12px ${getComputedStyle(document.body).fontFamily}`;
    return context;
  }
  draw() {
    this.width = this.box.clientWidth;
    if (this.width < 60) return;
    this.context = this.size(this.below);
    const m = this.margin, axes = this.axes?.();
    if (axes) { // long words and numbers need more room
      this.least ??= m.left;
      const widest = Math.max(0, ...this.ticksOf(axes.y, this.height - m.bottom - m.top, 36).map(([, text]) => this.context.measureText(text).width));
      m.left = Math.max(this.least, Math.min(widest + 32, 0.35 * this.width));
    }
    const inner = [m.left, this.width - m.right, this.height - m.bottom, m.top];
    if (axes) {
      const {x, y} = axes;
      this.x = scaleOf(x.low, x.high, inner[0], inner[1], x.log);
      this.y = scaleOf(y.low, y.high, inner[2], inner[3], y.log);
      if (!this.axesAbove) this.drawAxes(x, y);
      this.context.save();
      this.context.beginPath();
      this.context.rect(inner[0] - 1, inner[3] - 1, inner[1] - inner[0] + 2, inner[2] - inner[3] + 2);
      this.context.clip();
      this.paint(this);
      this.context.restore();
      if (this.axesAbove) this.drawAxes(x, y);
    } else this.paint(this);
    this.move();
  }
  /** Draws the upper canvas anew. */
  move() {
    if (!this.overlay || !this.width) return;
    this.top = this.size(this.above);
    this.overlay(this);
  }
  /** Place and text of the ticks of an axis that has so many pixels, and of these so many from one to the next. */
  ticksOf(axis, pixels, distance) {
    if (axis.texts) return axis.texts.map((text, i) => [i, text]).slice(0, 40);
    return ticks(axis.low, axis.high, Math.max(2, pixels / distance), axis.log).map(tick => [tick, tickText(tick, axis.log)]);
  }
  drawAxes(x, y) {
    const c = this.context, m = this.margin, right = this.width - m.right, bottom = this.height - m.bottom;
    c.strokeStyle = ink('grid');
    c.fillStyle = ink('soft');
    c.lineWidth = 1;
    const line = (...points) => { c.beginPath(); c.moveTo(points[0], points[1]); c.lineTo(points[2], points[3]); c.stroke(); };
    c.textAlign = 'center';
    let end = -Infinity;
    for (const [tick, text] of this.ticksOf(x, right - m.left, 90)) {
      const p = Math.round(this.x(tick)) + 0.5, half = c.measureText(text).width / 2;
      line(p, this.axesAbove ? bottom : m.top, p, bottom + 4);
      const at = Math.min(Math.max(p, half + 2), this.width - half - 2);
      if (at - half < end + 6) continue;
      c.fillText(text, at, bottom + 17);
      end = at + half;
    }
    c.textAlign = 'right';
    for (const [tick, text] of this.ticksOf(y, bottom - m.top, 36)) {
      const p = Math.round(this.y(tick)) + 0.5;
      line(m.left - 4, p, this.axesAbove ? m.left : right, p);
      c.fillText(clipped(c, text, m.left - 28), m.left - 8, p + 4);
    }
    c.fillStyle = ink('ink');
    c.textAlign = 'center';
    const fits = (text, width) => c.measureText(text).width <= width ? text : clipped(c, shortName(text), width); // of a path the last word
    c.fillText(fits(x.title, right - m.left + 12), (m.left + right) / 2, this.height - 4);
    c.save();
    c.translate(12, (m.top + bottom) / 2);
    c.rotate(-Math.PI / 2);
    c.fillText(fits(y.title, bottom - m.top + 20), 0, 0);
    c.restore();
  }
  /** A line through points, with gaps where a number is not known. */
  polyline(xs, ys, colour, {width = 1.6, steps = false} = {}) {
    const c = this.context;
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.lineJoin = 'round';
    c.beginPath();
    let pen = false, last = 0;
    for (let i = 0; i < xs.length; ++i) {
      const px = this.x(xs[i]), py = this.y(ys[i]);
      if (!isFinite(px) || !isFinite(py)) { pen = false; continue; }
      if (pen && steps) c.lineTo(px, last);
      if (pen) c.lineTo(px, py); else c.moveTo(px, py);
      pen = true;
      last = py;
    }
    c.stroke();
  }
}

function clipped(context, text, width) {
  if (context.measureText(text).width <= width) return text;
  while (text.length > 1 && context.measureText(text + '…').width > width) text = text.slice(0, -1);
  return text + '…';
}

/** A legend of colours that follow the page's. */
function legend(parent, entries) {
  parent.append(el('div', {class: 'legend'}, ...entries.map(([name, colour]) =>
    el('span', {}, el('i', {style: `background:${colour}`}), name))));
}

/** A colour bar with its name, low and high. */
class ColourBar {
  constructor(parent, left) {
    this.chart = new Chart(parent, {height: 50, label: 'colour bar', margin: {left, right: 15, top: 0, bottom: 34}, axesAbove: true,
      axes: () => ({x: {low: this.scale.low, high: this.scale.high, log: this.scale.log, title: this.title, texts: this.texts}, y: {low: 0, high: 1, texts: [], title: ''}}),
      paint: chart => {
        const from = chart.x(this.scale.low), width = (chart.x(this.scale.high) - from) / 256;
        this.scale.list.forEach((colour, i) => { chart.context.fillStyle = `rgb(${colour.join()})`; chart.context.fillRect(from + i * width, 6, width + 1, 10); });
      }});
  }
  set(scale, title) {
    Object.assign(this, {scale, title});
    this.chart.draw();
  }
}

/** Low and high of an axis with some room. */
function padded([low, high], log = false, part = 0.05) {
  if (log) { const room = Math.max((high / low) ** part, 1.05); return {low: low / room, high: high * room, log}; }
  const room = (high - low) * part || Math.abs(high) * 0.1 || 1;
  return {low: low - room, high: high + room, log};
}

const chooser = (name, options, value, change) => el('label', {}, name,
  el('select', {onchange: event => change(event.target.value)},
    ...options.map(([key, text]) => el('option', {value: key, selected: key === value}, text))));

const figure = (title, text, ...children) => el('figure', {}, el('figcaption', {}, el('b', {}, title), text ? ' ' + text : ''), ...children);
