// SPDX-License-Identifier: GPL-3.0-or-later
// Figures that can be saved: as they are on white paper, whatever the page looks like.

/// Calls use() while a node is laid out, out of sight, in the colours of paper.
function onPaper(node, use) {
  const paper = el("div", { class: "paper", "aria-hidden": "true" }, node);
  document.body.append(paper);
  try {
    return use(node);
  } finally {
    paper.remove();
  }
}

const kFigureStyles = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray", "opacity", "font-size", "font-weight",
  "font-family", "text-anchor"];

function sizeOf(drawing) {
  const box = (drawing.getAttribute("viewBox") || "").trim().split(/[\s,]+/).map(Number);
  const given = ["width", "height"].map((name) => parseFloat(drawing.getAttribute(name)));
  return box.length === 4 && box.every(Number.isFinite) ? box.slice(2) : given.every((v) => v > 0) ? given : [300, 150];
}

/// A copy that needs no style sheet, in its own size.
function standalone(drawing) {
  const copy = drawing.cloneNode(true), [width, height] = sizeOf(drawing);
  Object.entries({ xmlns: kSvg, width, height }).forEach(([name, value]) => copy.setAttribute(name, value));
  onPaper(copy, () => {
    for (const node of copy.querySelectorAll("path, rect, circle, line, polygon, text")) {
      const style = getComputedStyle(node), wanted = kFigureStyles.map((name) => [name, style.getPropertyValue(name)]);
      node.removeAttribute("class");
      node.removeAttribute("style");
      for (const [name, value] of wanted) if (name.startsWith("font") || name === "text-anchor" ? node.tagName === "text" : true) node.setAttribute(name, value);
    }
  });
  copy.removeAttribute("class");
  return copy;
}

const svgText = (drawing) => new XMLSerializer().serializeToString(drawing);
const svgAddress = (text) => `data:image/svg+xml,${encodeURIComponent(text)}`;

/// An image by its address, `scale` times as large, on white.
async function canvasOf(address, scale = 1) {
  const image = new Image();
  image.src = address;
  await image.decode();
  const canvas = el("canvas", { width: Math.ceil(image.naturalWidth * scale), height: Math.ceil(image.naturalHeight * scale) });
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(image, 0, 0, canvas.width, canvas.height);
  return canvas;
}

const kDotsAcross = 2400;  // of an image that is saved
const rasterOf = (drawing) => canvasOf(svgAddress(svgText(drawing)), kDotsAcross / sizeOf(drawing)[0]);

const blobOf = (canvas) => new Promise((done, fail) =>
  canvas.toBlob((blob) => (blob ? done(blob) : fail(new Error("the browser makes no image of this size"))), "image/png"));

const fileName = (...parts) => parts.filter((p) => p !== "").join("-").replace(/[^A-Za-z0-9@=.,_+-]+/g, "_");

function save(name, blob) {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

/// A source of a figure has drawing(), an SVG that stands alone, and may have canvas(), a better image of the same.
const chartSource = (chart) => ({ drawing: () => standalone(chart()) });

const kFigureFormats = {
  SVG: async (source) => new Blob([svgText(await source.drawing())], { type: "image/svg+xml" }),
  PNG: async (source) => blobOf(source.canvas ? await source.canvas() : await rasterOf(await source.drawing())),
  PDF: async (source) => pdfOf(await source.drawing()),
};

/// Buttons that make a file each; what goes wrong is said beside them.
function buttonsOf(name, formats) {
  const complaint = el("span", { class: "failed", role: "status" });
  return el("span", { class: "save" }, Object.entries(formats).map(([format, { extension, make }]) => el("button", {
    "data-format": extension, title: `Save ${name}.${extension}`, "aria-label": `Save ${name} as ${format}`,
    click: async () => {
      complaint.textContent = "";
      try {
        save(`${name}.${extension}`, await make());
      } catch (error) {
        complaint.textContent = `It cannot be saved: ${error.message}`;
        console.error(error);
      }
    } }, format)), complaint);
}

const saveButtons = (name, source) => buttonsOf(name, Object.fromEntries(Object.entries(kFigureFormats).map(([format, make]) =>
  [format, { extension: format.toLowerCase(), make: () => make(source) }])));

/// A chart below its title, with its buttons; `more`: what explains it.
function chartFigure(title, name, chart, ...more) {
  return el("figure", { class: "of-chart" }, el("div", { class: "head" }, el("h4", {}, title), saveButtons(name, chartSource(() => chart))), chart, more);
}
