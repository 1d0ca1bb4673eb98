// The moving body, and its fields over body and time.

const FIELDS = {
  stretch: {name: 'stretch', symbol: 'w', unit: '1', middle: 1},
  active_stress: {name: 'active stress', symbol: 'm', unit: 'force', middle: 0},
  velocity: {name: 'velocity', symbol: 'v', unit: 'length/time', middle: 0},
  friction_force: {name: 'friction', symbol: 'f', unit: 'force/length', middle: 0},
};

/** The fields of a run on its grid of places and times, in its units. */
class Fields {
  constructor(run) {
    const {places, times, fields} = run.kymograph;
    this.length = run.length;
    this.places = places.map(s => s * run.length);
    this.times = times.map(t => t * run.end_time);
    this.end = this.times[this.times.length - 1];
    this.n = places.length;
    this.shown = Object.fromEntries(Object.entries(fields).map(([name, {shown}]) => [name, shown]));
    this.fields = Object.fromEntries(Object.entries(fields).map(([name, {step, values}]) =>
      [name, Float32Array.from(values, value => value === null ? NaN : value * step)]));
    if (this.fields.displacement)
      this.fields.position = this.fields.displacement.map((u, i) => u + this.places[i % this.n]);
  }
  /** The row before a time, and how far the time is on the way to the next one. */
  row(t) {
    let low = 0, high = this.times.length - 1;
    while (high - low > 1) { const mid = (low + high) >> 1; if (this.times[mid] <= t) low = mid; else high = mid; }
    const step = this.times[high] - this.times[low];
    return [low, step > 0 ? Math.max(0, Math.min(1, (t - this.times[low]) / step)) : 1];
  }
  /** A field along the body at a time. */
  along(name, t) {
    const all = this.fields[name], [row, part] = this.row(t), n = this.n, offset = row * n;
    const next = this.times.length > 1 ? n : 0;
    return Float64Array.from({length: n}, (_, i) => (1 - part) * all[offset + i] + part * all[offset + next + i]);
  }
  /** The middle of the body at each time, without what comes and goes within @p window. */
  centres(window) {
    const n = this.n, p = this.fields.position;
    const mean = this.times.map((_, j) => { let sum = 0; for (let i = 0; i < n; ++i) sum += p[j * n + i]; return sum / n; });
    return mean.map((_, j) => {
      let sum = 0, count = 0;
      mean.forEach((x, k) => { if (Math.abs(this.times[k] - this.times[j]) <= window / 2) { sum += x; ++count; } });
      return sum / count;
    });
  }
}

/** The time that all pictures of a run show; it can run. */
class Clock {
  constructor(end, pace) {
    Object.assign(this, {end, pace, speed: 1, listeners: [], running: false, t: 0.4 * Math.min(end, pace)});
  }
  set(t) {
    this.t = Math.max(0, Math.min(this.end, t));
    for (const listener of this.listeners) listener(this.t);
  }
  /** One pace takes 2.5 s. */
  toggle() {
    if (Clock.current && Clock.current !== this) Clock.current.running = false;
    Clock.current = this;
    this.running = !this.running;
    if (this.running && this.t >= this.end) this.t = 0;
    let last = null;
    const step = now => {
      if (!this.running) return;
      if (last !== null) this.t += (now - last) / 2500 * this.pace * this.speed;
      last = now;
      if (this.t >= this.end) this.running = false;
      this.set(this.t);
      if (this.running) requestAnimationFrame(step);
    };
    if (this.running) requestAnimationFrame(step);
    this.set(this.t);
  }
}

