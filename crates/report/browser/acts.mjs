// What a reader does with a page: functions that do it and return sentences about what did not happen.
import { readFile } from "node:fs/promises";
import { unfold } from "./open.mjs";

const visiblePlots = (page) => page.$$eval("figure.plot", (figures) => figures.map((figure) => figure.id));

/** Where the cursor is in every plot: its place, or null where it is out of sight. */
const marks = (page) => page.$$eval("figure.plot", (figures) => Object.fromEntries(figures.map((figure) => {
  const mark = figure.querySelector(".cursor-line, .cursor-point");
  return [figure.id, mark && !mark.hidden ? `${mark.style.left} ${mark.className === "cursor-point" ? mark.style.top : ""}` : null];
})));

const settle = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** Does what draws all plots anew, and waits until they are drawn, however slow the machine is. */
async function redrawn(page, act) {
  await page.evaluate(() => delete document.documentElement.dataset.drawn);
  await act();
  await page.waitForSelector("html[data-drawn]", { timeout: 60_000 });
}

/** What the pointer shows over a point of the last curve that is drawn in a plot. */
async function pointed(page, id) {
  const place = await page.evaluate((id) => {
    const canvas = document.querySelector(`#${id} .canvas`);
    const trace = canvas._fullData.findLast((trace) => trace.visible === true && !trace.meta?.band && trace.yaxis === "y");
    const [x, y] = [canvas._fullLayout[trace.xaxis.replace("x", "xaxis")], canvas._fullLayout[trace.yaxis.replace("y", "yaxis")]];
    const there = trace.z ? [Math.floor(trace.x.length / 2)] : trace.x.map((_, k) => k).filter((k) => trace.x[k] !== null && trace.y[k] !== null);
    const k = there[Math.floor(there.length / 2)];
    const box = canvas.getBoundingClientRect();
    // A bar is touched at its end, a little inside.
    const inwards = trace.type === "bar" ? -2 : 0;
    return { left: box.left + x._offset + x.d2p(trace.x[k]) + inwards, top: box.top + y._offset + y.d2p(trace.y[trace.z ? Math.floor(trace.y.length / 2) : k]) };
  }, id);
  for (let k = 0; k < 10; k++) {
    await page.mouse.move(place.left + (k % 2), place.top + (k % 3));
    await page.waitForTimeout(80);
    const shown = await page.locator(`#${id} .hoverlayer`).textContent();
    if (shown) return shown;
  }
  return "";
}

/** The pointer over a plot shows values with units and moves the cursor of all plots over frequency, and the rings of the others. */
export async function hover(page) {
  const wrong = [];
  for (const id of await visiblePlots(page)) {
    await page.locator(`#${id} .drawing`).scrollIntoViewIfNeeded();
    const shown = await pointed(page, id);
    if (!/\d/.test(shown)) wrong.push(`${id}: the pointer shows nothing`);
    if (/plot-(accelerance|modulus(-\d+)?|candidates(-\d+)?|error|error-map|radius|nyquist|(cole-cole|wicket)(-\d+)?)$/.test(id) && !/Hz/.test(shown)) wrong.push(`${id}: no Hz in ${JSON.stringify(shown)}`);
    if (/plot-(modulus|cole-cole)$/.test(id) && (await page.evaluate(() => JSON.parse(document.getElementById("data").textContent).unknowns[0].unit)) && !/Pa/.test(shown)) {
      wrong.push(`${id}: no Pa in ${JSON.stringify(shown)}`);
    }
  }
  await page.mouse.move(1, 1);
  return wrong;
}

