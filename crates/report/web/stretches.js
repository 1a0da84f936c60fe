// Which status each stretch of the band has: the ground of plots over frequency.

/** Status, begin and end of each stretch; one that is too narrow to be seen belongs to its neighbour. */
const stretches = (() => {
  const { frequency_hz: f, status } = data;
  const last = f.length - 1;
  const narrow = (f[last] - f[0]) / 3000;
  // From half-way to the neighbour before to half-way to the one behind.
  const edge = (row) => (row === 0 ? f[0] : row > last ? f[last] : (f[row - 1] + f[row]) / 2);
  const made = [];
  let start = 0;
  for (let row = 1; row <= f.length; row++) {
    if (row < f.length && status[row] === status[start]) continue;
    const [from, to] = [edge(start), edge(row)];
    if (!made.length || to - made.at(-1).to > narrow) made.push({ status: status[start], from: made.at(-1)?.to ?? from, to });
    start = row;
  }
  // A single line has no width of its own.
  if (made.length === 1 && made[0].from === made[0].to) made[0] = { ...made[0], from: 0.98 * f[0], to: 1.02 * f[0] };
  return made;
})();

/** The range of a frequency axis: the band with a little room. */
function bandRange(isLog) {
  const ends = [stretches[0].from, stretches.at(-1).to].map((f) => (isLog ? Math.log10(f) : f));
  const margin = 0.012 * (ends[1] - ends[0]);
  return [ends[0] - margin, ends[1] + margin];
}

/** The statuses that there are, in the order of the list. */
const present = data.statuses.map((_, k) => k).filter((k) => data.status.includes(k));

/** Grounds of a panel with the axes of that name, a trace a status. */
function grounds(axis) {
  return present.map((k) => {
    const { name, label, pattern } = data.statuses[k];
    const own = stretches.filter(({ status }) => status === k);
    const x = own.flatMap(({ from, to }) => [from, from, to, to, null]);
    const y = own.flatMap(() => [0, 1, 1, 0, null]);
    return {
      type: "scatter", mode: "lines", name: label, x, y, yaxis: axis, fill: "toself", fillcolor: `${color(name)}26`, line: { width: 0 }, hoverinfo: "skip", showlegend: false, meta: { band: true },
      ...(pattern && { fillpattern: { shape: pattern, fillmode: "overlay", fgcolor: color(name), fgopacity: 0.55, size: pattern === "." ? 6 : 8, solidity: pattern === "." ? 0.18 : 0.1 } }),
    };
  });
}

/** What the grounds mean, as an element of the page. */
function legendOfGrounds() {
  const made = document.createElement("p");
  made.className = "grounds";
  made.append("Background: ");
  for (const k of present) {
    const entry = document.createElement("span");
    const swatch = document.createElement("span");
    swatch.className = `tint ${data.statuses[k].name}`;
    entry.append(swatch, data.statuses[k].label);
    made.append(entry);
  }
  return made;
}
