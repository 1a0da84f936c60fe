// Paper is light, as wide as a sheet, and takes two plots a page.

const [SHEET, HALF] = [680, 330];
const LOWER = 0.72;
let themeOnScreen = null;
const isPrinting = () => themeOnScreen !== null;

addEventListener("beforeprint", () => {
  themeOnScreen ??= root.dataset.theme;
  root.dataset.theme = "light";
  for (const plot of plots) {
    const width = plot.figure.closest(".pair") ? HALF : SHEET;
    const height = Math.round(LOWER * plot.height);
    plot.canvas.style.width = `${width}px`;
    plot.canvas.parentElement.style.height = `${height}px`;
    const layout = { ...frame(plot), width, height };
    // Higher than on the screen: a plot that was resized before keeps its old top margin on the sheet, and the legend would lie in it.
    layout.legend.y = 1.1;
    Plotly.react(plot.canvas, plot.traces(), layout, config);
    setLogTicks(plot);
  }
});
addEventListener("afterprint", () => {
  root.dataset.theme = themeOnScreen;
  themeOnScreen = null;
  for (const plot of plots) {
    plot.canvas.style.width = "";
    plot.canvas.parentElement.style.height = `${plot.height}px`;
  }
  drawAll();
});
