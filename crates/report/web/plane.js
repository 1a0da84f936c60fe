// Plots in which frequency runs along the curve.

const HERTZ = "<br>%{customdata:.6~g} Hz";

addPlot({
  id: "nyquist",
  height: 480,
  extra: "nominal",
  traces() {
    const told = { customdata: sensor.frequency_hz };
    const format = `%{x:.4~g} + %{y:.4~g}i m/(s²·N)${HERTZ}`;
    const made = [];
    if (sensor.nominal && this.shows) made.push(line("nominal", sensor.nominal.re, sensor.nominal.im, "nominal", format, { dash: "dash", ...told }));
    if (sensor.measured) made.push(dots("measured", sensor.measured.re, sensor.measured.im, "measured", format, { size: 4, ...told }));
    if (sensor.updated) made.push(line("updated", sensor.updated.re, sensor.updated.im, "updated", format, told));
    return made;
  },
  layout: () => ({ xaxis: { title: "Real part (m/(s²·N))", constrain: "domain" }, yaxis: { title: "Imaginary part", scaleanchor: "x" } }),
  at(frequency) {
    const k = nearest(sensor.frequency_hz, frequency);
    const on = [sensor.updated, sensor.measured].find((response) => response && response.re[k] !== null);
    return on ? { x: on.re[k], y: on.im[k] } : null;
  },
});

/** Storage modulus and another quantity made of it and the loss factor, at drawn rows with an answer. */
function along(other) {
  const made = [];
  const points = (name, storage, loss, rows, shade, draw, more) => {
    const there = rows.filter((row) => storage[row] !== null && loss[row] !== null);
    if (!there.length) return;
    const format = `E′ ${withUnit("x", names.unit)}, ${other.told}${HERTZ}`;
    made.push(draw(name, there.map((row) => storage[row]), there.map((row) => other.of(storage[row], loss[row])), shade, format, { customdata: there.map((row) => data.frequency_hz[row]), ...more }));
  };
  const [storage, loss] = [column("storage"), column("loss_factor")];
  if (data.nominal) points("nominal", data.nominal.storage, data.nominal.loss_factor, data.drawn, "nominal", line, { dash: "dash" });
  if (data.reference) points("true", data.reference.storage, data.reference.loss_factor, data.drawn, "reference", line);
  const trusted = data.drawn.filter((row) => statusOf(row).name === "ok");
  if (storage && loss) points(isCurve ? "law or curve" : "identified", storage, loss, trusted, "updated", isCurve ? line : dots);
  return made;
}

const onFactor = (other) => (_, row) => {
  const [e, eta] = [column("storage")?.[row], column("loss_factor")?.[row]];
  return Number.isFinite(e) && Number.isFinite(eta) ? { x: e, y: other.of(e, eta) } : null;
};

const LOSS_MODULUS = { of: (e, eta) => e * eta, told: `E″ ${withUnit("y", names.unit)}` };
const LOSS_FACTOR = { of: (_, eta) => eta, told: "η %{y:.4~g}" };

addPlot({
  id: "cole-cole",
  height: 420,
  logs: { xaxis: ["E′", false], yaxis: ["E″", false] },
  traces: () => along(LOSS_MODULUS),
  layout: () => ({ xaxis: factorAxis(), yaxis: { ...factorAxis(), title: `Loss modulus E″${names.unit && !takesPrefix(names.unit) ? ` (${names.unit})` : ""}` } }),
  at: onFactor(LOSS_MODULUS),
});

addPlot({
  id: "wicket",
  height: 420,
  logs: { xaxis: ["E′", true], yaxis: ["η", true] },
  traces: () => along(LOSS_FACTOR),
  layout: () => ({ xaxis: factorAxis(), yaxis: { title: "Loss factor η" } }),
  at: onFactor(LOSS_FACTOR),
});
