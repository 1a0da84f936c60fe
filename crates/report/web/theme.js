// Light and dark: as the system says, until the switch says otherwise.

const root = document.documentElement;
const systemDark = matchMedia("(prefers-color-scheme: dark)");
const themeButton = document.getElementById("theme");
let chosenTheme = null;

const color = (name) => getComputedStyle(root).getPropertyValue(`--${name}`).trim();

/** Sets the theme; plots take their colours anew when they are drawn. */
function setTheme(theme) {
  root.dataset.theme = theme;
  themeButton.textContent = theme === "dark" ? "Light" : "Dark";
  themeButton.setAttribute("aria-label", `Switch to ${theme === "dark" ? "light" : "dark"} colours`);
}

setTheme(systemDark.matches ? "dark" : "light");
themeButton.addEventListener("click", () => {
  chosenTheme = root.dataset.theme === "dark" ? "light" : "dark";
  setTheme(chosenTheme);
  drawAll();
});
systemDark.addEventListener("change", () => {
  if (chosenTheme) return;
  setTheme(systemDark.matches ? "dark" : "light");
  drawAll();
});
