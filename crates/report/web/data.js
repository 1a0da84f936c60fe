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

/** Significant digits without idle zeros; a dash where there is no number. */
function digits(value, count = 5) {
  if (value === null || value === undefined) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) {
    const [mantissa, exponent] = value.toExponential(count - 1).split("e");
    const raised = [...exponent.replace("+", "")].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("");
    return `${Number(mantissa)}·10${raised}`;
  }
  return String(Number(value.toPrecision(count)));
}

/** Whether a unit takes prefixes: MPa and psi take none. */
const takesPrefix = (unit) => unit === "Pa";

/** A value in a unit, with a prefix where it takes one. */
function inUnit(value, count = 5, unit = "") {
  if (value === null || value === undefined) return "–";
  if (!unit) return digits(value, count);
  if (!takesPrefix(unit)) return `${digits(value, count)} ${unit}`;
  const size = Math.abs(value);
  const [by, prefix] = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"]].find(([by]) => size >= by) ?? [1, ""];
  return `${digits(value / by, count)} ${prefix}${unit}`;
}

/** The same with two standard deviations, in one unit. */
function withBar(value, std, unit = "") {
  if (std === null || value === 0) return inUnit(value, 5, unit);
  if (!takesPrefix(unit)) return `${digits(value)} ± ${digits(2 * std, 2)}${unit && ` ${unit}`}`;
  const [shown, prefix] = inUnit(value, 5, unit).split(" ");
  return `${shown} ± ${digits((2 * std * Number(shown)) / value, 2)}${prefix ? ` ${prefix}` : ""}`;
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
