// Which status each stretch of the band has: the ground of plots over frequency.

/** Status, begin and end of each stretch. */
const stretches = data.stretches.map(([status, from, to]) => ({ status, from, to }));
// A single line has no width of its own.
if (stretches.length === 1 && stretches[0].from === stretches[0].to) Object.assign(stretches[0], { from: 0.98 * stretches[0].from, to: 1.02 * stretches[0].to });

/** The range of a frequency axis: the band with a little room. */
function bandRange(isLog) {
  const ends = [stretches[0].from, stretches.at(-1).to].map((f) => (isLog ? Math.log10(f) : f));
  const margin = 0.012 * (ends[1] - ends[0]);
  return [ends[0] - margin, ends[1] + margin];
}

/** The statuses that there are, in the order of the list. */
const present = data.statuses.map((_, k) => k).filter((k) => stretches.some(({ status }) => status === k) || (data.statuses[k].trust !== "not asked" && data.status.includes(k)));

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
