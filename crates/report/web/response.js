// What was measured, and what the model says.

const sensorChoice = document.getElementById("sensor");
let sensor = data.sensors[0];

const size = (response) => response && response.re.map((re, k) => (re === null ? null : Math.hypot(re, response.im[k])));

/** Phase in degrees, with a gap where it goes once around: [frequencies, degrees]. */
function phase(response) {
  const [x, y] = [[], []];
  response.re.forEach((re, k) => {
    const angle = re === null ? null : (Math.atan2(response.im[k], re) * 180) / Math.PI;
    const before = y.at(-1);
    if (angle !== null && before !== undefined && before !== null && Math.abs(angle - before) > 180) {
      x.push(sensor.frequency_hz[k]);
      y.push(null);
    }
    x.push(sensor.frequency_hz[k]);
    y.push(angle);
  });
  return [x, y];
}

/** Marks on a curve of which some points stand alone between lines that were left out. */
const marksOfLonePoints = (values, shade) => (values.some((value, k) => value !== null && (values[k - 1] ?? null) === null && (values[k + 1] ?? null) === null) ? { mode: "lines+markers", marker: { color: color(shade), size: 6, symbol: "diamond-open" } } : {});

const ACCELERANCE = (y) => `${digits(y, 4)} m/(s²·N)`;
const DEGREES = (y) => `${minus(y.toFixed(1))}°`;

addPlot({
  id: "accelerance",
  height: 520,
  frequency: true,
  logs: { yaxis: ["|a|", true] },
  traces() {
    const f = sensor.frequency_hz;
    const [nominal, measured, updated] = [sensor.nominal, sensor.measured, sensor.updated];
    const made = [];
    if (nominal) made.push(line("nominal", f, size(nominal), "nominal", ACCELERANCE, { dash: "dash", legendgroup: "nominal", ...marksOfLonePoints(nominal.re, "nominal") }));
    if (measured) {
      // Two standard deviations of the modulus, which has half of the variance of the complex value.
      const bars = sensor.measured_std && { error_y: { type: "data", array: sensor.measured_std.map((std) => std && Math.SQRT2 * std), color: color("evidence"), thickness: 1, width: 0 } };
      made.push(dots("measured", f, size(measured), "measured", ACCELERANCE, { legendgroup: "measured", size: 4, ...bars }));
    }
    if (updated) made.push(line("updated", f, size(updated), "updated", ACCELERANCE, { legendgroup: "updated", ...marksOfLonePoints(updated.re, "updated") }));
    const below = (name, response, shade, more) => {
      const [x, y] = phase(response);
      made.push({ ...line(name, x, y, shade, DEGREES, more), yaxis: "y2", showlegend: false, legendgroup: name });
    };
    if (nominal) below("nominal", nominal, "nominal", { dash: "dash", ...marksOfLonePoints(nominal.re, "nominal") });
    if (measured) {
      const [x, y] = phase(measured);
      made.push({ ...dots("measured", x, y, "measured", DEGREES, { size: 3 }), yaxis: "y2", showlegend: false, legendgroup: "measured" });
    }
    if (updated) below("updated", updated, "updated", marksOfLonePoints(updated.re, "updated"));
    return made;
  },
  layout: () => ({
    xaxis: overFrequency({ anchor: "y2" }),
    yaxis: { title: "Accelerance |a| (m/(s²·N))", domain: [0.4, 1] },
    yaxis2: { title: "Phase (°)", domain: [0, 0.34], range: [-185, 185], dtick: 90 },
  }),
});

addPlot({
  id: "frac",
  height: 96 + 34 * Math.max(2, data.sensors.length),
  traces() {
    const labels = data.sensors.map((one) => plain(one.label));
    const bar = (key, shade) => ({
      type: "bar", orientation: "h", name: key, y: labels.map((_, m) => m), x: data.sensors.map((one) => one.frac[key]),
      marker: { color: color(shade) }, text: labels, textposition: "none", hovertemplate: "%{text}: FRAC %{x:.4f}",
    });
    return [bar("nominal", "nominal"), bar("updated", "updated")];
  },
  layout: () => ({
    barmode: "group",
    hovermode: "y",
    xaxis: { title: "FRAC", range: [0, 1.02] },
    yaxis: { tickvals: data.sensors.map((_, m) => m), ticktext: data.sensors.map((one) => plain(one.label)), autorange: "reversed" },
  }),
});

sensorChoice?.addEventListener("change", () => {
  sensor = data.sensors[Number(sensorChoice.value)];
  for (const plot of plots.filter(({ id }) => id === "accelerance" || id === "nyquist")) {
    plot.revision = (plot.revision ?? 0) + 1;
    draw(plot);
  }
  nameSensor();
});

function nameSensor() {
  const name = document.getElementById("sensor-name");
  if (name) name.textContent = sensor.label;
}
