#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/report/report_results.h"

namespace delquad::testing_support {

inline std::string find_browser() {
  for (const char* path : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"})
    if (std::filesystem::exists(path)) return path;
  return "";
}

#define NEEDS_BROWSER(browser)                \
  const std::string browser = find_browser(); \
  if (browser.empty()) GTEST_SKIP() << "Chromium is not installed"

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// Runs the browser on a page whose pictures are all drawn; what its console says goes to stderr.
inline ProgramResult browse(const std::string& browser, const TemporaryFolder& folder,
                            const std::string& page, std::vector<std::string> more) {
  std::vector<std::string> arguments = {"--headless",
                                        "--no-sandbox",
                                        "--use-angle=swiftshader",
                                        "--enable-unsafe-swiftshader",
                                        "--user-data-dir=" + (folder / "browser").string(),
                                        "--enable-logging=stderr",
                                        "--disable-background-networking",
                                        "--virtual-time-budget=60000"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  arguments.push_back("file://" + (folder / page).string() + "#everything");
  return run_program(browser, {arguments, 0, {}});
}

/// What a page consists of after everything in it was drawn.
inline ProgramResult open_page(const std::string& browser, const TemporaryFolder& folder,
                               const std::string& page) {
  return browse(browser, folder, page, {"--dump-dom"});
}

/// What a reader has: an `all` for document.querySelectorAll, clicks, choices, and files that are saved, as
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

/// Opens r.html, does what the script says when all is drawn, and returns the value that it returns.
inline nlohmann::json ask_page(const std::string& browser, const TemporaryFolder& folder,
                               const std::string& script, std::vector<std::string> more = {}) {
  // Without a screen there are no frames to wait for.
  const std::string timer = "<script>window.requestAnimationFrame = (act) => setTimeout(act, 10);</script>";
  write_text(
      folder / "asked.html",
      timer + read_text(folder / "r.html") + "<script type=\"module\">" + kReadersHands +
          "const read = async () => {" + script +
          "\n};\nconst act = async () => {\n"
          "  if (document.documentElement.dataset.drawn !== 'all') return setTimeout(act, 50);\n"
          "  let answer;\n  try { answer = await read(); } catch (error) { answer = String(error.stack); }\n"
          "  const text = JSON.stringify(answer).replace(/[<>&\\u0080-\\uffff]/g, (c) => '\\\\u' + "
          "c.charCodeAt(0).toString(16).padStart(4, '0'));\n"
          "  document.body.append(Object.assign(document.createElement('pre'), { id: 'answer', "
          "textContent: text }));\n};\nact();</script>");
  more.push_back("--dump-dom");
  const ProgramResult shown = browse(browser, folder, "asked.html", more);
  EXPECT_EQ(count(shown.err, "CONSOLE"), 0u) << shown.err;
  const std::string begin = "<pre id=\"answer\">";
  const auto at = shown.out.find(begin);
  if (at == std::string::npos) {
    ADD_FAILURE() << "the page gave no answer: " << shown.err;
    return {};
  }
  const auto from = at + begin.size();
  return nlohmann::json::parse(shown.out.substr(from, shown.out.find("</pre>", from) - from));
}

}  // namespace delquad::testing_support
