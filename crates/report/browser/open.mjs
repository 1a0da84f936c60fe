// A page in Chromium that keeps account of what it says and asks for.
import { chromium } from "playwright-core";

const FLAGS = [
  "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

/** A browser with an empty profile of its own. */
export const launch = (executablePath) => chromium.launch({ executablePath, args: FLAGS });

/** Opens what is folded away and waits until its plots are drawn. */
export async function unfold(page) {
  await page.evaluate(() => {
    delete document.documentElement.dataset.drawn;
    for (const part of document.querySelectorAll("details")) part.open = true;
  });
  await page.waitForSelector("html[data-drawn]", { timeout: 60_000 });
}

/** Opens a report and waits until everything is drawn; `said` and `asked` go on being filled. */
export async function open(browser, file, { width, colorScheme, height = 900 }) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme, acceptDownloads: true });
  const page = await context.newPage();
  const [said, asked] = [[], []];
  page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.message}`));
  page.on("request", (request) => {
    if (!/^(data|blob):/.test(request.url()) && request.url() !== `file://${file}`) asked.push(request.url());
  });
  const start = Date.now();
  await page.goto(`file://${file}`);
  await page.waitForSelector("html[data-drawn]", { timeout: 60_000 });
  return { page, context, said, asked, milliseconds: Date.now() - start };
}
