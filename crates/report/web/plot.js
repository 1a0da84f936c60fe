// One plot: its traces, its tools, and drawing it in the colours of the page.
//
// A plot is { id, height, traces(), layout(), frequency, logs, at(row) }: `frequency` where x is the frequency, `logs` its axes that can be logarithmic as
// { axis: [label, whether it begins so] }, `at` where the cursor's frequency is in a plot over something else, `extra` a curve that begins switched off,
// `noGround` where statuses are not shaded.

const plots = [];
let logFrequency = false;
const touch = matchMedia("(pointer: coarse)").matches;

function addPlot(plot) {
  const figure = document.getElementById(`plot-${plot.id}`);
  if (!figure) return;
  const drawing = figure.querySelector(".drawing");
  const canvas = document.createElement("div");
  canvas.className = "canvas";
  const mark = document.createElement("div");
  mark.className = plot.frequency ? "cursor-line" : "cursor-point";
  mark.hidden = true;
  drawing.append(canvas, mark);
  drawing.style.height = `${plot.height}px`;
  const title = figure.querySelector("h3").textContent;
  drawing.setAttribute("role", "img");
  drawing.setAttribute("aria-label", `${title}; its values are in the download CSV`);
  if (isShaded(plot)) drawing.before(legendOfGrounds());
  plots.push(Object.assign(plot, { figure, canvas, mark, title, log: Object.fromEntries(Object.entries(plot.logs ?? {}).map(([axis, [, on]]) => [axis, on])) }));
  addTools(plot);
}

/** Whether the ground of a plot shows the statuses. */
const isShaded = (plot) => plot.frequency && !plot.noGround;

/** Whether a plot stands in a part that is folded away: it is drawn when that is opened. */
const isFolded = (plot) => plot.figure.closest("details:not([open])") !== null;

/** The axis of the ground below a panel's axis. */
const groundOf = (name) => `yaxis${name === "yaxis" ? 8 : 9}`;

/** Traces of a plot, those of its ground first. */
function allTraces(plot) {
  if (!isShaded(plot)) return plot.traces();
  const panels = Object.keys(plot.layout()).filter((name) => name.startsWith("yaxis"));
  return [...panels.flatMap((name) => grounds(groundOf(name).replace("axis", ""))), ...plot.traces()];
}

function addTools(plot) {
  const tools = plot.figure.querySelector(".tools");
  const button = (text, label, act) => {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = text;
    made.setAttribute("aria-label", label);
    made.title = label;
    made.addEventListener("click", () => act(made));
    tools.append(made);
    return made;
  };
  button("+", `Zoom in: ${plot.title}`, () => zoom(plot, 0.5));
  button("−", `Zoom out: ${plot.title}`, () => zoom(plot, 2));
  button("Reset", `Reset zoom: ${plot.title}`, () => {
    plot.revision = (plot.revision ?? 0) + 1;
    draw(plot);
  });
  for (const [axis, [label]] of Object.entries(plot.logs ?? {})) {
    const made = button(`log ${label}`, `Logarithmic ${label}: ${plot.title}`, () => {
      plot.log[axis] = !plot.log[axis];
      plot.revision = (plot.revision ?? 0) + 1;
      made.setAttribute("aria-pressed", plot.log[axis]);
      draw(plot);
    });
    made.setAttribute("aria-pressed", plot.log[axis]);
  }
  if (plot.extra) {
    const made = button(plot.extra, `Show ${plot.extra}: ${plot.title}`, () => {
      plot.shows = !plot.shows;
      made.setAttribute("aria-pressed", plot.shows);
      draw(plot);
    });
    made.setAttribute("aria-pressed", false);
  }
  button("SVG", `Download SVG: ${plot.title}`, () => saveSvg(plot));
  button("CSV", `Download CSV: ${plot.title}`, () => saveCsv(plot));
}

