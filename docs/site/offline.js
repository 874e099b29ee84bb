// SPDX-License-Identifier: GPL-3.0-or-later
// Pages that are opened as files may neither fetch the index of the search nor start a worker: the index comes with this script, the worker runs in a frame.
var __search = { index: Promise.resolve(INDEX) };
if (location.protocol === "file:")
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.body.appendChild(document.createElement("iframe"));
      frame.hidden = true;
      const inside = frame.contentWindow;
      inside.document.write("<body></body>");
      inside.document.close();
      inside.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
      inside.importScripts = (...urls) =>
        urls.reduce((before, script) => before.then(() => this.load(inside, script)), Promise.resolve());
      this.ready = this.load(inside, url);
      this.inside = inside;
    }
    load(inside, url) {
      return new Promise((loaded) => {
        const script = inside.document.createElement("script");
        Object.assign(script, { src: url, onload: loaded });
        inside.document.body.appendChild(script);
      });
    }
    postMessage(data) {
      this.ready.then(() => this.inside.dispatchEvent(new MessageEvent("message", { data })));
    }
    terminate() {}
  };
