// What the page shows, and how numbers are written.

const data = JSON.parse(document.getElementById("data").textContent);
/** The unknowns that are curves over frequency, each with its columns. */
const { unknowns } = data;
const column = (name) => data.columns[name] ?? null;
const statusOf = (row) => data.statuses[data.status[row]];
const isTrusted = (row) => statusOf(row).trust === "trusted";

/** Values at the rows that are drawn. */
const drawn = (values) => values && data.drawn.map((row) => values[row]);

/** Text of users as Plotly takes it: it reads tags and entities. */
const plain = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");

const raised = (exponent) => [...String(exponent)].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("");
const minus = (text) => text.replace("-", "−");

/** Whether a number is written without a power of ten: from 0.001 to 99999. */
const isPlain = (value) => value === 0 || (Math.abs(value) >= 1e-3 && Math.abs(value) < 1e5);

/** Significant digits without idle zeros, as 0.25 or 2·10⁶; a dash where there is no number. */
function digits(value, count = 5) {
  if (value === null || value === undefined) return "–";
  const rounded = Number(value.toPrecision(count));
  if (isPlain(rounded)) return minus(String(rounded));
  const [mantissa, exponent] = rounded.toExponential().split("e");
  return `${minus(mantissa)}·10${raised(Number(exponent))}`;
}

/** A value in a unit. */
const inUnit = (value, count = 5, unit = "") => (value === null || value === undefined ? "–" : `${digits(value, count)}${unit && ` ${unit}`}`);

/** A number and its bar: the bar has two digits, and the number as many places. */
function barred(value, bar) {
  if (!(bar > 0)) return digits(value);
  const first = (x) => (x === 0 ? 0 : Math.floor(Math.log10(Math.abs(x))));
  const places = 1 - first(bar);
  if (places > 9 || places + first(value) > 6) return `${digits(value, 7)} ± ${digits(bar, 1)}`;
  return minus(`${value.toFixed(Math.max(0, places))} ± ${bar.toFixed(Math.max(0, places))}`);
}

/** The same with two standard deviations, both with one power of ten. */
function withBar(value, std, unit = "") {
  if (std === null || std === undefined || value === null) return inUnit(value, 5, unit);
  const after = unit && ` ${unit}`;
  if (isPlain(value)) return barred(value, 2 * std) + after;
  const exponent = Math.floor(Math.log10(Math.abs(value)));
  // A bar that is too small for the digits of the value has a power of its own.
  if (2 * std < 1e-5 * 10 ** exponent) return `${digits(value, 7)} ± ${digits(2 * std, 1)}${after}`;
  return `(${barred(value / 10 ** exponent, (2 * std) / 10 ** exponent)})·10${raised(exponent)}${after}`;
}

/** The row of ascending frequencies that is nearest. */
function nearest(frequencies, frequency) {
  let [low, high] = [0, frequencies.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (frequencies[middle] <= frequency) low = middle;
    else high = middle;
  }
  return Math.abs(frequencies[high] - frequency) < Math.abs(frequencies[low] - frequency) ? high : low;
}