/** Axes and frame that all plots have. */
function frame(plot) {
  const own = plot.layout();
  const axis = (name, given) => ({
    gridcolor: color("grid"), linecolor: color("line"), zerolinecolor: color("line"), automargin: true, exponentformat: "power", tickangle: 0,
    ...given,
    title: { text: given.title ?? "", standoff: 8 },
    type: plot.log[name] || (plot.frequency && name.startsWith("xaxis") && logFrequency) ? "log" : "linear",
  });
  const axes = Object.entries(own).filter(([name]) => /^[xy]axis/.test(name)).map(([name, given]) => [name, axis(name, given)]);
  if (isShaded(plot)) {
    const [, frequencies] = axes.find(([name]) => name === "xaxis");
    frequencies.range = bandRange(frequencies.type === "log");
    // The ground is the subplot, and the panel lies over it.
    for (const [name, panel] of axes.filter(([name]) => name.startsWith("yaxis"))) {
      const ground = groundOf(name);
      axes.push([ground, { domain: panel.domain ?? [0, 1], range: [0, 1], visible: false, fixedrange: true, anchor: "x" }]);
      panel.overlaying = ground.replace("axis", "");
      delete panel.domain;
    }
  }
  return {
    ...own,
    ...Object.fromEntries(axes),
    font: { color: color("ink"), family: getComputedStyle(document.body).fontFamily, size: 12 },
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    hoverlabel: { bgcolor: color("paper"), bordercolor: color("line"), font: { color: color("ink") } },
    hovermode: own.hovermode ?? (plot.frequency ? "x unified" : "closest"),
    legend: { orientation: "h", x: 0, xanchor: "left", y: 1.01, yanchor: "bottom" },
    margin: { l: 64, r: 16, t: 30, b: 46 },
    dragmode: touch ? false : "zoom",
    uirevision: plot.revision ?? 0,
    height: plot.height,
  };
}

const config = { displayModeBar: false, responsive: true, doubleClick: false, showTips: false };

async function draw(plot) {
  // Afterwards everything is drawn again.
  if (isPrinting() || isFolded(plot)) return;
  await Plotly.react(plot.canvas, allTraces(plot), frame(plot), config);
  if (!plot.isDrawn) {
    plot.isDrawn = true;
    plot.canvas.on("plotly_hover", ({ points: [point] }) => {
      const frequency = plot.frequency ? point.x : point.customdata;
      if (Number.isFinite(frequency)) moveCursor(frequency);
    });
    plot.canvas.on("plotly_doubleclick", () => {
      plot.revision = (plot.revision ?? 0) + 1;
      draw(plot);
    });
    plot.canvas.on("plotly_relayout", () => setTicks(plot));
    plot.canvas.on("plotly_afterplot", () => placeMark(plot));
  }
  setTicks(plot);
  placeMark(plot);
}

/** One after the other, so that the page stays awake; what is asked for last is what is drawn. */
let drawing = Promise.resolve();
let asked = 0;
function drawAll() {
  const turn = ++asked;
  drawing = drawing.then(async () => {
    for (const plot of plots) {
      if (turn !== asked) return;
      await draw(plot);
      await new Promise((next) => setTimeout(next));
    }
    if (turn === asked) root.dataset.drawn = "true";
  });
  return drawing;
}

for (const part of document.querySelectorAll("details")) {
  part.addEventListener("toggle", () => part.open && drawAll());
}
/** A link to something that is folded away opens it. */
function openTarget() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  const part = target?.closest("details") ?? target?.querySelector(":scope > details");
  if (!part || part.open) return;
  part.open = true;
  target.scrollIntoView();
}
addEventListener("hashchange", openTarget);
document.getElementById("contents").addEventListener("click", () => setTimeout(openTarget));

