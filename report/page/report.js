// Puts the page together.

const kAboutLetters = {
  F: "points go in layer by layer, so that triangles become equilateral",
  D: "points go in layer by layer, so that triangles become halves of squares that follow the wanted directions",
  P: "points are packed as in a grid along the wanted directions; D fills what is left",
  L: "moves the points until the region nearest to each is a square along the wanted directions",
  B: "merges pairs of triangles to quads, the best pairs all over the mesh together (Blossom), then removes obvious flaws",
  G: "merges pairs of triangles to quads, the best first, one by one; some triangles are left",
  T: "splits, joins and moves the triangles' edges until they are halves of squares, then merges good pairs; some triangles are left",
  G: "in place of B: merges pairs of triangles, the best first; leaves some",
  T: "in place of B: adapts triangles to halves of squares, then merges good pairs; leaves some",
  C: "changes how quads hang together, so that fewer vertices are irregular",
  O: "moves all vertices together for better shapes and sizes",
};

function tableNode(table, metrics) {
  const columns = table.columns.filter((c) => table.rows.some((r) => c.key in r.values || c.key in r.published));
  const cell = (row, { key, digits }) => {
    const ours = row.values[key], published = row.published[key], half = row.half_widths[key];
    const content = ours === undefined ? "\u2013" : (row.marks[key] === "as good" ? "~" : "") + fixed(ours, digits);
    const around = half === undefined ? null : el("span", { class: "beside" }, `\u00b1 ${fixed(half, digits)}`);
    const beside = published === undefined ? null : el("span", { class: "beside" },
      ours === undefined ? `published ${published}` : `${published}, ${ours >= published ? "+" : ""}${fixed(ours - published, digits)}`);
    return el("td", {}, row.marks[key] === "best" ? el("b", {}, content) : content, around, beside);
  };
  const body = el("tbody");
  table.rows.forEach((row, i) => {
    const first = i === 0 || table.rows[i - 1].group !== row.group;
    const same = table.rows.slice(i).findIndex((other) => other.group !== row.group);
    const line = el("tr", { class: row.group === "published" ? "published" : null });
    if (first) line.append(el("th", { scope: "rowgroup", rowspan: same < 0 ? table.rows.length - i : same }, row.group));
    line.append(el("th", { scope: "row", class: "word" }, row.name));
    if (row.failure || row.skipped)
      line.append(el("td", { colspan: columns.length, class: row.failure ? "failed" : "skipped", style: "text-align:left" },
        row.failure ? `failed: ${row.failure}` : `skipped: ${row.skipped}`));
    else line.append(...columns.map((column) => cell(row, column)));
    body.append(line);
  });
  const heads = columns.map((c) => el("th", { scope: "col", title: metrics[c.key] ? metrics[c.key].source : null }, c.title));
  return [el("div", { class: "scroll" }, el("table", {}, el("thead", {}, el("tr", {}, table.heads.map((h) => el("th", { scope: "col" }, h)), heads)), body)),
    table.notes.length > 0 ? el("ul", { class: "notes" }, table.notes.map((note) => el("li", {}, note))) : null];
}

function growthNode(growth, words) {
  const laws = growth.some((g) => g.law);
  return el("div", {}, el("h3", {}, "Time against size"), growthChart(growth, words), el("p", { class: "caption" },
    "Seconds from reading the model to the finished mesh, all threads added up, by the number of elements; a dot for each cell. ",
    laws ? "Dashed: the power of N that fits a case best. An exponent of 1 means that twice as many elements take twice as long."
      : "No case comes in sizes enough here to say by which power of N time grows."));
}

/// With fewer cells of a word there is nothing to see in a chart of time against size.
const kFewestCells = 3;
const countCells = (study, word) => study.growth.reduce((n, g) => n + (g.word === word ? g.points.length : 0), 0);

function drawingsNode(drawings) {
  return el("div", { class: "drawings" }, drawings.map(({ name, svg: text }) => el("figure", {},
    el("img", { src: `data:image/svg+xml,${encodeURIComponent(text)}`, alt: name, loading: "lazy" }), el("figcaption", {}, name))));
}

function studyNode(study, glossary, sheets) {
  const words = [...new Set(study.sheets.flatMap((sheet) => sheet.cells.map((cell) => cell.word)))];
  const section = el("section", { class: "study", id: study.name }, el("h2", {}, study.title));
  const [table, pairs] = study.tables;
  if (table) section.append(...tableNode(table, glossary.byKey).filter(Boolean));
  if (pairs) section.append(el("details", { class: "pairs" }, el("summary", {}, "Pairs of words, compared over all cases"), ...tableNode(pairs, {})));
  if (study.growth.some((g) => g.law || countCells(study, g.word) >= kFewestCells)) section.append(growthNode(study.growth, words));
  if (study.drawings) section.append(drawingsNode(study.drawings));
  for (const data of study.sheets) {
    const sheet = new Sheet(data, words, glossary);
    sheets.push(sheet);
    section.append(sheet.node);
  }
  if (study.cells_left_out > 0)
    section.append(el("p", { class: "caption" }, `${grouped(study.cells_left_out)} more cells count in the tables, but this page has no room to show them one by one.`));
  return section;
}

function contentsNode(data) {
  const link = (id, name, kind) => el("a", { href: `#${encodeURIComponent(id)}`, class: kind }, name);
  return [link("reading", "How to read this page", ""), ...data.studies.flatMap((study) => [link(study.name, study.title, "of-study"),
    ...study.sheets.map((sheet) => link(sheet.id, [sheet.name, ...sheet.variant].join(", "), "of-sheet"))])];
}

function fillReading(data) {
  document.getElementById("letters").append(...data.letters.flatMap(({ letter, name }) => [el("dt", {}, letter),
    el("dd", {}, kAboutLetters[letter] ? `${name}: ${kAboutLetters[letter]}` : name)]));
  document.getElementById("scale").append(...data.colours.map((c) => el("span", { style: `background:${c}` })),
    el("b", { style: "left:.5rem;color:#fff" }, "\u03b7 = 0"), el("b", { style: "right:.5rem" }, "1"));
  document.querySelector(".dot.less").style.background = data.marks["one less"];
  document.querySelector(".dot.more").style.background = data.marks["one more"];
}

function main() {
  const data = JSON.parse(document.getElementById("data").textContent);
  Object.assign(kMarks, data.marks);
  data.byKey = Object.fromEntries(data.metrics.map((metric) => [metric.key, metric]));
  if (data.studies.length === 1) {
    document.getElementById("top").textContent = data.studies[0].title;
    document.title = data.studies[0].title;
  }
  const sheets = [];
  fillReading(data);
  document.getElementById("contents").append(...contentsNode(data));
  document.getElementById("studies").append(...data.studies.map((study) => studyNode(study, data, sheets)));
  for (const [folder, reason] of data.left_out)
    document.getElementById("studies").append(el("p", { class: "failed" }, `${folder} is left out: ${reason}`));
  document.getElementById("origin").append(`Delquad ${data.program.delquad}, commit ${data.program.commit}, ${data.program.compiler}.`);

  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries)
      if (entry.isIntersecting) sheets.find((sheet) => sheet.node === entry.target).draw();
  }, { rootMargin: "600px" });
  for (const sheet of sheets) watcher.observe(sheet.node);
  const drawAll = async () => {
    for (const sheet of sheets) await sheet.draw();
    document.documentElement.dataset.drawn = "all";
  };
  document.getElementById("print").addEventListener("click", () => drawAll().then(() => window.print()));
  if (location.hash === "#everything") drawAll();
}
main();