/** The pointer in one plot moves the cursor in all; so does the slider, by keyboard. */
export async function cursor(page) {
  const wrong = [];
  const compare = async (what, act) => {
    const before = await marks(page);
    await act();
    await settle(page);
    const after = await marks(page);
    const values = await page.locator("#cursor-values").textContent();
    for (const [id, place] of Object.entries(after)) {
      // A modulus that is the same at all frequencies is one point in the complex plane.
      const mayStay = /^plot-(frac|cole-cole|wicket)/.test(id);
      if (!mayStay && place === before[id] && place !== null) wrong.push(`${what}: the cursor stays in ${id}`);
    }
    const seen = Object.entries(after).filter(([id, place]) => id !== "plot-frac" && place !== null).length;
    if (seen < 3) wrong.push(`${what}: the cursor is seen in ${seen} plots only`);
    if (!/Hz/.test(values)) wrong.push(`${what}: no frequency in ${JSON.stringify(values)}`);
  };
  await page.evaluate(() => scrollTo(0, 0));
  await compare("slider", async () => {
    await page.locator("#cursor-range").focus();
    await page.keyboard.press("Home");
    await settle(page);
    for (let k = 0; k < 7; k++) await page.keyboard.press("ArrowRight");
  });
  await compare("pointer", async () => {
    const drag = page.locator("#plot-accelerance .nsewdrag").first();
    await drag.scrollIntoViewIfNeeded();
    const box = await drag.boundingBox();
    await page.mouse.move(box.x + 0.71 * box.width, box.y + 0.4 * box.height);
    await page.mouse.move(box.x + 0.72 * box.width, box.y + 0.4 * box.height);
    await page.waitForTimeout(150);
  });
  await page.mouse.move(1, 1);
  return wrong;
}

/** Switches between logarithmic and linear axes, of a plot and of all frequencies. */
export async function logarithms(page) {
  const wrong = [];
  const axis = (id, name) => page.evaluate(([id, name]) => document.querySelector(`#${id} .canvas`)._fullLayout[name].type, [id, name]);
  const before = await axis("plot-accelerance", "yaxis");
  const button = page.getByRole("button", { name: "Logarithmic |a|: Frequency response" });
  await button.click();
  await page.waitForTimeout(100);
  const after = await axis("plot-accelerance", "yaxis");
  if (before !== "log" || after !== "linear") wrong.push(`|a| goes from ${before} to ${after}`);
  if ((await button.getAttribute("aria-pressed")) !== "false") wrong.push("the switch of |a| does not say so");
  await button.click();
  await redrawn(page, () => page.locator("#log-frequency").click());
  const all = await page.$$eval("figure.plot", (figures) => figures.filter((figure) => figure.querySelector(".cursor-line")).map((figure) => [figure.id, figure.querySelector(".canvas")._fullLayout.xaxis.type]));
  wrong.push(...all.filter(([, type]) => type !== "log").map(([id]) => `the frequency of ${id} stays linear`));
  await redrawn(page, () => page.locator("#log-frequency").click());
  return wrong;
}

/** Shows what begins switched off. */
export async function switches(page) {
  const wrong = [];
  for (const [id, name] of [["plot-candidates", "refused"], ["plot-nyquist", "nominal"]]) {
    const curves = () => page.evaluate((id) => document.querySelector(`#${id} .canvas`)._fullData.filter((trace) => trace.visible === true).map((trace) => trace.name), id);
    const button = page.locator(`#${id} .tools button`, { hasText: new RegExp(`^${name}$`) });
    if ((await curves()).includes(name)) wrong.push(`${id} begins with ${name}`);
    await button.click();
    await page.waitForTimeout(300);
    if (!(await curves()).includes(name)) wrong.push(`${id} does not show ${name}`);
    await button.click();
  }
  return wrong;
}

/** Zooms by dragging and by buttons, and back. */
export async function zooms(page) {
  const range = () => page.evaluate(() => [...document.querySelector("#plot-accelerance .canvas")._fullLayout.xaxis.range]);
  const width = ([low, high]) => high - low;
  const whole = width(await range());
  const drag = page.locator("#plot-accelerance .nsewdrag").first();
  await drag.scrollIntoViewIfNeeded();
  const box = await drag.boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.2 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.8 * box.height, { steps: 5 });
  await page.mouse.up();
  await page.waitForTimeout(400);
  const dragged = width(await range());
  await page.getByRole("button", { name: "Reset zoom: Frequency response" }).click();
  await page.waitForTimeout(200);
  const reset = width(await range());
  await page.getByRole("button", { name: "Zoom in: Frequency response" }).click();
  await page.waitForTimeout(200);
  const nearer = width(await range());
  await page.getByRole("button", { name: "Reset zoom: Frequency response" }).click();
  const close = (a, b) => Math.abs(a - b) < 0.02 * whole;
  return [
    ...(close(dragged, 0.2 * whole) ? [] : [`dragging over a fifth leaves ${dragged / whole} of the axis`]),
    ...(close(reset, whole) ? [] : ["reset does not reset"]),
    ...(close(nearer, 0.5 * whole) ? [] : [`zooming in leaves ${nearer / whole} of the axis`]),
  ];
}

