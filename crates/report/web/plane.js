// Plots in which frequency runs along the curve.

const hertz = (frequency) => `<br>${digits(frequency, 7)} Hz`;

addPlot({
  id: "nyquist",
  height: 480,
  extra: "nominal",
  traces() {
    const hover = { customdata: sensor.frequency_hz };
    const format = (y, x, k) => `${digits(x, 4)} + i·${digits(y, 4)} m/(s²·N)${hertz(sensor.frequency_hz[k])}`;
    const made = [];
    if (sensor.nominal && this.shows) made.push(line("nominal", sensor.nominal.re, sensor.nominal.im, "nominal", format, { dash: "dash", ...hover }));
    if (sensor.measured) made.push(dots("measured", sensor.measured.re, sensor.measured.im, "measured", format, { size: 4, ...hover }));
    if (sensor.updated) made.push(line("updated", sensor.updated.re, sensor.updated.im, "updated", format, { ...hover, ...marksOfLonePoints(sensor.updated.re, "updated") }));
    return made;
  },
  layout: () => ({ xaxis: { title: "Real part (m/(s²·N))", constrain: "domain" }, yaxis: { title: "Imaginary part (m/(s²·N))", scaleanchor: "x" } }),
  at(frequency) {
    const k = nearest(sensor.frequency_hz, frequency);
    const on = [sensor.updated, sensor.measured].find((response) => response && response.re[k] !== null);
    return on ? { x: on.re[k], y: on.im[k] } : null;
  },
});

/** Storage modulus of an unknown and another quantity made of it and the loss factor, at drawn rows with an answer. */
function along(one, other) {
  const made = [];
  const points = (name, storage, loss, rows, shade, draw, more) => {
    const there = rows.filter((row) => storage[row] !== null && loss[row] !== null);
    if (!there.length) return;
    const format = (y, x, k) => `E′ ${inUnit(x, 5, one.unit)}, ${other.label(y, one)}${hertz(data.frequency_hz[there[k]])}`;
    made.push(draw(name, there.map((row) => storage[row]), there.map((row) => other.of(storage[row], loss[row])), shade, format, { customdata: there.map((row) => data.frequency_hz[row]), ...more }));
  };
  const [storage, loss] = [partOf(one, "storage"), partOf(one, "loss_factor")];
  if (one.nominal) points("nominal", one.nominal.storage, one.nominal.loss_factor, data.drawn, "nominal", line, { dash: "dash" });
  if (one.reference) points("true", one.reference.storage, one.reference.loss_factor, data.drawn, "reference", line);
  const trusted = data.drawn.filter(isTrusted);
  const isCurve = one.varies !== "frequency";
  if (storage && loss) points(isCurve ? "law or curve" : "identified", storage, loss, trusted, "updated", isCurve ? line : dots);
  return made;
}

const onFactor = (one, other) => (_, row) => {
  const [e, eta] = [partOf(one, "storage")?.[row], partOf(one, "loss_factor")?.[row]];
  return Number.isFinite(e) && Number.isFinite(eta) ? { x: e, y: other.of(e, eta) } : null;
};

const LOSS_MODULUS = { of: (e, eta) => e * eta, label: (y, { unit }) => `E″ ${inUnit(y, 5, unit)}` };
const LOSS_FACTOR = { of: (_, eta) => eta, label: (y) => `η ${digits(y, 4)}` };

for (const one of unknowns) {
  addPlot({
    id: `cole-cole${one.suffix}`,
    height: 420,
    logs: { xaxis: ["E′", false], yaxis: ["E″", false] },
    traces: () => along(one, LOSS_MODULUS),
    layout: () => ({ xaxis: factorAxis(one), yaxis: { title: titled("Loss modulus E″", one.unit) } }),
    at: onFactor(one, LOSS_MODULUS),
  });
  addPlot({
    id: `wicket${one.suffix}`,
    height: 420,
    logs: { xaxis: ["E′", true], yaxis: ["η", true] },
    traces: () => along(one, LOSS_FACTOR),
    layout: () => ({ xaxis: factorAxis(one), yaxis: { title: "Loss factor η" } }),
    at: onFactor(one, LOSS_FACTOR),
  });
}