/** Zooms about the cursor where it is in sight, else about the middle. */
function zoom(plot, by) {
  const full = plot.canvas._fullLayout;
  const change = {};
  for (const name of Object.keys(full).filter((name) => /^[xy]axis\d*$/.test(name))) {
    // Plots over frequency keep their height, as the others' two axes belong together.
    if (plot.frequency && name.startsWith("yaxis")) continue;
    const axis = full[name];
    const [low, high] = axis.range;
    const spot = plot.frequency ? axis.d2l(data.frequency_hz[cursorRow]) : null;
    const at = axis.type === "log" && spot !== null ? Math.log10(spot) : spot;
    const middle = at !== null && at > low && at < high ? at : (low + high) / 2;
    change[`${name}.range`] = [middle - (by * (high - low)) / 2, middle + (by * (high - low)) / 2];
  }
  Plotly.relayout(plot.canvas, change);
}

/** The plot as it is seen, in light colours. */
async function saveSvg(plot) {
  const theme = root.dataset.theme;
  root.dataset.theme = "light";
  const layout = { ...frame(plot), paper_bgcolor: "#ffffff", title: { text: plain(plot.title) }, width: 900, height: plot.height };
  layout.margin = { ...layout.margin, t: 70 };
  for (const name of Object.keys(layout).filter((name) => /^[xy]axis\d*$/.test(name))) {
    const { range, tickmode, tickvals, ticktext } = plot.canvas._fullLayout[name];
    layout[name] = { ...layout[name], range: [...range], ...(tickmode === "array" && { tickmode, tickvals, ticktext }) };
  }
  // On a page the legend of the ground is text beside the plot.
  const traces = allTraces(plot).map((trace) => (/^y[89]$/.test(trace.yaxis) ? { ...trace, showlegend: trace.yaxis === "y8" } : trace));
  const picture = Plotly.toImage({ data: traces, layout }, { format: "svg", width: 900, height: plot.height });
  root.dataset.theme = theme;
  const text = decodeURIComponent((await picture).replace(/^data:image\/svg\+xml,/, ""));
  download(`${plot.id}.svg`, "image/svg+xml", text);
}

/** All points of all curves, one a line. */
function saveCsv(plot) {
  const rows = [csvRow(["series", "x", "y", "z or two standard deviations"])];
  for (const trace of plot.traces().filter((trace) => !trace.meta?.band)) {
    if (trace.z) {
      trace.z.forEach((line, k) => line.forEach((z, i) => rows.push(csvRow([trace.name ?? "", trace.x[i], trace.y[k], z]))));
      continue;
    }
    trace.x.forEach((x, k) => rows.push(csvRow([trace.name ?? "", x, trace.y[k], trace.error_y?.array?.[k]])));
  }
  download(`${plot.id}.csv`, "text/csv", rows.join(""));
}

/** What the pointer shows of each point; `label` makes it of y, x and the place. */
const labels = (x, y, label) => ({ text: y.map((value, k) => (value === null || value === undefined ? "" : label(value, x[k], k))), hovertemplate: "%{text}" });

/** A curve with what the pointer shows of it. */
const line = (name, x, y, shade, label, more = {}) => ({
  type: "scatter", mode: "lines", name, x, y, connectgaps: false,
  line: { color: color(shade), width: 1.8, dash: more.dash },
  ...labels(x, y, label), ...more, dash: undefined,
});

/** Points with what the pointer shows of them. */
const dots = (name, x, y, shade, label, more = {}) => ({
  type: "scatter", mode: "markers", name, x, y,
  marker: { color: color(shade), size: more.size ?? 5, symbol: more.symbol ?? "circle", opacity: more.opacity ?? 1 },
  ...labels(x, y, label), ...more, size: undefined, symbol: undefined, opacity: undefined,
});

/** The frequency axis of a plot of one or several panels. */
const overFrequency = (more = {}) => ({
  title: "Frequency (Hz)", hoverformat: ".6~r", unifiedhovertitle: { text: "%{x} Hz" }, showspikes: false, ...more,
});
