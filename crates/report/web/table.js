// The table of identified.csv: filter, pages, download.

const PAGE = 25;
const HEADS = [
  ["frequency_hz", "Frequency (Hz)"], ["status", "Status"],
  ...unknowns.flatMap(({ columns, real, unit, label }) => {
    const of = label && `${label}: `;
    return [[columns.storage, of + (real ? "value" : `E′${unit && ` (${unit})`}`)], [columns.storage_std, of + (real ? "standard deviation" : "standard deviation of E′")], [columns.loss_factor, `${of}η`], [columns.loss_factor_std, `${of}standard deviation of η`]];
  }),
  ["error", "Error of the response"], ["chi2", "χ²"], ["candidate_count", "Solutions"], ["spectral_radius", "Spectral radius"], ["convergence_radius", "Distance to pole"], ["required_order", "Terms needed"], ["reduction_error", "Reduction error"],
].filter(([name]) => name === "frequency_hz" || name === "status" || column(name));
const tableElement = document.getElementById("rows");
const filterForm = document.getElementById("filter");
let filtered = [];
let page = 0;

const cellText = (name, row) => {
  if (name === "frequency_hz") return digits(data.frequency_hz[row], 7);
  if (name === "status") return statusOf(row).label;
  return digits(column(name)[row]);
};

function filterRows() {
  const wanted = new Set([...filterForm.querySelectorAll("[name=status]:checked")].map(({ value }) => value));
  const limit = (id, otherwise) => {
    const { value } = document.getElementById(id);
    return value === "" ? otherwise : Number(value);
  };
  const [from, to] = [limit("from", -Infinity), limit("to", Infinity)];
  filtered = data.frequency_hz.flatMap((frequency, row) => (frequency >= from && frequency <= to && wanted.has(statusOf(row).name) ? [row] : []));
  page = 0;
  showPage();
}

function showPage() {
  const pages = Math.max(1, Math.ceil(filtered.length / PAGE));
  const body = tableElement.tBodies[0];
  body.replaceChildren(...filtered.slice(page * PAGE, (page + 1) * PAGE).map((row) => {
    const line = document.createElement("tr");
    line.dataset.row = row;
    for (const [name] of HEADS) line.insertCell().textContent = cellText(name, row);
    line.addEventListener("click", () => setCursor(row));
    return line;
  }));
  document.getElementById("rows-shown").textContent = `${filtered.length} of ${data.frequency_hz.length} frequencies`;
  document.getElementById("page").textContent = `Page ${page + 1} of ${pages}`;
  document.getElementById("previous").disabled = page === 0;
  document.getElementById("next").disabled = page + 1 >= pages;
  markRow();
}

/** The row of the cursor, where the page has it. */
function markRow() {
  tableElement.querySelector("[aria-current]")?.removeAttribute("aria-current");
  tableElement.querySelector(`[data-row="${cursorRow}"]`)?.setAttribute("aria-current", "true");
}

function saveTable() {
  const all = ["frequency_hz", "status", ...Object.keys(data.columns)];
  const cell = (name, row) => name === "frequency_hz" ? data.frequency_hz[row] : name === "status" ? statusOf(row).name : column(name)[row];
  download("identified-filtered.csv", "text/csv", csvRow(all) + filtered.map((row) => csvRow(all.map((name) => cell(name, row)))).join(""));
}

const heads = tableElement.tHead.insertRow();
for (const [, text] of HEADS) heads.append(Object.assign(document.createElement("th"), { scope: "col", textContent: text }));
filterForm.addEventListener("input", filterRows);
filterForm.addEventListener("submit", (event) => event.preventDefault());
document.getElementById("table-csv").addEventListener("click", saveTable);
document.getElementById("previous").addEventListener("click", () => ((page -= 1), showPage()));
document.getElementById("next").addEventListener("click", () => ((page += 1), showPage()));
