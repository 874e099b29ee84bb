// SPDX-License-Identifier: GPL-3.0-or-later
// Writes an SVG drawing as a PDF file of one page: as vectors, or as an image where it has what vectors here cannot say.

class NotVector extends Error {}

/// Letters of the font Symbol.
const kSymbols = Object.fromEntries([..."\u03b1a\u03b2b\u03b3g\u03b4d\u03b5e\u03b6z\u03b7h\u03b8q\u03bak\u03bbl\u03bcm\u03bdn\u03bex\u03c0p\u03c1r\u03c3s\u03c4t\u03c6f\u03c7c\u03c8y\u03c9w\u0394D\u03a3S\u2264\u00a3\u2265\u00b3\u221e\u00a5"
  .matchAll(/(.)(.)/gu)].map(([, letter, code]) => [letter, code]));
/// Of WinAnsi, those that are not in their places of Latin 1; and what stands in for others.
const kAnsi = { "\u2013": "\u0096", "\u2014": "\u0097", "\u2212": "\u0096", "\u2026": "\u0085", "\u2022": "\u0095", "\u2009": " ", "\u2018": "\u0091",
  "\u2019": "\u0092", "\u201c": "\u0093", "\u201d": "\u0094" };

const pdfNumber = (v) => {
  if (!Number.isFinite(v)) throw new NotVector(`a number that is ${v}`);
  return String(Number(v.toFixed(4)));
};
const pdfNumbers = (...values) => values.map(pdfNumber).join(" ");

/// Pieces of a text by font: /F (Helvetica) or /S (Symbol).
function textRuns(text) {
  const runs = [];
  for (const letter of text) {
    const font = letter in kSymbols ? "S" : "F", code = kSymbols[letter] || kAnsi[letter] || letter;
    if (code.charCodeAt(0) > 255 || code.length > 1) throw new NotVector(`the letter ${letter}`);
    if (runs.length === 0 || runs[runs.length - 1].font !== font) runs.push({ font, codes: "" });
    runs[runs.length - 1].codes += code.replace(/[\\()]/g, "\\$&");
  }
  return runs;
}

/// Operators of a path's data.
function pathOperators(data) {
  const words = data.match(/[a-zA-Z]|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?/g) || [], out = [];
  let at = [0, 0], start = [0, 0], command = "", i = 0;
  const number = () => Number(words[i++]);
  const point = (relative) => {
    const [x, y] = [number(), number()];
    return relative ? [at[0] + x, at[1] + y] : [x, y];
  };
  const line = (to) => out.push(`${pdfNumbers(...(at = to))} l`);
  while (i < words.length) {
    const named = /[a-zA-Z]/.test(words[i]);
    if (named) command = words[i++];
    const relative = command === command.toLowerCase(), kind = command.toUpperCase();
    if (kind === "Z") {
      out.push("h");
      at = start;
    } else if (kind === "M" && named) {
      start = at = point(relative);
      out.push(`${pdfNumbers(...at)} m`);
    } else if (kind === "M" || kind === "L") line(point(relative));
    else if (kind === "H") line([number() + (relative ? at[0] : 0), at[1]]);
    else if (kind === "V") line([at[0], number() + (relative ? at[1] : 0)]);
    else if (kind === "C") {
      const [a, b, c] = [point(relative), point(relative), point(relative)];
      out.push(`${pdfNumbers(...a, ...b, ...(at = c))} c`);
    } else if (kind === "Q") {
      const [q, c] = [point(relative), point(relative)], towards = (p) => p.map((v, k) => v + (2 / 3) * (q[k] - v));
      out.push(`${pdfNumbers(...towards(at), ...towards(c), ...c)} c`);
      at = c;
    } else throw new NotVector(`the path command ${command}`);
  }
  return out;
}

function circleOperators(x, y, rx, ry) {
  const k = 0.5522847498;  // four cubics that are nearly a circle
  return [`${pdfNumbers(x + rx, y)} m`, `${pdfNumbers(x + rx, y + k * ry, x + k * rx, y + ry, x, y + ry)} c`,
    `${pdfNumbers(x - k * rx, y + ry, x - rx, y + k * ry, x - rx, y)} c`, `${pdfNumbers(x - rx, y - k * ry, x - k * rx, y - ry, x, y - ry)} c`,
    `${pdfNumbers(x + k * rx, y - ry, x + rx, y - k * ry, x + rx, y)} c`, "h"];
}