/** The body on its ground, from the side: its thickness is 1/stretch, so that its volume stays. */
class BodyPicture {
  constructor(parent, run, fields, clock, map) {
    Object.assign(this, {clock, map});
    this.use(run, fields);
    this.chart = new Picture(parent, {height: 210, label: 'the body on its ground', overlay: (c, chart) => this.paint(c, chart),
      axes: () => ({x: {low: this.centre() - this.span / 2, high: this.centre() + this.span / 2, bare: true, title: withUnit('place x on the ground', 'length')}, y: {low: 0, high: 1, hidden: true}})});
    clock.listeners.push(() => this.follows ? this.chart.redraw() : this.chart.draw());
  }
  centre() {
    const [row, part] = this.fields.row(this.clock.t), next = Math.min(row + 1, this.centres.length - 1);
    return this.follows ? (1 - part) * this.centres[row] + part * this.centres[next] : this.middle;
  }
  /** From now on it shows these. */
  use(run, fields) {
    Object.assign(this, {run, fields});
    const [low, high] = range(fields.fields.position), L = fields.length;
    this.follows = high - low > 2.6 * L;
    this.span = this.follows ? 1.9 * L : (high - low) * 1.08;
    this.middle = (low + high) / 2;
    this.least = range(fields.fields.stretch)[0];
    this.centres = fields.centres(this.clock.pace);
    this.reach = Math.max(...(fields.shown.friction_force ?? [0]).map(Math.abs));
    if (run.ground) this.ground = {x: run.ground.x, c: run.ground.factor.map(factor => factor ?? NaN)};
    this.chart?.redraw();
  }
  paint(c, chart) {
    const f = this.fields, t = this.clock.t, {field, scale} = this.map.chart.bar, {chartArea: {bottom, width}} = chart, ground = bottom - 34, px = x => chart.x(x);
    this.drawGround(c, px, ground, chart);
    const x = f.along('position', t), w = f.along('stretch', t), value = f.along(field, t);
    const base = Math.min(34, 0.075 * f.length / this.span * width, Math.max(12, 100 * this.least)), thick = w.map(stretch => Math.min(104, base / Math.max(stretch, 1e-3)));
    for (let i = 0; i + 1 < x.length; ++i) {
      c.fillStyle = scale.css((value[i] + value[i + 1]) / 2);
      c.beginPath();
      c.moveTo(px(x[i]) - 0.4, ground);
      c.lineTo(px(x[i]) - 0.4, ground - thick[i]);
      c.lineTo(px(x[i + 1]) + 0.4, ground - thick[i + 1]);
      c.lineTo(px(x[i + 1]) + 0.4, ground);
      c.fill();
    }
    this.drawOutline(c, x.map(px), thick, ground);
    this.drawArrows(c, x.map(px), ground);
    const middle = px(x.reduce((a, b) => a + b, 0) / x.length);
    c.fillStyle = ink('ink');
    c.beginPath(); c.moveTo(middle, ground + 1); c.lineTo(middle - 5, ground + 9); c.lineTo(middle + 5, ground + 9); c.fill();
  }
  /** The edge, lines at eighths of the body, and a dot at the head. */
  drawOutline(c, px, thick, ground) {
    const last = px.length - 1;
    c.strokeStyle = ink('ink');
    c.lineWidth = 1.2;
    c.beginPath();
    c.moveTo(px[0], ground);
    for (let i = 0; i <= last; ++i) c.lineTo(px[i], ground - thick[i]);
    c.lineTo(px[last], ground);
    c.stroke();
    c.globalAlpha = 0.3;
    for (let eighth = 1; eighth < 8; ++eighth) {
      const i = Math.round(eighth * last / 8);
      c.beginPath(); c.moveTo(px[i], ground); c.lineTo(px[i], ground - thick[i]); c.stroke();
    }
    c.globalAlpha = 1;
    c.fillStyle = ink('soft');
    c.textAlign = 'center';
    c.fillText('head', px[last], ground - thick[last] - 8);
  }
  drawGround(c, px, ground, {chartArea: {left, width}, scales}) {
    if (this.ground) {
      const {x, c: factor} = this.ground, [least, most] = range(factor);
      c.fillStyle = ink('soft');
      for (let i = 0; i + 1 < x.length; ++i) {
        c.globalAlpha = 0.08 + 0.5 * (factor[i] - least) / (most - least || 1);
        c.fillRect(px(x[i]), ground, px(x[i + 1]) - px(x[i]) + 0.5, 34);
      }
      c.globalAlpha = 1;
    } else { c.fillStyle = ink('raised'); c.fillRect(left, ground, width, 34); }
    c.fillStyle = ink('ink');
    c.fillRect(left, ground, width, 1.5);
    c.fillStyle = ink('soft');
    for (const {value} of scales.x.ticks) c.fillRect(px(value), ground, 1, 34);
  }
  /** What the ground does to the body. */
  drawArrows(c, px, ground) {
    if (!this.reach) return;
    const f = this.fields.along('friction_force', this.clock.t), y = ground + 21;
    c.strokeStyle = c.fillStyle = ink('accent');
    c.lineWidth = 1.6;
    for (let i = 0, step = Math.max(1, Math.round(px.length / 20)); i < px.length; i += step) {
      const size = -Math.max(-1, Math.min(1, f[i] / this.reach)) * 34, head = Math.sign(size) * Math.min(5, Math.abs(size));
      if (Math.abs(size) < 1) continue;
      c.beginPath(); c.moveTo(px[i], y); c.lineTo(px[i] + size, y); c.stroke();
      c.beginPath(); c.moveTo(px[i] + size + head, y); c.lineTo(px[i] + size, y - 3.5); c.lineTo(px[i] + size, y + 3.5); c.fill();
    }
  }
}

