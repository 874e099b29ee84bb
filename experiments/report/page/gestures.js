// SPDX-License-Identifier: GPL-3.0-or-later
// What keys, wheel and fingers do with a picture. A view has move, zoomBy, reset and redraw.

const kArrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function listenToKeys(canvas, view) {
  canvas.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    if (e.key === "+" || e.key === "=") view.zoomBy(1.4);
    else if (e.key === "-") view.zoomBy(1 / 1.4);
    else if (e.key === "0" || e.key === "r" || e.key === "R") view.reset();
    else if (e.key in kArrows) view.move(...kArrows[e.key]);
    else return;
    e.preventDefault();
  });
}

function listenToZoom(canvas, view) {
  canvas.addEventListener("wheel", (e) => {
    if (!e.ctrlKey && !e.metaKey) return;
    e.preventDefault();
    view.zoomBy(Math.exp(-e.deltaY / 300));
  }, { passive: false });
  canvas.addEventListener("dblclick", () => view.zoomBy(2));
  listenToKeys(canvas, view);
  listenToPinch(canvas, view);
}

/// Two fingers zoom. Before a touch has chosen the picture, its fingers scroll the page (`touch-action` of the style).
function listenToPinch(canvas, view) {
  const fingers = new Map();
  const apart = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  canvas.addEventListener("pointerdown", (e) => {
    if (e.pointerType === "touch") fingers.set(e.pointerId, [e.clientX, e.clientY]);
    canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener("pointermove", (e) => {
    if (!fingers.has(e.pointerId)) return;
    const before = fingers.size === 2 ? apart() : 0;
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    if (before > 0) view.zoomBy(apart() / before);
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (e) => fingers.delete(e.pointerId));
}

function redrawWhenResized(canvas, view) {
  const sizeNow = () => `${canvas.clientWidth} ${canvas.clientHeight}`;
  let size = sizeNow();
  new ResizeObserver(() => {
    if (sizeNow() === size) return;
    size = sizeNow();
    view.redraw();
  }).observe(canvas);
}
