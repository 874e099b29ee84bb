// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/page.h"

#include <ostream>
#include <utility>

#include "experiments/sweep/record.h"

namespace delquad {
namespace {

/// Text that may stand inside a script element.
std::string for_script(const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace), result;
  for (const char c : text)
    if (c == '<')
      result += "\\u003c";
    else
      result += c;
  return result;
}

}  // namespace

void begin_page(std::ostream& out, std::string_view title, std::string_view style, std::string_view body) {
  out << "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
         "'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:\">\n"
         "<title>"
      << title << "</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>" << style
      << "</style>\n</head>\n<body>" << body;
}

void end_page(std::ostream& out, Json data, bool in_space, std::string_view script) {
  data["program"] = Json::parse(versions_record());
  out << "<script type=\"application/json\" id=\"data\">" << for_script(data) << "</script>\n";
  if (in_space) out << "<script>" << kThreeScript << "</script>\n";
  out << "<script type=\"module\">" << kPageScript << script << "</script>\n</body>\n</html>\n";
}

Json add_picture(std::ostream& out, const std::string& id, PackedMesh packed) {
  out << "<script type=\"text/plain\" id=\"" << id << "\">" << packed.text << "</script>\n";
  packed.info["id"] = id;
  return std::move(packed.info);
}

}  // namespace delquad
