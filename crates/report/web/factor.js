// The identified value: over frequency, and among the candidates.

const isCurve = data.varies !== "frequency";
const FACTOR = names.unit ? `%{y:.4s}${names.unit}` : "%{y:.5~g}";
const PARTS = names.real ? ["storage"] : ["storage", "loss_factor"];
const factorAxis = () => ({ title: names.real ? "Value" : "Storage modulus E′", ...(names.unit && { tickformat: "~s", ticksuffix: names.unit }) });
const formatOf = (part) => (part === "storage" ? FACTOR : "%{y:.5~g}");
const AT = "<br>%{x:.6~g} Hz";

/** Values of a column at drawn rows with one of some statuses. */
function withStatus(part, wanted, from = data) {
  const values = from === data ? column(part) : from[part];
  const status = from.status;
  return data.drawn.map((row) => (wanted.includes(data.statuses[status[row]].name) ? (values?.[row] ?? null) : null));
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
function rangeOf(part, log) {
  const std = column(`${part}_std`);
  const values = [];
  const own = column(part) ?? [];
  const trusted = own.map((value, row) => (isCurve || statusOf(row).name === "ok" ? value : null));
  (hasAny(trusted) ? trusted : own).forEach((value, row) => {
    if (value === null) return;
    const half = 2 * (std?.[row] ?? 0);
    values.push(value - half, value + half);
  });
  for (const other of [data.nominal, data.truth]) values.push(...(other?.[part] ?? []).filter((value) => value !== null));
  const usable = values.filter((value) => !log || value > 0).map((value) => (log ? Math.log10(value) : value));
  if (usable.length === 0) return undefined;
  const [low, high] = usable.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
  const margin = 0.06 * (high - low || Math.abs(high) || 1);
  return [low - margin, high + margin];
}

const withBars = (part) => {
  const std = drawn(column(`${part}_std`));
  return std ? { error_y: { type: "data", array: std.map((value) => value && 2 * value), thickness: 1, width: 0 } } : {};
};

addPlot({
  id: "modulus",
  height: names.real ? 360 : 560,
  frequency: true,
  logs: names.real ? { yaxis: ["value", false] } : { yaxis: ["E′", false], yaxis2: ["η", false] },
  traces() {
    const x = drawn(data.frequency_hz);
    const made = [];
    PARTS.forEach((part, k) => {
      const axis = k === 0 ? "y" : "y2";
      const format = formatOf(part);
      const push = (trace) => made.push({ ...trace, yaxis: axis, legendgroup: trace.name, showlegend: k === 0 });
      const values = (name, y, shade, more) => hasAny(y) && push(dots(name, x, y, shade, format, more));
      if (data.nominal) push(line("nominal", x, drawn(data.nominal[part]), "nominal", format, { dash: "dash" }));
      if (isCurve) {
        if (data.free) values("each frequency by itself", withStatus(part, ["ok"], data.free), "free", { size: 4, opacity: 0.7 });
        const [y, std] = [drawn(column(part)), drawn(column(`${part}_std`))];
        if (y && std) made.push(band(x, y, std.map((value) => value === null ? null : 2 * value), "band", axis));
        if (data.truth) push(line("true", x, drawn(data.truth[part]), "truth", format));
        if (y) push(line(data.varies === "law" ? "law" : "smooth curve", x, y, "updated", format));
        return;
      }
      values("evidence only", withStatus(part, ["ill_conditioned", "diverged", "no_root"]), "evidence", { symbol: "x-thin-open", size: 5 });
      values("ambiguous", withStatus(part, ["ambiguous"]), "alternative", { symbol: "triangle-up", size: 6, ...withBars(part) });
      values("identified", withStatus(part, ["ok"]), "updated", withBars(part));
      if (data.truth) push(line("true", x, drawn(data.truth[part]), "truth", format));
    });
    return made;
  },
  layout() {
    if (names.real) return { xaxis: overFrequency(), yaxis: { ...factorAxis(), range: rangeOf("storage", this.log.yaxis) } };
    return {
      xaxis: overFrequency({ anchor: "y2" }),
      yaxis: { ...factorAxis(), domain: [0.53, 1], range: rangeOf("storage", this.log.yaxis) },
      yaxis2: { title: "Loss factor η", domain: [0, 0.47], range: rangeOf("loss_factor", this.log.yaxis2) },
    };
  },
});

addPlot({
  id: "candidates",
  height: names.real ? 360 : 560,
  frequency: true,
  logs: names.real ? { yaxis: ["value", false] } : { yaxis: ["E′", true], yaxis2: ["η", false] },
  extra: data.candidates.refused.frequency_hz.length ? "refused" : null,
  traces() {
    const made = [];
    PARTS.forEach((part, k) => {
      const push = (trace) => made.push({ ...trace, yaxis: k === 0 ? "y" : "y2", legendgroup: trace.name, showlegend: k === 0 });
      for (const [kind, name, shade, more] of [
        ...(this.shows ? [["refused", "refused", "no_root", { symbol: "x-thin-open" }]] : []),
        ["admissible", "other solutions", "evidence", {}],
        ["alternative", "cannot be excluded", "alternative", { symbol: "triangle-up", size: 6 }],
      ]) {
        const found = data.candidates[kind];
        if (found.frequency_hz.length) push(dots(name, found.frequency_hz, found[part], shade, formatOf(part) + AT, { size: 4, ...more }));
      }
      push({ ...line("chosen", drawn(data.frequency_hz), withStatus(part, ["ok", "ambiguous"]), "updated", formatOf(part) + AT), mode: "lines+markers", marker: { color: color("updated"), size: 4 } });
    });
    return made;
  },
  layout() {
    const first = { hovermode: "closest", xaxis: overFrequency(names.real ? {} : { anchor: "y2" }) };
    if (names.real) return { ...first, yaxis: factorAxis() };
    return { ...first, yaxis: { ...factorAxis(), domain: [0.53, 1] }, yaxis2: { title: "Loss factor η", domain: [0, 0.47] } };
  },
});
