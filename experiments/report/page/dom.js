// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of the page. Texts of results go in as text, never as markup.

const kSvg = "http://www.w3.org/2000/svg";

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") node.addEventListener(name, value);
    else if (value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return node;
}
const el = (tag, attributes = {}, ...children) => fill(document.createElement(tag), attributes, children);
const svg = (tag, attributes = {}, ...children) => fill(document.createElementNS(kSvg, tag), attributes, children);

const fixed = (value, digits) => value.toFixed(digits).replace("-", "\u2212");
/// A count with thin spaces between thousands.
const grouped = (value) => Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, "\u2009");
const seconds = (value) => (value >= 10 ? fixed(value, 1) : value >= 0.1 ? fixed(value, 2) : fixed(value, 3)) + "\u00a0s";
