// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/cad_request.h"

#include "geometry/cad/byte_archive.h"

namespace delquad::cad {

namespace {

/// Version of requests and replies; change it with their content.
constexpr int kProtocol = 7;

/// Calls visit(member) for all members of a request.
template <class Request, class Visit>
void visit_request(Request& r, const Visit& visit) {
  visit(r.source), visit(r.threads), visit(r.seconds);
  auto& o = r.options;
  visit(o.deflection), visit(o.angle), visit(o.by_outline), visit(o.unit), visit(o.glue), visit(o.weld),
      visit(o.keep_going), visit(r.text);
}

}  // namespace

std::string to_bytes(const CadRequest& request) {
  std::string bytes;
  put(bytes, kProtocol);
  visit_request(request, [&](const auto& value) { put(bytes, value); });
  return bytes;
}

CadRequest request_from(const std::string& bytes) {
  std::string_view rest = bytes;
  int protocol = 0;
  get(rest, protocol);
  if (protocol != kProtocol)
    throw InputError(
        "the program that reads CAD files has another version than this library: install both from one "
        "build");
  CadRequest request;
  visit_request(request, [&](auto& value) { get(rest, value); });
  return request;
}

}  // namespace delquad::cad
