// How good the values are, and what the series and the subspace would have to do.

/** A plot of one or two columns over frequency. */
function addColumns(id, title, curves, label, begins = true, level = null) {
  addPlot({
    id,
    height: 330,
    frequency: true,
    logs: { yaxis: [label, begins] },
    traces: () => curves().filter(([, y]) => y).map(([name, y, shade, format, more]) => line(name, drawn(data.frequency_hz), drawn(y), shade, format, { mode: "lines+markers", marker: { color: color(shade), size: 3.5 }, ...more })),
    layout: () => ({
      xaxis: overFrequency(),
      yaxis: { title },
      showlegend: true,
      ...(level !== null && { shapes: [{ type: "line", xref: "paper", x0: 0, x1: 1, y0: level, y1: level, line: { color: color("soft"), width: 1, dash: "dot" } }] }),
    }),
  });
}

const short3 = (y) => digits(y, 3);
const short4 = (y) => digits(y, 4);

addColumns("error", "Relative error ε", () => [
  ["nominal", data.nominal_error, "nominal", short3, { line: { color: color("nominal"), dash: "dash", width: 1.5 } }],
  ["updated", column("error"), "updated", short3],
], "ε");

addPlot({
  id: "error-map",
  height: 330,
  frequency: true,
  noGround: true,
  traces: () => [{
    type: "heatmap", name: "log₁₀ ε", x: data.error_map.frequency_hz, y: data.error_map.order, z: data.error_map.log_error, colorscale: "Viridis", hoverongaps: false,
    colorbar: { title: { text: "log₁₀ ε" }, thickness: 14, outlinewidth: 0 }, hovertemplate: "%{x:.6~g} Hz, %{y} terms: log₁₀ ε = %{z:.2f}<extra></extra>",
  }],
  layout: () => ({ hovermode: "closest", xaxis: overFrequency(), yaxis: { title: "Terms of the series" } }),
});

const largestRadius = (column("spectral_radius") ?? []).reduce((most, value) => Math.max(most, value ?? 0), 0);
addColumns("radius", "Spectral radius ρ", () => [["spectral radius", column("spectral_radius"), "updated", short4]], "ρ", largestRadius > 10, 1);

/** A standard deviation of an unknown over its value. */
const relative = (one, part) => partOf(one, part)?.map((std, row) => { const value = partOf(one, "storage")[row]; return std === null || !value ? null : std / Math.abs(value); });
unknowns.forEach((one) => addColumns(`contributions${one.suffix}`, "Standard deviation, relative", () => [
  ["total", relative(one, "storage_std"), "measured", short3, { line: { color: color("measured"), width: 1 } }],
  ["noise", relative(one, "storage_std_noise"), "nominal", short3],
  ["errors of the model", relative(one, "storage_std_model"), "updated", short3],
  ["known factors", relative(one, "storage_std_known_factors"), "reference", short3],
], "σ"));

/** |c| of the only unknown over the nominal factor's size. */
function relativeChange() {
  const [one] = unknowns;
  const [re, im] = [partOf(one, "correction_re"), partOf(one, "correction_im")];
  if (!re || !one.nominal) return null;
  const { storage, loss_factor: loss } = one.nominal;
  return re.map((value, row) => value === null || storage[row] === null ? null : Math.hypot(value, im?.[row] ?? 0) / Math.abs(storage[row] * Math.hypot(1, loss[row] ?? 0)));
}

addColumns("pole", "Relative to nominal", () => [
  ["distance to the nearest pole", column("convergence_radius"), "nominal", short4],
  ["change that was found", relativeChange(), "updated", short4],
], "distance");
addColumns("order", "Terms for an error of 10⁻⁶", () => [["terms", column("required_order"), "nominal", short4]], "order");
addColumns("reduction-error", "Reduction error, relative", () => [["reduction error", column("reduction_error"), "nominal", short3]], "error");
