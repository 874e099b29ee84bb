// SPDX-License-Identifier: GPL-3.0-or-later
// Tables that can be sorted, filtered, saved and printed whole.

/// With as many digits as the interval leaves certain: two of its half-width; else, and where that is next to nothing, those of the column.
function shownDigits(half, digits) {
  const most = Math.max(6, digits + 3);
  if (!(half >= 0.5 * 10 ** -most) || half === Infinity) return digits;
  return Math.min(most, Math.max(0, 1 - Math.floor(Math.log10(half))));
}

/// What stands beside a mean: half the width of its interval, or the ends of what the range of the measure leaves of it.
function shownSpread(value, half, places, [low, high]) {
  const unit = 10 ** -places;
  if (half > 0 && half < unit / 2) return `\u00b1 < ${fixed(unit, places)}`;
  const leaves = value >= low && value <= high && (value - half < low || value + half > high);
  if (!leaves) return `\u00b1 ${fixed(half, places)}`;
  return `[${fixed(Math.max(value - half, low), places)}, ${fixed(Math.min(value + half, high), places)}]`;
}

/// Text of a number and of its half-width, if any.
function shownNumber(value, half, digits, range = [-Infinity, Infinity]) {
  const places = shownDigits(half, digits);
  return [fixed(value, places), half === undefined ? null : shownSpread(value, half, places, range)];
}

const byText = (a, b) => a.localeCompare(b, "en", { numeric: true });

/// Columns of values that fit across a page of paper.
const kColumnsOnPaper = 7;

