// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/experiments/report/report_results.h"
#include "tests/support/files.h"

namespace delquad::testing_support {

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// Runs the browser on a page whose pictures are all drawn; what its console says goes to stderr.
inline ProgramResult browse(const std::string& browser, const TemporaryFolder& folder,
                            const std::string& page, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"--headless",
                                        "--no-sandbox",
                                        "--use-angle=swiftshader",
                                        "--enable-unsafe-swiftshader",
                                        "--user-data-dir=" + (folder / "browser").string(),
                                        "--enable-logging=stderr",
                                        "--disable-background-networking"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  arguments.push_back("file://" + (folder / page).string() + "#everything");
  return run_program(browser, {arguments, 0, {}});
}

/// Returns the contents of a page after everything in it was drawn.
inline ProgramResult open_page(const std::string& browser, const TemporaryFolder& folder,
                               const std::string& page) {
  return browse(browser, folder, page, {"--dump-dom", "--virtual-time-budget=60000"});
}

struct Browser {
  std::string program, missing;  ///< one of them is empty
};

/// Looked for once. One that is there and does not start lacks a part.
inline const Browser& find_browser() {
  static const Browser found = [] {
    for (const char* path : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"}) {
      if (!std::filesystem::exists(path)) continue;
      const TemporaryFolder folder;
      write_text(folder / "empty.html", "<p>It starts.</p>");
      const ProgramResult shown = open_page(path, folder, "empty.html");
      if (count(shown.out, "It starts.") == 1) return Browser{path, ""};
      return Browser{"", std::string(path) + " does not start: " + shown.err.substr(0, 300)};
    }
    return Browser{"", "Chromium is not installed"};
  }();
  return found;
}

#define NEEDS_BROWSER(browser)                         \
  const std::string& browser = find_browser().program; \
  if (browser.empty()) GTEST_SKIP() << find_browser().missing

/// Stands for a reader in the page: `all` for document.querySelectorAll, clicks, choices, and saved files as
/// base64 by name.
inline constexpr const char* kReadersHands = R"(
const all = (selector, of = document) => [...of.querySelectorAll(selector)];
const wait = (ms) => new Promise((done) => setTimeout(done, ms));
const saved = {};
const blobs = new Map(), makeAddress = URL.createObjectURL;
URL.createObjectURL = (blob) => {
  const address = makeAddress(blob);
  blobs.set(address, blob);
  return address;
};
HTMLAnchorElement.prototype.click = function () {
  const reader = new FileReader();
  reader.onload = () => (saved[this.download] = reader.result.slice(reader.result.indexOf(",") + 1));
  reader.readAsDataURL(blobs.get(this.href));
};
// Other threads, which make files, keep to the real clock; that of the page runs ahead unless it has work.
const work = () => {
  let sum = 0;
  for (let i = 0; i < 3e7; ++i) sum += i % 7;
  return sum;
};
const save = async (button) => {
  const before = Object.keys(saved).length, complaint = button.closest(".save").querySelector(".failed");
  button.click();
  for (let i = 0; i < 100 && Object.keys(saved).length === before && complaint.textContent === ""; ++i) {
    work();
    await wait(20);
  }
  return Object.keys(saved).slice(before)[0];
};
const choose = (select, value) => {
  select.value = value;
  select.dispatchEvent(new Event("change"));
};
)";

/// Opens r.html for each script, one after the other in one start of the browser. Does as the script says
/// when all is drawn, and returns the values that scripts return.
inline std::vector<Json> ask_page(const std::string& browser, const TemporaryFolder& folder,
                                  const std::vector<std::string>& scripts,
                                  const std::string& window = "800,600") {
  // Without a screen there are no frames to wait for.
  const std::string page = "<script>window.requestAnimationFrame = (act) => setTimeout(act, 10);</script>" +
                           read_text(folder / "r.html") + "<script type=\"module\">" + kReadersHands;
  for (std::size_t k = 0; k < scripts.size(); ++k)
    write_text(folder / ("asked_" + std::to_string(k) + ".html"),
               page + "const read = async () => {" + scripts[k] +
                   "\n};\nconst act = async () => {\n"
                   "  if (document.documentElement.dataset.drawn !== 'all') return setTimeout(act, 50);\n"
                   "  let answer;\n  try { answer = await read(); } catch (error) { answer = "
                   "String(error.stack); }\n"
                   "  parent.postMessage(answer, '*');\n};\nact();</script>");
  write_text(folder / "asked.html", R"(<style>
iframe { position: fixed; inset: 0; width: 100%; height: 100%; border: 0; }
</style><script type="module">
const answers = [];
for (let k = 0; k < )" + std::to_string(scripts.size()) +
                                        R"(; ++k) {
  const frame = Object.assign(document.createElement("iframe"), { src: `asked_${k}.html#everything` });
  answers.push(await new Promise((done) => {
    window.onmessage = (event) => done(event.data);
    document.body.append(frame);
  }));
  frame.remove();
}
const text = JSON.stringify(answers).replace(/[<>&\u0080-\uffff]/g, (c) => "\\u" + c.charCodeAt(0).toString(16).padStart(4, "0"));
document.body.append(Object.assign(document.createElement("pre"), { id: "answer", textContent: text }));
</script>)");
  const ProgramResult shown = browse(browser, folder, "asked.html",
                                     {"--dump-dom", "--window-size=" + window,
                                      "--virtual-time-budget=" + std::to_string(60000 * scripts.size())});
  EXPECT_EQ(count(shown.err, "CONSOLE"), 0u) << shown.err;
  const std::string begin = "<pre id=\"answer\">";
  const auto at = shown.out.find(begin);
  if (at == std::string::npos) {
    ADD_FAILURE() << "the page gave no answer: " << shown.err;
    return std::vector<Json>(scripts.size());
  }
  const auto from = at + begin.size();
  return Json::parse(shown.out.substr(from, shown.out.find("</pre>", from) - from)).get<std::vector<Json>>();
}

}  // namespace delquad::testing_support
