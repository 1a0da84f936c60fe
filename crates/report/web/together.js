// How the numbers that hold for the band are correlated.

const { together } = data;
const numbered = (name, k) => `${k + 1} ${plain(name.replaceAll("_", " "))}`;

/** A name that leaves room for the picture. */
const short = (name) => (name.length > 22 ? `${name.slice(0, 21)}…` : name);

addPlot({
  id: "correlation",
  height: 170 + 46 * (together?.coordinates.length ?? 0),
  traces() {
    const { coordinates, correlation } = together;
    const index = coordinates.map((_, k) => k + 1);
    const shown = (value) => (value === null ? "not identifiable" : digits(value, 3));
    const labels = coordinates.map((row, k) => coordinates.map((column, j) => `${numbered(row, k)} and ${numbered(column, j)}: ${shown(correlation[k][j])}`));
    return [{
      type: "heatmap", name: "correlation", x: index, y: index, z: correlation, text: labels, zmin: -1, zmax: 1, colorscale: "RdBu", xgap: 2, ygap: 2,
      colorbar: { title: { text: "" }, thickness: 14, outlinewidth: 0, tickvals: [-1, -0.5, 0, 0.5, 1] }, hovertemplate: "%{text}<extra></extra>",
    }];
  },
  layout() {
    const index = together.coordinates.map((_, k) => k + 1);
    return {
      hovermode: "closest",
      xaxis: { title: "Number", tickvals: index, ticktext: index.map(String), showgrid: false },
      yaxis: { tickvals: index, ticktext: together.coordinates.map((name, k) => short(numbered(name, k))), autorange: "reversed", showgrid: false },
    };
  },
});

addPlot({
  id: "profile",
  height: 360,
  traces() {
    const { distance, chi2, linear } = together.profile;
    const made = [];
    if (hasAny(linear)) made.push(line("from the error bar", distance, linear, "nominal", (y) => digits(y, 3), { dash: "dash" }));
    made.push({ ...line("all other values fitted again", distance, chi2, "updated", (y, x) => `Δχ² ${digits(y, 3)} at ${digits(x, 3)}`), mode: "lines+markers", marker: { color: color("updated"), size: 6 } });
    return made;
  },
  layout: () => ({ xaxis: { title: "Change (1 is a factor of e)" }, yaxis: { title: "Growth of χ²" }, showlegend: true }),
});
