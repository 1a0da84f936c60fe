// The documentation site in Chromium: node site.mjs CHROMIUM SITE_FOLDER PICTURES_FOLDER
//
// Every page, wide and narrow, light and dark: nothing is wider than the window, every picture is there, no error is said, nothing is asked for
// outside of the folder. Pictures are for eyes.
import fs from "node:fs";
import path from "node:path";
import { launch } from "./open.mjs";

const [, , chromium, site, pictures] = process.argv;
const faults = [];

/** Runs in the page: what does not fit, and which pictures are missing. */
function looks() {
  const wrong = [];
  const { scrollWidth, clientWidth } = document.documentElement;
  if (scrollWidth > clientWidth) wrong.push(`${scrollWidth} pixels wide where ${clientWidth} are there`);
  for (const image of document.images) {
    if (!image.naturalWidth) wrong.push(`no picture ${image.getAttribute("src")}`);
    else if (!image.alt) wrong.push(`nothing says what is in ${image.getAttribute("src")}`);
  }
  if (document.body.innerText.includes("$$")) wrong.push("a formula that is not typeset");
  return wrong;
}

fs.mkdirSync(pictures, { recursive: true });
const browser = await launch(chromium);
const pages = fs.readdirSync(site).filter((name) => name.endsWith(".html") && !["404.html", "toc.html"].includes(name));
if (!pages.includes("index.html")) faults.push(`${site}: no index.html`);
for (const [width, colorScheme] of [[1280, "light"], [1280, "dark"], [400, "light"], [400, "dark"]]) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme });
  for (const name of pages) {
    const page = await context.newPage();
    const fault = (what) => faults.push(`${name} (${width}, ${colorScheme}): ${what}`);
    page.on("console", (message) => message.type() === "error" && fault(message.text()));
    page.on("pageerror", (error) => fault(error.message));
    page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || fault(`asks for ${request.url()}`));
    await page.goto(`file://${path.resolve(site, name)}`, { waitUntil: "load" });
    (await page.evaluate(looks)).forEach(fault);
    await page.screenshot({ path: path.join(pictures, `site-${path.parse(name).name}-${width}-${colorScheme}.png`), fullPage: true });
    await page.close();
  }
  await context.close();
}
await browser.close();
faults.forEach((fault) => console.error(fault));
console.log(`site: ${pages.length} pages looked at, ${faults.length} faults`);
process.exit(faults.length === 0 ? 0 : 1);