/** Filters the table by frequency and by status, and turns its pages. */
export async function filters(page) {
  const wrong = [];
  const rows = () => page.locator("#rows-shown").textContent().then((text) => Number(text.split(" ")[0]));
  const { frequency_hz: frequencies, status, statuses } = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent));
  if ((await rows()) !== frequencies.length) wrong.push("the table does not begin with all frequencies");
  const middle = frequencies[Math.floor(frequencies.length / 2)];
  await page.fill("#from", String(middle));
  const above = frequencies.filter((frequency) => frequency >= middle).length;
  if ((await rows()) !== above) wrong.push(`from ${middle} Hz there are ${await rows()} rows in place of ${above}`);
  await page.fill("#from", "");
  const box = page.locator("#filter [name=status]").first();
  const name = await box.getAttribute("value");
  await box.uncheck();
  const others = status.filter((class_) => statuses[class_].name !== name).length;
  if ((await rows()) !== others) wrong.push(`without ${name} there are ${await rows()} rows in place of ${others}`);
  await box.check();
  if (frequencies.length > 25) {
    await page.locator("#next").click();
    if (!/^Page 2 of/.test(await page.locator("#page").textContent())) wrong.push("there is no next page");
    await page.locator("#previous").click();
  }
  await page.locator("#rows tbody tr").nth(3).click();
  await settle(page);
  if ((await page.locator("#rows tr[aria-current]").getAttribute("data-row")) !== "3") wrong.push("a click on a row does not move the cursor there");
  return wrong;
}

/** Downloads: the table as CSV, every plot as CSV and SVG. */
export async function downloads(page) {
  const wrong = [];
  const take = async (what, click) => {
    // Of two dozen downloads in a row Chromium sometimes loses one: that one is asked for again.
    const once = async () => (await Promise.all([page.waitForEvent("download", { timeout: 5_000 }).catch(() => null), click()]))[0];
    const got = (await once()) ?? (await once());
    if (!got) wrong.push(`${what}: nothing is downloaded`);
    return got ? readFile(await got.path(), "utf8") : "";
  };
  const count = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent).frequency_hz.length);
  const table = await take("table", () => page.locator("#table-csv").click());
  if (!table.startsWith("frequency_hz,status,") || table.trim().split("\n").length !== count + 1) wrong.push(`the table's CSV begins ${JSON.stringify(table.slice(0, 60))}`);
  for (const id of await visiblePlots(page)) {
    const csv = await take(id, () => page.locator(`#${id} .tools button`, { hasText: /^CSV$/ }).click());
    if (!csv.startsWith("series,x,y") || csv.trim().split("\n").length < 2 || /NaN|undefined/.test(csv)) wrong.push(`${id}: CSV ${JSON.stringify(csv.slice(0, 80))}`);
    const svg = await take(id, () => page.locator(`#${id} .tools button`, { hasText: /^SVG$/ }).click());
    if (!svg.startsWith("<svg") || !svg.includes("</svg>") || svg.length < 2000 || /NaN|[^d]undefined/.test(svg)) wrong.push(`${id}: SVG ${JSON.stringify(/.{30}(NaN|[^d]undefined).{30}/.exec(svg)?.[0] ?? svg.slice(0, 80))}`);
  }
  return wrong;
}

