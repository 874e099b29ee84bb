// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the page together.

const kAboutLetters = {
  F: "points go in layer by layer, so that triangles become equilateral",
  D: "points go in layer by layer, so that triangles become halves of squares that follow the wanted directions",
  P: "points are packed as in a grid along the wanted directions; D fills what is left",
  L: "moves the points until the region nearest to each is a square along the wanted directions",
  B: "merges pairs of triangles to quads, the best pairs all over the mesh together (Blossom), then removes obvious flaws",
  G: "merges pairs of triangles to quads, the best first, one by one; some triangles are left",
  T: "splits, joins and moves the triangles' edges until they are halves of squares, then merges good pairs; some triangles are left",
  C: "changes how quads hang together, so that fewer vertices are irregular",
  Q: "fills the surroundings of irregular vertices anew, so that those that are not necessary go",
  O: "moves all vertices together for better shapes and sizes",
};

function growthNode(study, words) {
  const { growth } = study, laws = growth.some((g) => g.law);
  return el("div", {}, el("h3", {}, "Time against size"), el("div", { class: "growth" },
    chartFigure("", fileName(study.name, "time-against-size"), growthChart(growth, words)), growthLaws(growth)), el("p", { class: "caption" },
    "Seconds from reading the model to the finished mesh, all threads added up, by the number of elements; a dot for each cell. ",
    laws ? "Dashed: the power of N that fits a case best. An exponent of 1 means that twice as many elements take twice as long."
      : "No case comes in sizes enough here to say by which power of N time grows."));
}

/// With fewer cells of a word there is nothing to see in a chart of time against size.
const kFewestCells = 3;
const countCells = (study, word) => study.growth.reduce((n, g) => n + (g.word === word ? g.points.length : 0), 0);

