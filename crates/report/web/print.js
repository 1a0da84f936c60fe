// Paper is light, as wide as a sheet, and takes two plots a page.

const [SHEET, HALF] = [680, 330];
const LOWER = 0.72;
let themeOnScreen = null;
let folded = [];
const isPrinting = () => themeOnScreen !== null;

addEventListener("beforeprint", () => {
  themeOnScreen ??= root.dataset.theme;
  root.dataset.theme = "light";
  // What is folded away is printed too.
  folded = [...document.querySelectorAll("details:not([open])")];
  for (const part of folded) part.open = true;
  for (const plot of plots) {
    const width = plot.figure.closest(".pair") ? HALF : SHEET;
    const height = Math.round(LOWER * plot.height);
    plot.canvas.style.width = `${width}px`;
    plot.canvas.parentElement.style.height = `${height}px`;
    const layout = { ...frame(plot), width, height };
    // Higher than on the screen: a plot that was resized before keeps its old top margin on the sheet, and the legend would lie in it.
    layout.legend.y = 1.1;
    Plotly.react(plot.canvas, allTraces(plot), layout, config);
    setTicks(plot);
  }
});
addEventListener("afterprint", () => {
  root.dataset.theme = themeOnScreen;
  themeOnScreen = null;
  for (const part of folded) part.open = false;
  for (const plot of plots) {
    plot.canvas.style.width = "";
    plot.canvas.parentElement.style.height = `${plot.height}px`;
  }
  drawAll();
});
