// The identified value: over frequency, and among the candidates.

const partsOf = ({ real }) => (real ? ["storage"] : ["storage", "loss_factor"]);
/** A title with its unit. */
const titled = (title, unit) => (unit ? `${title} (${unit})` : title);
const factorAxis = ({ real, unit }) => ({ title: titled(real ? "Value" : "Storage modulus E′", unit) });
const labelOf = (part, { unit }) => (y) => inUnit(y, 5, part === "storage" ? unit : "");
/** The same with the frequency, where the pointer shows one point. */
const labelAt = (part, one) => (y, x) => `${labelOf(part, one)(y)}<br>${digits(x, 7)} Hz`;

/** A part of an unknown, by row. */
const partOf = (one, part) => column(one.columns[part]);

/** Values at drawn rows that are good for one of some things. */
function withTrust(values, wanted, status = data.status) {
  return data.drawn.map((row) => (wanted.includes(data.statuses[status[row]].trust) ? (values?.[row] ?? null) : null));
}

const hasAny = (values) => values.some((value) => value !== null);

/** A filled band of so much about a curve, a polygon for each stretch without a gap. */
function band(x, y, half, shade, axis) {
  const [px, py] = [[], []];
  let start = 0;
  const close = (end) => {
    if (end - start > 1) {
      for (let k = start; k < end; k++) (px.push(x[k]), py.push(y[k] + half[k]));
      for (let k = end - 1; k >= start; k--) (px.push(x[k]), py.push(y[k] - half[k]));
      px.push(null);
      py.push(null);
    }
  };
  for (let k = 0; k <= x.length; k++) {
    if (k < x.length && y[k] !== null && half[k] !== null) continue;
    close(k);
    start = k + 1;
  }
  return { type: "scatter", mode: "lines", x: px, y: py, yaxis: axis, fill: "toself", fillcolor: color(shade), line: { width: 0 }, hoverinfo: "skip", name: "± 2 standard deviations", showlegend: axis === "y", legendgroup: "band", meta: { band: true } };
}

/** Least and greatest of what is trusted or given, with its bars, as an axis takes it: evidence may be anywhere. */
function rangeOf(one, part, log) {
  const std = partOf(one, `${part}_std`);
  const values = [];
  const own = partOf(one, part) ?? [];
  const trusted = own.map((value, row) => (one.varies !== "frequency" || isTrusted(row) ? value : null));
  (hasAny(trusted) ? trusted : own).forEach((value, row) => {
    if (value === null) return;
    const half = 2 * (std?.[row] ?? 0);
    values.push(value - half, value + half);
  });
  for (const other of [one.nominal, one.reference]) values.push(...(other?.[part] ?? []).filter((value) => value !== null));
  const usable = values.filter((value) => !log || value > 0).map((value) => (log ? Math.log10(value) : value));
  if (usable.length === 0) return undefined;
  const [low, high] = usable.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
  const margin = 0.06 * (high - low || Math.abs(high) || 1);
  return [low - margin, high + margin];
}

const withBars = (one, part) => {
  const std = drawn(partOf(one, `${part}_std`));
  return std ? { error_y: { type: "data", array: std.map((value) => value && 2 * value), thickness: 1, width: 0 } } : {};
};

/** Value and loss factor of an unknown over frequency. */
const addFactor = (one) => addPlot({
  id: `modulus${one.suffix}`,
  height: one.real ? 360 : 560,
  frequency: true,
  logs: one.real ? { yaxis: ["value", false] } : { yaxis: ["E′", false], yaxis2: ["η", false] },
  traces() {
    const x = drawn(data.frequency_hz);
    const made = [];
    partsOf(one).forEach((part, k) => {
      const axis = k === 0 ? "y" : "y2";
      const format = labelOf(part, one);
      const own = partOf(one, part);
      const push = (trace) => made.push({ ...trace, yaxis: axis, legendgroup: trace.name, showlegend: k === 0 });
      const values = (name, y, shade, more) => hasAny(y) && push(dots(name, x, y, shade, format, more));
      if (one.nominal) push(line("nominal", x, drawn(one.nominal[part]), "nominal", format, { dash: "dash" }));
      if (one.varies !== "frequency") {
        if (one.free) values("each frequency alone", withTrust(one.free[part], ["trusted"], one.free.status), "free", { size: 4, opacity: 0.7 });
        const [y, std] = [drawn(own), drawn(partOf(one, `${part}_std`))];
        if (y && std) made.push(band(x, y, std.map((value) => value === null ? null : 2 * value), "band", axis));
        if (one.reference) push(line("true", x, drawn(one.reference[part]), "reference", format));
        if (y) push(line(one.varies === "law" ? "law" : "smooth curve", x, y, "updated", format));
        return;
      }
      values("not trusted", withTrust(own, ["evidence only"]), "evidence", { symbol: "x-thin-open", size: 5 });
      values("ambiguous", withTrust(own, ["ambiguous"]), "alternative", { symbol: "triangle-up", size: 6, ...withBars(one, part) });
      values("identified", withTrust(own, ["trusted"]), "updated", withBars(one, part));
      if (one.reference) push(line("true", x, drawn(one.reference[part]), "reference", format));
    });
    return made;
  },
  layout() {
    if (one.real) return { xaxis: overFrequency(), yaxis: { ...factorAxis(one), range: rangeOf(one, "storage", this.log.yaxis) } };
    return {
      xaxis: overFrequency({ anchor: "y2" }),
      yaxis: { ...factorAxis(one), domain: [0.53, 1], range: rangeOf(one, "storage", this.log.yaxis) },
      yaxis2: { title: "Loss factor η", domain: [0, 0.47], range: rangeOf(one, "loss_factor", this.log.yaxis2) },
    };
  },
});

/** Value and loss factor of all solutions of an unknown. */
const addCandidates = (one) => addPlot({
  id: `candidates${one.suffix}`,
  height: one.real ? 360 : 560,
  frequency: true,
  logs: one.real ? { yaxis: ["value", false] } : { yaxis: ["E′", true], yaxis2: ["η", false] },
  extra: one.candidates.refused.frequency_hz.length ? "refused" : null,
  traces() {
    const made = [];
    partsOf(one).forEach((part, k) => {
      const format = labelAt(part, one);
      const push = (trace) => made.push({ ...trace, yaxis: k === 0 ? "y" : "y2", legendgroup: trace.name, showlegend: k === 0 });
      for (const [kind, name, shade, more] of [
        ...(this.shows ? [["refused", "refused", "refused", { symbol: "x-thin-open" }]] : []),
        ["admissible", "other solutions", "evidence", {}],
        ["alternative", "cannot be excluded", "alternative", { symbol: "triangle-up", size: 6 }],
      ]) {
        const found = one.candidates[kind];
        if (found.frequency_hz.length) push(dots(name, found.frequency_hz, found[part], shade, format, { size: 4, ...more }));
      }
      push({ ...line("chosen", drawn(data.frequency_hz), withTrust(partOf(one, part), ["trusted", "ambiguous"]), "updated", format), mode: "lines+markers", marker: { color: color("updated"), size: 4 } });
    });
    return made;
  },
  layout() {
    const first = { hovermode: "closest", xaxis: overFrequency(one.real ? {} : { anchor: "y2" }) };
    if (one.real) return { ...first, yaxis: factorAxis(one) };
    return { ...first, yaxis: { ...factorAxis(one), domain: [0.53, 1] }, yaxis2: { title: "Loss factor η", domain: [0, 0.47] } };
  },
});
unknowns.forEach(addFactor);
unknowns.forEach(addCandidates);