/// What a shape is made of, in its own coordinates.
function shapeOperators(node) {
  const value = (name) => (node[name] ? node[name].baseVal.value : 0);
  const corners = () => Array.from(node.points, (p, i) => `${pdfNumbers(p.x, p.y)} ${i === 0 ? "m" : "l"}`);
  switch (node.tagName) {
    case "path": return pathOperators(node.getAttribute("d") || "");
    case "rect": return [`${pdfNumbers(value("x"), value("y"), value("width"), value("height"))} re`];
    case "circle": return circleOperators(value("cx"), value("cy"), value("r"), value("r"));
    case "ellipse": return circleOperators(value("cx"), value("cy"), value("rx"), value("ry"));
    case "line": return [`${pdfNumbers(value("x1"), value("y1"))} m`, `${pdfNumbers(value("x2"), value("y2"))} l`];
    case "polyline": return corners();
    case "polygon": return [...corners(), "h"];
    default: throw new NotVector(`<${node.tagName}>`);
  }
}

/// [r, g, b, opacity] of a computed colour, or null of none.
function paintOf(text) {
  if (text === "none" || text === "transparent") return null;
  const numbers = /^rgba?\(([^)]*)\)$/.exec(text);
  if (!numbers) throw new NotVector(`the paint ${text}`);
  const [r, g, b, a = 1] = numbers[1].split(/[\s,/]+/).map(Number);
  return a === 0 ? null : [r / 255, g / 255, b / 255, a];
}

/// The content of a page, from nodes that are laid out.
class PdfContent {
  constructor(height) {
    Object.assign(this, { height, lines: [], opacities: [], images: [] });
  }
  opacity(fill, stroke) {
    const text = `/ca ${pdfNumber(fill)} /CA ${pdfNumber(stroke)}`;
    if (!this.opacities.includes(text)) this.opacities.push(text);
    return `/G${this.opacities.indexOf(text)} gs`;
  }
  add(node) {
    const style = getComputedStyle(node);
    if (style.display === "none") return;
    for (const name of ["clipPath", "mask", "filter", "markerStart", "markerMid", "markerEnd"])
      if (style[name] && style[name] !== "none" && !(name === "mask" && !style[name].includes("url"))) throw new NotVector(name);
    if (["title", "desc", "metadata", "style", "defs"].includes(node.tagName)) return;
    if (["svg", "g"].includes(node.tagName)) {
      if (Number(style.opacity) !== 1) throw new NotVector("the opacity of a group");
      for (const child of node.children) this.add(child);
      return;
    }
    const { a, b, c, d, e, f } = node.getCTM(), k = 0.75;  // points of a pixel
    this.lines.push("q", `${pdfNumbers(k * a, -k * b, k * c, -k * d, k * e, k * (this.height - f))} cm`);
    if (node.tagName === "text") this.addText(node, style);
    else if (node.tagName === "image") this.addImage(node);
    else this.addShape(node, style);
    this.lines.push("Q");
  }
  addShape(node, style) {
    const fill = node.tagName === "line" ? null : paintOf(style.fill), stroke = parseFloat(style.strokeWidth) > 0 ? paintOf(style.stroke) : null;
    if (!fill && !stroke) return;
    const whole = Number(style.opacity);
    this.lines.push(this.opacity(fill ? fill[3] * whole * Number(style.fillOpacity) : 1, stroke ? stroke[3] * whole * Number(style.strokeOpacity) : 1));
    if (fill) this.lines.push(`${pdfNumbers(...fill.slice(0, 3))} rg`);
    if (stroke) this.lines.push(`${pdfNumbers(...stroke.slice(0, 3))} RG ${pdfNumber(parseFloat(style.strokeWidth))} w`,
      `${{ butt: 0, round: 1, square: 2 }[style.strokeLinecap] || 0} J ${{ miter: 0, round: 1, bevel: 2 }[style.strokeLinejoin] || 0} j`,
      `[${style.strokeDasharray === "none" ? "" : pdfNumbers(...style.strokeDasharray.split(",").map(parseFloat))}] 0 d`);
    const odd = style.fillRule === "evenodd" ? "*" : "";
    this.lines.push(...shapeOperators(node), fill && stroke ? `B${odd}` : fill ? `f${odd}` : "S");
  }
  addText(node, style) {
    if ([...node.children].some((child) => child.tagName !== "title")) throw new NotVector("a text of parts");
    const text = [...node.childNodes].filter((n) => n.nodeType === Node.TEXT_NODE).map((n) => n.data).join(""), fill = paintOf(style.fill);
    if (!fill || node.getNumberOfChars() === 0) return;
    const { x, y } = node.getStartPositionOfChar(0), bold = Number(style.fontWeight) >= 600 ? "B" : "F";
    this.lines.push(this.opacity(fill[3] * Number(style.opacity), 1), `${pdfNumbers(...fill.slice(0, 3))} rg`, "BT", `1 0 0 -1 ${pdfNumbers(x, y)} Tm`);
    for (const { font, codes } of textRuns(text)) this.lines.push(`/${font === "S" ? "S" : bold} ${pdfNumber(parseFloat(style.fontSize))} Tf (${codes}) Tj`);
    this.lines.push("ET");
  }
  addImage(node) {
    const [x, y, w, h] = ["x", "y", "width", "height"].map((name) => node[name].baseVal.value);
    this.lines.push(this.opacity(1, 1), `${pdfNumbers(w, 0, 0, -h, x, y + h)} cm`, `/I${this.images.length} Do`);
    this.images.push(node.href.baseVal);
  }
}

