// What is wrong with the looks of a page: functions that run in it and return sentences.

/** WCAG 2.2: text has a contrast of at least 4.5 to what is behind it. */
export function contrast() {
  const parse = (text) => {
    const canvas = (window.contrastCanvas ??= Object.assign(document.createElement("canvas"), { width: 1, height: 1 }).getContext("2d", { willReadFrequently: true }));
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = text;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
    return [r, g, b, a / 255];
  };
  const over = ([r, g, b, a], [R, G, B]) => [r * a + R * (1 - a), g * a + G * (1 - a), b * a + B * (1 - a), 1];
  const luminance = ([r, g, b]) => {
    const [R, G, B] = [r, g, b].map((v) => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * R + 0.7152 * G + 0.0722 * B;
  };
  const behind = (element) => {
    const layers = [];
    for (let at = element; at; at = at.parentElement) layers.push(parse(getComputedStyle(at).backgroundColor));
    return layers.reverse().reduce((below, layer) => over(layer, below), [255, 255, 255, 1]);
  };
  const seen = new Map();
  for (const element of document.querySelectorAll("body *")) {
    const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
    if (!own || element.matches("script, style, option, :disabled, :disabled *") || !element.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
    const style = getComputedStyle(element);
    const isSvg = element.namespaceURI.endsWith("svg");
    const text = parse(isSvg ? style.fill : style.color);
    const ground = behind(isSvg ? element.closest("svg").parentElement : element);
    const opacity = isSvg ? Number(style.fillOpacity) * Number(style.opacity) : 1;
    const [a, b] = [luminance(over([text[0], text[1], text[2], text[3] * opacity], ground)), luminance(ground)].sort((x, y) => y - x);
    const ratio = (a + 0.05) / (b + 0.05);
    if (ratio < 4.5) seen.set(`${element.tagName}.${element.getAttribute("class") ?? ""} in ${style.color}`, `contrast ${ratio.toFixed(2)} of ${JSON.stringify(element.textContent.trim().slice(0, 40))}`);
  }
  return [...seen].map(([key, value]) => `${value} (${key})`);
}

/** Nothing is wider than the window, except what scrolls by itself. */
export function overflow() {
  const wide = document.documentElement.scrollWidth - innerWidth;
  if (wide <= 0) return [];
  const culprits = [...document.querySelectorAll("body *")].filter((element) => element.getBoundingClientRect().right > innerWidth + 1 && !element.closest(".scroll"));
  return [`${wide} px wider than the window: ${culprits.slice(-3).map((element) => `${element.tagName}#${element.id}.${element.className}`).join(", ")}`];
}

/** No text lies over another, none leaves its plot or is cut. */
export function texts() {
  const wrong = [];
  const shown = (text) => JSON.stringify(text.trim().slice(0, 30));
  const boxes = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const { currentNode: node } = walker;
    const { parentElement: parent } = node;
    if (!node.data.trim() || parent.closest("script, style, option, textarea, #cursor, .hoverlayer") || !parent.checkVisibility({ visibilityProperty: true, opacityProperty: true })) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    const svg = parent.closest("svg");
    for (const box of range.getClientRects()) {
      if (box.width < 1 || box.height < 1) continue;
      boxes.push({ node, box, plot: parent.closest(".drawing"), scroller: parent.closest(".scroll"), text: node.data });
    }
    const frame = parent.closest(".drawing")?.getBoundingClientRect();
    const own = svg && parent.getBoundingClientRect();
    if (frame && (own.left < frame.left - 1 || own.right > frame.right + 1 || own.top < frame.top - 1 || own.bottom > frame.bottom + 1)) {
      wrong.push(`${shown(node.data)} leaves the plot ${parent.closest("figure").id}`);
    }
  }
  boxes.sort((a, b) => a.box.top - b.box.top);
  boxes.forEach((one, k) => {
    for (let j = k + 1; j < boxes.length && boxes[j].box.top < one.box.bottom - 2; j++) {
      const other = boxes[j];
      if (other.node === one.node || other.scroller !== one.scroller) continue;
      const wide = Math.min(one.box.right, other.box.right) - Math.max(one.box.left, other.box.left);
      const high = Math.min(one.box.bottom, other.box.bottom) - Math.max(one.box.top, other.box.top);
      // Boxes of letters are higher than letters: a line's box may reach a little into the next one.
      if (wide > 2 && high > 0.35 * Math.min(one.box.height, other.box.height)) wrong.push(`${shown(one.text)} lies over ${shown(other.text)}${one.plot ? ` in ${one.plot.parentElement.id}` : ""}`);
    }
  });
  for (const element of document.querySelectorAll("main *, header *")) {
    const style = getComputedStyle(element);
    const hides = style.overflowX === "hidden" || style.overflowX === "clip";
    if (hides && !element.closest("svg, .drawing") && element.scrollWidth > element.clientWidth + 1 && element.textContent.trim()) wrong.push(`${shown(element.textContent)} is cut`);
  }
  return [...new Set(wrong)];
}

/** Every plot has curves in it, and says in words what it is. */
export function plots() {
  return [...document.querySelectorAll("figure.plot")].flatMap((figure) => {
    if (!figure.checkVisibility()) return [];
    // The ground of statuses is no curve.
    const curves = figure.querySelector(".canvas").data.filter(({ meta }) => !meta?.band);
    const marks = curves.length && figure.querySelectorAll(".scatterlayer path, .barlayer path, .hm image, .heatmaplayer image").length;
    const name = figure.querySelector(".drawing").getAttribute("aria-label");
    return [...(marks ? [] : [`${figure.id} is empty`]), ...(name ? [] : [`${figure.id} has no name`])];
  });
}

/** What a reader without eyes needs: language, title, one first heading, headings in order, names of all controls. */
export function structure() {
  const wrong = [];
  if (document.documentElement.lang !== "en") wrong.push("no language");
  if (!document.title) wrong.push("no title");
  const levels = [...document.querySelectorAll("h1, h2, h3")].map((heading) => Number(heading.tagName[1]));
  if (levels.filter((level) => level === 1).length !== 1) wrong.push("not one h1");
  levels.forEach((level, k) => k && level > levels[k - 1] + 1 && wrong.push(`a heading of level ${level} after ${levels[k - 1]}`));
  for (const control of document.querySelectorAll("button, input, select")) {
    const name = control.getAttribute("aria-label") || control.textContent.trim() || control.labels?.[0]?.textContent.trim();
    if (!name) wrong.push(`a control without a name: ${control.outerHTML.slice(0, 80)}`);
  }
  return wrong;
}

/** Numbers are written as 2·10⁶: no 2e6, and no k, M or G behind the number of an axis. */
export function numbers() {
  const wrong = [];
  for (const tick of document.querySelectorAll(".xtick text, .ytick text, .y2tick text")) {
    if (/\d\s*[kMGTµmn]$|\de[+-]?\d|×/.test(tick.textContent)) wrong.push(`tick ${JSON.stringify(tick.textContent)} in ${tick.closest("figure").id}`);
  }
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const { data, parentElement: parent } = walker.currentNode;
    if (!parent.closest("script, style, code, svg, a") && /(^|[\s(])\d+(\.\d+)?e[+-]?\d+\b/.test(data)) wrong.push(`${JSON.stringify(data.trim().slice(0, 60))} has a number with e`);
  }
  return [...new Set(wrong)];
}
