'use strict';
// What all parts of the page use: elements, numbers in words, columns of tables, colours.

const page = JSON.parse(document.getElementById('data').textContent);

/** An element; texts are never read as HTML. Attributes that begin with "on" are listeners. */
function el(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes))
    if (key.startsWith('on')) element.addEventListener(key.slice(2), value);
    else if (value === true) element.setAttribute(key, '');
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(key, value);
  element.append(...children.filter(child => child !== null && child !== undefined && child !== false));
  return element;
}

const chooser = (name, options, value, change) => el('label', {}, name,
  el('select', {onchange: event => change(event.target.value)},
    ...options.map(([key, text]) => el('option', {value: key, selected: key === value}, text))));

const figure = (title, text, ...children) => el('figure', {}, el('figcaption', {}, el('b', {}, title), text ? ' ' + text : ''), ...children);

const known = value => typeof value === 'number' && isFinite(value);
const plural = (n, word) => `${n.toLocaleString('en')} ${word}${n === 1 ? '' : 's'}`;

/** The value under a key with dots; null if it is not there. */
function at(object, key) {
  for (const word of key.split('.')) object = object?.[word];
  return object ?? null;
}

/** "force length" as people write it, with the user's units; nothing for the unit 1. */
const unitText = unit => !unit || unit === '1' ? ''
  : unit.replace(/ /g, '·').replace(/·per·.*/, ' per unit of the entry').replace(/[a-z]+/g, word => page.units?.[word] ?? word);
const withUnit = (name, unit) => unitText(unit) ? `${name} [${unitText(unit)}]` : name;
/** A unit behind a number in a sentence, if the user has named units. */
const unitBehind = unit => Object.entries(page.units ?? {}).some(([word, name]) => word !== name) ? ' ' + unitText(unit) : '';
/** The key of a number as a name. */
const nameOf = key => key.replace(/\.value$/, '').replace(/^errors\./, 'bound of ').replace(/_/g, ' ').replace(/\./g, ', ');
/** The last words of an entry's path. */
const shortName = path => path.split('/').pop();

const superscript = n => String(n).replace(/-/, '⁻').replace(/\d/g, d => '⁰¹²³⁴⁵⁶⁷⁸⁹'[d]);

/** A number with so many digits, 1.2 × 10⁻⁸ if it is very small or large. */
function show(value, digits = 6) {
  if (typeof value !== 'number') return value === null || value === undefined ? '–' : String(value);
  if (!isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e-4 && size < 1e7) {
    const text = size >= 10 ** digits ? value.toFixed(0) : value.toPrecision(digits);
    return (text.includes('.') ? text.replace(/\.?0+$/, '') : text).replace('-', '−');
  }
  const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
  return `${mantissa.replace(/\.?0+$/, '').replace('-', '−')} × 10${superscript(Number(exponent))}`;
}

/** As many digits as a bound of the error says, two of which are uncertain. */
function showWith(value, bound) {
  if (!known(value) || !known(bound) || bound <= 0 || value === 0) return show(value);
  const digits = Math.floor(Math.log10(Math.abs(value))) - Math.floor(Math.log10(bound)) + 2;
  return show(value, Math.min(15, Math.max(2, digits)));
}

/** Where the bound of a number is. */
const boundKey = key => ({displacement: 'displacement_error.total', 'inversion.t': 'inversion.error'})[key]
  ?? 'errors.' + key.replace(/\.value$/, '');

/** A path that may go on in the next line behind its slashes. */
const brokenAtSlashes = path => path.split(/(?<=\/)/).flatMap(word => [word, el('wbr')]);

/** A number that can be read exactly by programs, too. */
const exactly = (value, text) => known(value) ? el('data', {value: String(value)}, text ?? show(value)) : show(value);

/** A column of a table: its value in a row (a number or a text; null: not known). */
class Column {
  constructor({name, unit, meaning, values, codes}) {
    Object.assign(this, {name, unit, meaning, values, codes});
    this.isText = values.some(value => typeof value === 'string');
    if (this.isText) this.texts = values.filter(value => value !== null);
    this.length = (codes ?? values).length;
    this.title = nameOf(name);
  }
  value(row) { return this.values[this.codes ? this.codes[row] : row] ?? null; }
  /** For axes and colours: texts are counted. */
  number(row) {
    const value = this.value(row);
    return this.isText ? (value === null ? NaN : this.texts.indexOf(value)) : value ?? NaN;
  }
  numbers() {
    return this.cache ??= Float64Array.from({length: this.length}, (_, row) => this.number(row));
  }
  /** The different numbers, ascending. */
  different() {
    return this.sorted ??= [...new Set(this.numbers())].filter(isFinite).sort((a, b) => a - b);
  }
  words(row) {
    const value = this.value(row);
    return typeof value === 'number' ? `${show(value)} ${unitText(this.unit)}`.trim() : value ?? 'not known';
  }
}

/** Columns by their names. */
const columnsOf = list => new Map(list.map(column => [column.name, new Column(column)]));

// Colours -----------------------------------------------------------------------------------------------------------

/** A colour of the style sheet, as the page looks at present. */
const ink = name => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const rgb = text => [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16));
const series = i => ink('c' + (i % 7 + 1));
// Cividis, which looks the same to colour-blind readers.
const CIVIDIS = ['#00224e', '#123570', '#3b496c', '#575d6d', '#707173', '#8a8678', '#a59c74', '#c3b369', '#e1cc55', '#fee838'];

/** 256 colours of a part of the way through the given ones. */
function palette(colours, begin = 0, end = 1) {
  const stops = colours.map(rgb);
  return Array.from({length: 256}, (_, i) => {
    const x = (begin + i / 255 * (end - begin)) * (stops.length - 1), k = Math.min(Math.floor(x), stops.length - 2);
    return stops[k].map((from, c) => Math.round(from + (x - k) * (stops[k + 1][c] - from)));
  });
}

/** Colours of the numbers from low to high; those that lie on both sides of a middle have two hues, as
 * strong on one side as on the other. */
function colourScale(low, high, {middle = 0, log = false} = {}) {
  const diverges = middle !== null && low < middle && high > middle;
  const reach = Math.max(middle - low, high - middle), part = x => (1 + (x - middle) / reach) / 2;
  if (!(high > low)) [low, high] = [low - (Math.abs(low) || 1) / 2, high + (Math.abs(high) || 1) / 2];
  const of = log ? Math.log : x => x;
  const list = diverges ? palette([ink('low'), ink('middle'), ink('high')], part(low), part(high)) : palette(CIVIDIS);
  const unknown = rgb(ink('unknown'));
  const from = of(low), scale = 255 / (of(high) - from);
  const index = x => Math.max(0, Math.min(255, Math.round((of(x) - from) * scale)));
  const colour = x => isFinite(x) ? list[index(x)] : unknown;
  // The bytes of a pixel with one write.
  const words = new Uint32Array(new Uint8Array([...list, unknown].flatMap(([r, g, b]) => [r, g, b, 255])).buffer);
  const pixel = x => words[isFinite(x) ? index(x) : 256];
  return {low, high, log, list, colour, pixel, css: x => `rgb(${colour(x).join()})`};
}

function range(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values) if (isFinite(value)) { low = Math.min(low, value); high = Math.max(high, value); }
  return low > high ? [0, 1] : [low, high];
}