class TableView {
  constructor(table, metrics, name) {
    Object.assign(this, { table, metrics, sort: null, terms: [] });
    this.all = table.columns.filter((c) => table.rows.some((r) => [r.values, r.published, r.texts || {}].some((of) => c.key in of)));
    this.chosen = (table.shown || []).flatMap((key) => this.all.filter((c) => c.key === key));
    this.body = el("tbody");
    this.headRow = el("tr");
    this.count = el("output", { class: "hint" });
    this.node = el("div", { class: "table" }, this.tools(name), el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": table.title },
      el("table", {}, el("thead", {}, this.headRow), this.body)),
      table.notes.length > 0 ? el("ul", { class: "notes" }, table.notes.map((note) => el("li", {}, note))) : null);
    this.showColumns(this.chosen.length > 0 ? this.chosen : this.all);
  }
  tools(name) {
    const filter = el("input", { type: "search", placeholder: "Filter by case or pipeline", "aria-label": `Filter rows of ${this.table.title}`,
      input: () => {
        this.terms = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
        this.show();
      } });
    const titles = { csv: "CSV", tex: "LaTeX", md: "Markdown" };
    const formats = Object.entries(this.table.files).map(([extension, packed]) => [titles[extension] || extension,
      { extension, make: async () => new Blob([await inflate(packed)], { type: "text/plain" }) }]);
    return el("div", { class: "table-tools" }, filter, this.columnChoice(), this.count, buttonsOf(name, Object.fromEntries(formats)));
  }
  /// Those of the table in print, which the experiment may ask for, come first.
  columnChoice() {
    if (this.chosen.length === 0 || this.chosen.length === this.all.length) return null;
    const choice = el("select", { "data-choice": "columns", change: () => this.showColumns(choice.value === "all" ? this.all : this.chosen) },
      el("option", { value: "chosen" }, "as in print"), el("option", { value: "all" }, `all ${this.all.length}`));
    return el("label", { class: "hint" }, "Columns ", choice);
  }
  showColumns(columns) {
    this.columns = columns;
    const { heads } = this.table;
    this.heads = [...heads.map((title, i) => this.head(title, i === 0 ? "group" : "name")), ...columns.map((c) => this.head(c.title, c.key))];
    this.headRow.replaceChildren(...this.heads);
    if (this.sort && !this.heads.some((head) => head.dataset.key === this.sort.key)) this.sort = null;
    this.showSort();
  }
  head(title, key) {
    const metric = this.metrics[key];
    const node = el("th", { scope: "col", "data-key": key }, el("button", { class: "sort", title: (metric ? `${metric.source}. ` : "") + "Click to sort",
      click: () => this.sortBy(key) }, title));
    return node;
  }
  /// Up, down, and as the table was.
  sortBy(key) {
    this.sort = !this.sort || this.sort.key !== key ? { key, sign: 1 } : this.sort.sign === 1 ? { key, sign: -1 } : null;
    this.showSort();
  }
  showSort() {
    for (const head of this.heads) {
      if (this.sort && head.dataset.key === this.sort.key) head.setAttribute("aria-sort", this.sort.sign === 1 ? "ascending" : "descending");
      else head.removeAttribute("aria-sort");
    }
    this.show();
  }
  /// Those that the filter leaves, in their order; rows without a value come last.
  rows() {
    const rows = this.table.rows.filter((row) => this.terms.every((term) => `${row.group} ${row.name}`.toLowerCase().includes(term)));
    if (!this.sort) return rows;
    const { key, sign } = this.sort;
    if (key === "group" || key === "name") return rows.sort((a, b) => sign * byText(a[key], b[key]));
    const known = (row) => row.values[key] !== undefined;
    return rows.sort((a, b) => (known(a) && known(b) ? sign * (a.values[key] - b.values[key]) : known(b) - known(a)));
  }
  show() {
    const rows = this.rows();
    this.body.replaceChildren(...this.lines(rows, this.columns));
    this.count.textContent = this.terms.length > 0 ? `${rows.length} of ${this.table.rows.length} rows` : "";
  }
  lines(rows, columns) {
    return rows.map((row, i) => {
      const line = el("tr", { class: row.group === "published" ? "published" : null });
      const first = this.sort !== null || i === 0 || rows[i - 1].group !== row.group;
      const next = rows.slice(i).findIndex((other) => other.group !== row.group);
      if (first) line.append(el("th", { scope: "row", class: "group", rowspan: this.sort ? null : next < 0 ? rows.length - i : next }, row.group));
      line.append(el("th", { scope: "row", class: "word" }, row.name), ...this.cells(row, columns));
      return line;
    });
  }
  cells(row, columns) {
    if (row.failure || row.skipped)
      return [el("td", { colspan: columns.length, class: `reason ${row.failure ? "failed" : "skipped"}` }, row.failure ? `failed: ${row.failure}` : `skipped: ${row.skipped}`)];
    return columns.map((column) => this.cell(row, column));
  }
  cell(row, { key, digits, range }) {
    const ours = row.values[key], published = row.published[key];
    const stands = row.texts && row.texts[key];  // for a value, as the table's own files have it
    const [text, around] = stands ? [stands, null] : ours === undefined ? ["\u2013", null] : shownNumber(ours, row.half_widths[key], digits, range);
    const beside = published === undefined ? null : el("span", { class: "beside" },
      ours === undefined ? `published ${published}` : `${published}, ${ours >= published ? "+" : ""}${fixed(ours - published, digits)}`);
    return el("td", {}, row.bold.includes(key) ? el("b", {}, text) : text, around ? el("span", { class: "beside" }, around) : null, beside);
  }
  /// The same rows for paper: so few columns at a time that none is cut off.
  printed() {
    const blocks = [];
    for (let i = 0; i < this.columns.length; i += kColumnsOnPaper) {
      const columns = this.columns.slice(i, i + kColumnsOnPaper), titles = [...this.table.heads, ...columns.map((c) => c.title)];
      blocks.push(el("table", {}, el("thead", {}, el("tr", {}, titles.map((t) => el("th", { scope: "col" }, t)))), el("tbody", {}, this.lines(this.rows(), columns))));
    }
    return el("div", { class: "on-paper" }, blocks);
  }
  beforePrint() {
    this.paper = this.printed();
    this.node.querySelector(".scroll").after(this.paper);
  }
  afterPrint() {
    if (this.paper) this.paper.remove();
    this.paper = null;
  }
}