async function deflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new CompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/// Bytes of a file, with the places of its objects.
class PdfFile {
  constructor() {
    this.parts = [];
    this.length = 0;
    this.places = [];
    this.put("%PDF-1.5\n%\u00e2\u00e3\u00cf\u00d3\n");
  }
  put(part) {
    const bytes = typeof part === "string" ? Uint8Array.from(part, (c) => c.charCodeAt(0)) : part;
    this.parts.push(bytes);
    this.length += bytes.length;
  }
  /// Returns the object's number.
  object(text, stream = null) {
    this.places.push(this.length);
    this.put(`${this.places.length} 0 obj\n${text}\n`);
    if (stream) {
      this.put("stream\n");
      this.put(stream);
      this.put("\nendstream\n");
    }
    this.put("endobj\n");
    return this.places.length;
  }
  end(catalog) {
    const at = this.length, n = this.places.length + 1;
    this.put(`xref\n0 ${n}\n0000000000 65535 f \n${this.places.map((p) => `${String(p).padStart(10, "0")} 00000 n \n`).join("")}`);
    this.put(`trailer\n<< /Size ${n} /Root ${catalog} 0 R >>\nstartxref\n${at}\n%%EOF\n`);
    return new Blob(this.parts, { type: "application/pdf" });
  }
}

/// An image on white, as an object of the file.
async function pdfImage(file, address) {
  const canvas = await canvasOf(address), { width, height } = canvas;
  const dots = canvas.getContext("2d").getImageData(0, 0, width, height).data, rgb = new Uint8Array(3 * width * height);
  for (let i = 0, j = 0; i < dots.length; i += 4) {
    rgb[j++] = dots[i];
    rgb[j++] = dots[i + 1];
    rgb[j++] = dots[i + 2];
  }
  const data = await deflate(rgb);
  return file.object(`<< /Type /XObject /Subtype /Image /Width ${width} /Height ${height} /ColorSpace /DeviceRGB /BitsPerComponent 8 /Filter /FlateDecode /Length ${data.length} >>`, data);
}

async function pdfFile(content, width, height) {
  const file = new PdfFile(), images = [];
  for (const address of content.images) images.push(await pdfImage(file, address));
  const data = await deflate(Uint8Array.from(content.lines.join("\n"), (c) => c.charCodeAt(0)));
  const stream = file.object(`<< /Filter /FlateDecode /Length ${data.length} >>`, data);
  const font = (name, encoding) => `<< /Type /Font /Subtype /Type1 /BaseFont /${name}${encoding} >>`, ansi = " /Encoding /WinAnsiEncoding";
  const resources = `<< /Font << /F ${font("Helvetica", ansi)} /B ${font("Helvetica-Bold", ansi)} /S ${font("Symbol", "")} >>` +
    ` /ExtGState << ${content.opacities.map((o, i) => `/G${i} << ${o} >>`).join(" ")} >> /XObject << ${images.map((n, i) => `/I${i} ${n} 0 R`).join(" ")} >> >>`;
  const pages = file.places.length + 2;
  const page = file.object(`<< /Type /Page /Parent ${pages} 0 R /MediaBox [0 0 ${pdfNumbers(0.75 * width, 0.75 * height)}] /Contents ${stream} 0 R /Resources ${resources} >>`);
  file.object(`<< /Type /Pages /Kids [${page} 0 R] /Count 1 >>`);
  return file.end(file.object(`<< /Type /Catalog /Pages ${pages} 0 R >>`));
}

/// The drawing stands alone, as standalone() makes it.
async function pdfOf(drawing) {
  const [width, height] = sizeOf(drawing);
  let content = new PdfContent(height);
  try {
    onPaper(drawing, () => content.add(drawing));
  } catch (error) {
    if (!(error instanceof NotVector)) throw error;
    content = new PdfContent(height);
    const image = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}` },
      svg("image", { width, height, href: (await rasterOf(drawing)).toDataURL() }));
    onPaper(image, () => content.add(image));
  }
  return pdfFile(content, width, height);
}
