// The frequency cursor: one frequency, shown in every plot.

const cursorRange = document.getElementById("cursor-range");
const cursorValues = document.getElementById("cursor-values");
const logFrequencyButton = document.getElementById("log-frequency");
let cursorRow = 0;
let cursorWaits = false;

/** What is known at the cursor's frequency. */
function cursorText() {
  const at = (name) => column(name)?.[cursorRow] ?? null;
  const parts = [`${digits(data.frequency_hz[cursorRow], 7)} Hz`, statusOf(cursorRow).label];
  for (const one of unknowns) {
    const of = (part) => partOf(one, part)?.[cursorRow] ?? null;
    if (of("storage") === null) continue;
    const called = one.label && `${one.label} `;
    parts.push(`${called}${one.real ? "value" : "E′"} ${withBar(of("storage"), of("storage_std"), one.unit)}`);
    if (!one.real) parts.push(`${called}η ${withBar(of("loss_factor"), of("loss_factor_std"))}`);
  }
  if (at("error") !== null) parts.push(`error of the response ${digits(100 * at("error"), 3)} %`);
  return parts.join(" · ");
}

/** Moves the cursor to the row that is nearest to a frequency. */
function moveCursor(frequency) {
  setCursor(nearest(data.frequency_hz, frequency));
}

function setCursor(row) {
  cursorRow = row;
  if (cursorWaits) return;
  cursorWaits = true;
  requestAnimationFrame(() => {
    cursorWaits = false;
    cursorRange.value = cursorRow;
    cursorRange.setAttribute("aria-valuetext", cursorText());
    cursorValues.textContent = cursorText();
    plots.forEach(placeMark);
    markRow();
  });
}

/** The cursor's place in a plot: a line over a frequency axis, a ring elsewhere. */
function placeMark(plot) {
  const full = plot.canvas._fullLayout;
  if (!full?.xaxis || !plot.isDrawn) return;
  const spot = plot.frequency ? { x: data.frequency_hz[cursorRow] } : plot.at?.(data.frequency_hz[cursorRow], cursorRow);
  const { style } = plot.mark;
  const left = spot && full.xaxis.d2p(spot.x);
  const inside = (pixels, axis) => Number.isFinite(pixels) && pixels >= -0.5 && pixels <= axis._length + 0.5;
  plot.mark.hidden = !spot || !inside(left, full.xaxis);
  if (plot.mark.hidden) return;
  style.left = `${full.xaxis._offset + left}px`;
  if (plot.frequency) {
    style.top = `${full._size.t}px`;
    style.height = `${full._size.h}px`;
    return;
  }
  const top = full.yaxis.d2p(spot.y);
  plot.mark.hidden = !inside(top, full.yaxis);
  style.top = `${full.yaxis._offset + top}px`;
}

cursorRange.max = data.frequency_hz.length - 1;
cursorRange.addEventListener("input", () => setCursor(Number(cursorRange.value)));
logFrequencyButton.addEventListener("click", () => {
  logFrequency = !logFrequency;
  logFrequencyButton.setAttribute("aria-pressed", logFrequency);
  for (const plot of plots.filter((plot) => plot.frequency)) plot.revision = (plot.revision ?? 0) + 1;
  drawAll();
});