/** By the tabulator key every control is reached, and shows that it is. */
export async function keyboard(page) {
  await page.evaluate(() => {
    document.activeElement.blur();
    scrollTo(0, 0);
    window.reached = new Set();
    window.unseen = [];
  });
  const wanted = await page.$$eval("button, input, select, summary, a[href], [tabindex='0']", (all) => all.filter((one) => !one.disabled && one.checkVisibility()).length);
  for (let k = 0; k < wanted + 5; k++) {
    await page.keyboard.press("Tab");
    await page.evaluate(() => {
      const { activeElement: at } = document;
      if (at === document.body || window.reached.has(at)) return;
      window.reached.add(at);
      if (getComputedStyle(at).outlineStyle === "none") window.unseen.push(at.outerHTML.slice(0, 80));
    });
  }
  const { reached, unseen } = await page.evaluate(() => ({ reached: window.reached.size, unseen: window.unseen }));
  return [...(reached >= wanted ? [] : [`the tabulator reaches ${reached} of ${wanted} controls`]), ...unseen.map((html) => `no outline where the focus is: ${html}`)];
}

/** A link of the table of contents opens what is folded away, and draws what is in it. */
export async function contents(page) {
  const wrong = [];
  const close = () => page.evaluate(() => document.querySelectorAll("details").forEach((part) => (part.open = false)));
  await close();
  for (const target of await page.$$eval("#contents a", (links) => links.map((link) => link.hash))) {
    const link = page.locator(`#contents a[href="${target}"]`);
    // On a narrow page the list has the parts only.
    if (!(await link.isVisible())) continue;
    await link.click();
    await page.waitForTimeout(60);
    const [top, isSeen, height] = await page.evaluate((id) => {
      const at = document.getElementById(id);
      return [at.getBoundingClientRect().top, at.checkVisibility(), innerHeight];
    }, target.slice(1));
    if (!isSeen || top < -1 || top > height) wrong.push(`${target} is ${isSeen ? `at ${top}` : "not shown"} after a click on its link`);
  }
  await page.waitForTimeout(2000);
  const empty = await page.$$eval("figure.plot .canvas", (all) => all.filter((canvas) => canvas.checkVisibility() && !canvas._fullLayout).length);
  if (empty) wrong.push(`${empty} plots are shown and not drawn`);
  await close();
  await page.evaluate(() => scrollTo(0, 0));
  await unfold(page);
  return wrong;
}

/** The ground of every plot over frequency shows the status of each frequency, and its legend names all of them. */
export async function statuses(page) {
  return page.evaluate(() => {
    const { frequency_hz: frequencies, status, statuses } = JSON.parse(document.getElementById("data").textContent);
    const wrong = [];
    for (const figure of document.querySelectorAll("figure.plot")) {
      const canvas = figure.querySelector(".canvas");
      const grounds = canvas.data.filter(({ yaxis }) => yaxis === "y8");
      if (!figure.querySelector(".cursor-line") || figure.id === "plot-error-map") {
        if (grounds.length) wrong.push(`${figure.id} has a ground and no frequency`);
        continue;
      }
      const legend = figure.querySelector(".grounds").textContent;
      const isOf = (trace, frequency) => trace.x.some((x, k) => k % 5 === 0 && x <= frequency && frequency <= trace.x[k + 2]);
      let off = 0;
      frequencies.forEach((frequency, row) => {
        const { label, trust } = statuses[status[row]];
        // A line that was passed over between others has no ground of its own.
        if (trust === "not asked") return;
        if (!legend.includes(label)) wrong.push(`${figure.id}: no ${label} in ${legend}`);
        if (!grounds.some((trace) => trace.name === label && isOf(trace, frequency))) off += 1;
      });
      // Stretches that are too narrow to be seen are left out.
      if (off > 0.01 * frequencies.length) wrong.push(`${figure.id}: the ground of ${off} of ${frequencies.length} frequencies is another`);
    }
    return [...new Set(wrong)];
  });
}

/** The switch of colours turns the page and its plots. */
export async function theme(page) {
  const look = () => page.evaluate(() => [document.documentElement.dataset.theme, getComputedStyle(document.body).backgroundColor, getComputedStyle(document.querySelector("#plot-accelerance .xtick text")).fill]);
  const before = await look();
  await redrawn(page, () => page.locator("#theme").click());
  const after = await look();
  await redrawn(page, () => page.locator("#theme").click());
  return before.some((value, k) => value === after[k]) ? [`the switch of colours leaves ${JSON.stringify(before)} at ${JSON.stringify(after)}`] : [];
}