/// A file's drawing as a figure that stands alone, without what a drawing may not do on this page.
function foreignDrawing(text) {
  const drawing = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  if (drawing.tagName !== "svg") throw new Error("it is no SVG drawing");
  for (const node of drawing.querySelectorAll("script, foreignObject, iframe, animate, set")) node.remove();
  for (const node of [drawing, ...drawing.querySelectorAll("*")])
    for (const { name, value } of [...node.attributes])
      if (/^on/i.test(name) || (/href$/i.test(name) && !/^(#|data:image\/)/.test(value))) node.removeAttribute(name);
  const [width, height] = sizeOf(drawing);
  if (!drawing.hasAttribute("viewBox")) drawing.setAttribute("viewBox", `0 0 ${width} ${height}`);
  drawing.setAttribute("width", width);
  drawing.setAttribute("height", height);
  return document.importNode(drawing, true);
}

function drawingsNode(study) {
  const shown = study.drawings.filter((drawing) => drawing.svg !== undefined);
  if (shown.length === 0) return [];
  return [el("h3", {}, "Figures"), el("div", { class: "drawings" }, shown.map(({ name, svg: text }) => el("figure", {},
    el("img", { src: svgAddress(text), alt: name, loading: "lazy" }), el("figcaption", { class: "head" }, name,
      saveButtons(fileName(study.name, name), { drawing: () => foreignDrawing(text) })))))];
}

/// What is not on this page, and where it is: nothing goes without a word.
function leftOut(study) {
  const cells = study.sheets.flatMap((sheet) => sheet.seeds.flatMap((seed) => seed.cells)), lines = [];
  const count = (n, one, many, rest) => n > 0 && lines.push(`${grouped(n)} ${n === 1 ? one : many} ${rest}`);
  count(cells.filter((c) => c.no_picture).length, "mesh has", "meshes have", "no picture here; the place of each says why.");
  count(study.cells_left_out || 0, "more cell counts", "more cells count", "in the tables, but this page has no room to show them one by one.");
  if (study.samples === "left out") lines.push("The values of single cells, which charts of their spread need, are too many for this page.");
  for (const drawing of study.drawings) if (drawing.left_out) lines.push(`The figure ${drawing.name} is too large for this page; it lies in ${drawing.left_out}.`);
  return lines.length === 0 ? [] : [el("div", { class: "left-out caption" }, el("b", {}, "Left out"), el("ul", {}, lines.map((line) => el("li", {}, line))))];
}

/// `parts` gets what draws itself when it comes in sight; `tables` those that print themselves.
function studyNode(study, glossary, parts, tables) {
  const words = [...new Set(study.sheets.flatMap((sheet) => sheet.seeds.flatMap((seed) => seed.cells.map((cell) => cell.word))))];
  const section = el("section", { class: "study", id: study.name }, el("h2", {}, study.title));
  const [table, pairs, hypotheses] = study.tables;
  const add = (part) => {
    parts.push(part);
    section.append(part.node);
  };
  const view = (data, metrics, name) => {
    tables.push(new TableView(data, metrics, fileName(study.name, name)));
    return tables[tables.length - 1].node;
  };
  if (table) section.append(view(table, glossary.byKey, "table"));
  if (hypotheses) section.append(view(hypotheses, {}, "hypotheses"));
  if (pairs) section.append(el("details", { class: "pairs" }, el("summary", {}, "Pairs of words, compared over all cases"), view(pairs, {}, "pairs")));
  section.append(...leftOut(study));
  if (study.samples && study.samples !== "left out") add(new SpreadView(study));
  if (study.growth.some((g) => g.law || countCells(study, g.word) >= kFewestCells)) section.append(growthNode(study, words));
  section.append(...drawingsNode(study));
  for (const data of study.sheets) add(new Sheet(data, words, glossary, table ? table.columns : []));
  return section;
}

function contentsNode(data) {
  const link = (id, name, kind) => el("a", { href: `#${encodeURIComponent(id)}`, class: kind }, name);
  return [link("reading", "How to read this page", ""), ...data.studies.flatMap((study) => [link(study.name, study.title, "of-study"),
    ...study.sheets.map((sheet) => link(sheet.id, [sheet.name, ...sheet.variant].join(", ") + (sheet.seeds.length > 1 ? ` (${sheet.seeds.length} seeds)` : ""), "of-sheet"))])];
}

function fillReading(data) {
  document.getElementById("letters").append(...data.letters.flatMap(({ letter, name }) => [el("dt", {}, letter),
    el("dd", {}, kAboutLetters[letter] ? `${name}: ${kAboutLetters[letter]}` : name)]));
  document.querySelectorAll(".examples [data-of]").forEach((shape) => Object.entries(byEta(Number(shape.dataset.of))).forEach(([k, v]) => shape.setAttribute(k, v)));
  document.getElementById("colours").append(colourBar());
  document.querySelector(".dot.less").style.background = data.marks["one less"];
  document.querySelector(".dot.more").style.background = data.marks["one more"];
}

/// Paper is white, has no scroll bars, and shows tables whole.
function preparePrinting(tables, drawAll) {
  let theme;
  addEventListener("beforeprint", () => {
    theme = document.documentElement.dataset.theme;
    document.documentElement.dataset.theme = "light";
    palette.changed();
    for (const table of tables) table.beforePrint();
  });
  addEventListener("afterprint", () => {
    if (theme === undefined) delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme;
    palette.changed();
    for (const table of tables) table.afterPrint();
  });
  document.getElementById("print").addEventListener("click", () => drawAll().then(() => window.print()));
}

/// Draws what comes in sight; returns what draws all the rest.
function drawInSight(parts) {
  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries)
      if (entry.isIntersecting) parts.find((part) => part.node === entry.target).draw();
  }, { rootMargin: "600px" });
  for (const part of parts) watcher.observe(part.node);
  return async () => {
    for (const part of parts) await part.draw();
    document.documentElement.dataset.drawn = "all";
  };
}

function main() {
  const data = JSON.parse(document.getElementById("data").textContent);
  Object.assign(kMarks, data.marks);
  kColourMaps.viridis = data.colours;
  data.byKey = Object.fromEntries(data.metrics.map((metric) => [metric.key, metric]));
  if (data.studies.length === 1) {
    document.getElementById("top").textContent = data.studies[0].title;
    document.title = data.studies[0].title;
  }
  const parts = [], tables = [];
  fillReading(data);
  document.getElementById("contents").append(...contentsNode(data));
  document.getElementById("studies").append(...data.studies.map((study) => studyNode(study, data, parts, tables)));
  for (const [folder, reason] of data.left_out)
    document.getElementById("studies").append(el("p", { class: "failed" }, `${folder} is left out: ${reason}`));
  document.getElementById("origin").append(`Delquad ${data.program.delquad}, commit ${data.program.commit}, ${data.program.compiler}.`);
  const drawAll = drawInSight(parts);
  preparePrinting(tables, drawAll);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => palette.changed());
  if (location.hash === "#everything") drawAll();
}
main();
