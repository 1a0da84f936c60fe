// Typesets the formulas $…$ and $$…$$ in the pages of rustdoc or of mdBook: node typeset.cjs KATEX_PACKAGE DOC_FOLDER
//
// Fails, with the place, where Markdown has eaten a part of a formula or KaTeX cannot read it.
"use strict";
const fs = require("fs");
const path = require("path");

const [, , katexFolder, docFolder] = process.argv;
const katex = require(katexFolder);
const FORMULA = /\$\$([^$]+)\$\$|\$([^$]+)\$/g;
let faults = 0;

function fault(place, what, formula) {
  faults += 1;
  console.error(`${place}: ${what}: ${formula.trim()}`);
}

function* files(folder, ending) {
  for (const entry of fs.readdirSync(folder, { withFileTypes: true })) {
    const inside = path.join(folder, entry.name);
    if (entry.isDirectory()) yield* files(inside, ending);
    else if (entry.name.endsWith(ending)) yield inside;
  }
}

// A backslash before punctuation is an escape in Markdown: `\,` arrives as a comma, and no page shows it.
function checkSource(file) {
  const lines = fs.readFileSync(file, "utf8").split("\n");
  const comments = file.endsWith(".md") ? lines : lines.map((line) => /^\s*\/\/[/!](.*)/.exec(line)?.[1] ?? "");
  const blank = (code) => code.replace(/[^\n]/g, " ");
  const text = comments.join("\n").replace(/```[^]*?```|`[^`\n]+`/g, blank);
  for (const match of text.matchAll(FORMULA)) {
    if (/\\[!-/:-@[-`{-~]/.test(match[0].replaceAll("\\\\", ""))) {
      const line = text.slice(0, match.index).split("\n").length;
      fault(`${file}:${line}`, "Markdown eats a backslash before punctuation (double it)", match[0]);
    }
  }
}

const ENTITIES = { "&lt;": "<", "&gt;": ">", "&amp;": "&", "&quot;": '"', "&#39;": "'", "&#x27;": "'" };
const decode = (html) => html.replace(/&[#\w]+;/g, (entity) => ENTITIES[entity] ?? entity);

function typeset(page, html) {
  const render = (whole, display, inline) => {
    try {
      return katex.renderToString(decode(display ?? inline), { displayMode: display !== undefined });
    } catch (error) {
      fault(page, error.message, whole);
      return whole;
    }
  };
  // Pieces with odd index are code and tags, which stay. A formula that Markdown has split is left with one dollar sign.
  const pieces = html.split(/(<(pre|code|script|style|title)\b[^]*?<\/\2>|<[^>]*>)/);
  return pieces
    .filter((_, i) => i % 3 !== 2)
    .map((piece, i) => {
      if (i % 2 === 1) return piece;
      const done = piece.replace(FORMULA, render);
      if (done.replace(/<annotation.*?<\/annotation>/g, "").includes("$")) fault(page, "half a formula", piece);
      return done;
    })
    .join("");
}

for (const file of [...files("crates", ".rs"), ...files("docs/site/src", ".md")]) checkSource(file);

const assets = path.join(docFolder, "katex");
fs.mkdirSync(assets, { recursive: true });
fs.cpSync(path.join(katexFolder, "dist/katex.min.css"), path.join(assets, "katex.min.css"));
fs.cpSync(path.join(katexFolder, "dist/fonts"), path.join(assets, "fonts"), { recursive: true });

let typesetPages = 0;
for (const page of files(docFolder, ".html")) {
  const html = fs.readFileSync(page, "utf8");
  if (path.relative(docFolder, page).startsWith("src") || !html.includes("$")) continue;
  const done = typeset(page, html);
  if (done === html) continue;
  const style = path.relative(path.dirname(page), path.join(assets, "katex.min.css")).replaceAll(path.sep, "/");
  fs.writeFileSync(page, done.replace("</head>", `<link rel="stylesheet" href="${style}"></head>`));
  typesetPages += 1;
}
console.log(`${typesetPages} pages typeset`);
process.exit(faults === 0 ? 0 : 1);
