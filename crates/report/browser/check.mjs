// node check.mjs CHROMIUM REPORTS PICTURES: every page below REPORTS/*/report.html, looked at and worked with.
import { mkdir, readdir } from "node:fs/promises";
import { join, resolve } from "node:path";
import * as acts from "./acts.mjs";
import * as looks from "./looks.mjs";
import { launch, open, unfold } from "./open.mjs";

const [executable, reports, pictures] = process.argv.slice(2);

/** Milliseconds in which the largest page has drawn everything. Not a measurement: a page that hangs takes minutes, on a slow machine a good one takes some seconds. */
const LONGEST = 45_000;

let wrong = 0;
const tell = (where, sentences) => {
  for (const sentence of sentences) console.log(`  WRONG ${where}: ${sentence}`);
  wrong += sentences.length;
};

/** One page at one width and in one colour scheme; `work` does what a reader does. */
async function check(browser, name, width, colorScheme, work) {
  const where = `${name} ${width} ${colorScheme}`;
  const file = resolve(reports, name, "report.html");
  const { page, context, said, asked, milliseconds } = await open(browser, file, { width, colorScheme });
  // As it is opened, then with everything that is folded away.
  for (const state of ["", "-unfolded"]) {
    if (state) await unfold(page);
    for (const [what, look] of Object.entries(looks)) tell(`${where}${state} ${what}`, await page.evaluate(look));
    await page.screenshot({ path: join(pictures, `${name}-${width}-${colorScheme}${state}.png`), fullPage: true });
  }
  for (const act of work) tell(`${where} ${act.name}`, await act(page));
  if (milliseconds > LONGEST) tell(where, [`drawn after ${milliseconds} ms`]);
  tell(`${where} console`, said);
  tell(`${where} network`, asked);
  if (work.length) {
    const pdf = await page.pdf({ path: join(pictures, `${name}.pdf`), format: "A4" });
    if (pdf.length < 20_000) tell(where, [`a print of ${pdf.length} bytes`]);
  }
  await context.close();
  console.log(`${where}: drawn in ${milliseconds} ms${work.length ? `, ${work.length} acts` : ""}`);
}

await mkdir(pictures, { recursive: true });
const names = (await readdir(reports)).sort();
const browser = await launch(executable);
const all = [acts.hover, acts.cursor, acts.logarithms, acts.switches, acts.zooms, acts.filters, acts.downloads, acts.keyboard, acts.theme, acts.contents, acts.statuses];
for (const name of names) {
  // What a reader does is the same code on every page: all of it on the page with everything, part of it on the others.
  const some = [acts.hover, acts.cursor, acts.filters, acts.statuses];
  // What only several unknowns have is downloaded and reached by keyboard too.
  const most = name === "sandwich" ? all : name === "added-mass" ? [...some, acts.downloads, acts.keyboard] : some;
  await check(browser, name, 1280, "light", most);
  await check(browser, name, 400, "dark", []);
  if (name === "sandwich") {
    await check(browser, name, 1280, "dark", []);
    await check(browser, name, 400, "light", [acts.cursor]);
  }
}
await browser.close();
console.log(wrong ? `${wrong} things are wrong` : `${names.length} reports are right`);
process.exit(wrong ? 1 : 0);