/** A field as colours over time and the body, or the ground on which it is. */
class KymographPicture {
  constructor(parent, fields, clock, colours) {
    Object.assign(this, {fields, clock, over: 's'});
    this.chart = new Picture(parent, {height: 430, label: 'kymograph', keys: event => this.keys(event), colours,
      axes: () => ({x: {...this.domain(), bare: true, title: withUnit(this.over === 's' ? 'place s on the body' : 'place x on the ground', 'length')},
                    y: {low: 0, high: this.fields.end, bare: true, title: withUnit('time t', 'time')}}),
      paint: (c, chart) => this.paint(c, chart),
      overlay: (c, {chartArea: {left, width}, scales: {y}}) => { c.fillStyle = ink('ink'); c.fillRect(left, y.getPixelForValue(clock.t) - 0.75, width, 1.5); },
      find: (x, y, chart) => { const words = this.words(...chart.inverse(x, y)); return words && {x, y, words}; },
      press: (x, y, chart) => clock.set(chart.inverse(x, y)[1])});
    clock.listeners.push(() => this.chart.draw());
  }
  domain() {
    if (this.over === 's') return {low: 0, high: this.fields.length};
    return padded(range(this.fields.fields.position), false, 0.03);
  }
  keys(event) {
    const step = {ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1}[event.key];
    if (step) this.clock.set(this.clock.t + step * this.clock.end / 100);
    return step;
  }
  /** The index of a place of the picture at a time, with its fraction; negative outside. */
  indexer(t) {
    const {n, length, fields} = this.fields;
    if (this.over === 's') return x => x < 0 || x > length ? -1 : x / length * (n - 1);
    const p = this.fields.along('position', t);
    return x => {
      if (x < p[0] || x > p[n - 1]) return -1;
      let low = 0, high = n - 1;
      while (high - low > 1) { const mid = (low + high) >> 1; if (p[mid] <= x) low = mid; else high = mid; }
      return low + (p[high] > p[low] ? (x - p[low]) / (p[high] - p[low]) : 0);
    };
  }
  paint(c, chart) {
    const {chartArea: {left, top, width, height}, currentDevicePixelRatio: ratio} = chart, {n} = this.fields, {field, scale} = chart.bar;
    const wide = Math.round(width * ratio), tall = Math.round(height * ratio), image = new ImageData(wide, tall), pixels = new Uint32Array(image.data.buffer);
    const x = Array.from({length: wide}, (_, i) => chart.inverse(left + (i + 0.5) / ratio, 0)[0]);
    for (let j = 0; j < tall; ++j) {
      const t = chart.inverse(0, top + (j + 0.5) / ratio)[1], values = this.fields.along(field, t), index = this.indexer(t);
      for (let i = 0; i < wide; ++i) {
        const at = index(x[i]);
        if (at < 0) continue;
        const k = Math.min(Math.floor(at), n - 2);
        pixels[j * wide + i] = scale.pixel(values[k] + (at - k) * (values[k + 1] - values[k]));
      }
    }
    const canvas = el('canvas', {width: wide, height: tall});
    canvas.getContext('2d').putImageData(image, 0, 0);
    c.drawImage(canvas, left, top, width, height);
  }
  words(x, t) {
    const at = t >= 0 && t <= this.fields.end ? this.indexer(t)(x) : -1;
    if (at < 0) return null;
    const i = Math.round(at), value = name => show(this.fields.along(name, t)[i], 3);
    return [`s = ${show(this.fields.places[i], 4)}, t = ${show(t, 4)}`, ...Object.entries(FIELDS).filter(([name]) => this.fields.fields[name])
      .map(([name, field]) => `${field.name} ${value(name)} ${unitText(field.unit)}`)].join('\n');
  }
}

/** Body and kymograph of a run, with what steers them: {right: where more may stand, use(run, fields): shows another run}. */
function showBody(parent, run, clock, fields) {
  const names = Object.keys(FIELDS).filter(name => fields.fields[name]);
  const top = figure('The body on its ground.', 'Its thickness is 1/stretch (constant volume). Arrows: friction of the ground on the body. ▲ centre of mass.');
  const two = el('div', {class: 'two'}), left = figure('Kymograph.', 'Click to go to a time.'), right = el('div');
  parent.append(top, two);
  two.append(left, right);
  let field = names[0];
  const map = new KymographPicture(left, fields, clock, () => {
    const {middle, name, symbol, unit} = FIELDS[field];
    return {field, scale: colourScale(...fields.shown[field], {middle}), title: withUnit(`${name} ${symbol}`, unit)};
  });
  const body = new BodyPicture(top, run, fields, clock, map);
  const slider = el('input', {type: 'range', min: 0, max: 1000, value: 0, 'aria-label': 'time', oninput: () => clock.set(slider.value / 1000 * fields.end)});
  const play = el('button', {class: 'play', type: 'button', onclick: () => clock.toggle()}, 'Play');
  const time = el('output');
  top.append(el('div', {class: 'controls'}, play, el('label', {class: 'grow'}, slider, time),
    chooser('Speed', [['0.25', '¼'], ['1', '1'], ['4', '4']], '1', value => { clock.speed = Number(value); }),
    chooser('Colour', names.map(name => [name, FIELDS[name].name]), field, name => { field = name; map.chart.redraw(); body.chart.draw(); })));
  left.append(el('div', {class: 'controls'}, chooser('Over', [['s', 'the body'], ['x', 'the ground']], 's', over => { map.over = over; map.chart.redraw(); })));
  clock.listeners.push(t => {
    slider.value = t / fields.end * 1000;
    time.textContent = `t = ${show(t, 4)}`;
    play.textContent = clock.running ? 'Pause' : 'Play';
  });
  clock.set(clock.t);
  const use = (other, otherFields) => {
    fields = map.fields = otherFields;
    Object.assign(clock, {end: fields.end, pace: other.pace ?? clock.pace});
    map.chart.redraw();
    body.use(other, fields);
    clock.set(clock.t);
  };
  return {right, use};
}
