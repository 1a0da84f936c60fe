// Paper is light, and as wide as a sheet.

const SHEET = 680;
let themeOnScreen = null;

addEventListener("beforeprint", () => {
  themeOnScreen = root.dataset.theme;
  root.dataset.theme = "light";
  for (const plot of plots) {
    plot.canvas.style.width = `${SHEET}px`;
    Plotly.react(plot.canvas, plot.traces(), { ...frame(plot), width: SHEET }, config);
  }
});
addEventListener("afterprint", () => {
  root.dataset.theme = themeOnScreen;
  for (const plot of plots) plot.canvas.style.width = "";
  drawAll();
});
