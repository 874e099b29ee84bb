#include "geometry/cad/cad_request.h"

#include <cstring>
#include <sstream>

#include "delquad/error.h"

namespace delquad::cad {

namespace {

/// To be changed with what is sent either way.
constexpr int kProtocol = 5;

/// Calls `visit` with every number of a request that has a fixed size, in the order in which they are sent.
template <class Request, class Visit>
void visit_numbers(Request& r, const Visit& visit) {
  visit(r.source);
  visit(r.options.deflection);
  visit(r.options.angle);
  visit(r.options.face_seconds);
  visit(r.options.healing_seconds);
  visit(r.options.by_outline);
  visit(r.options.glue);
  visit(r.options.weld);
  visit(r.options.keep_going);
  visit(r.threads);
  visit(r.seconds);
  visit(r.heals);
}

}  // namespace

std::string to_bytes(const CadRequest& r) {
  std::string bytes;
  const auto put = [&](const auto& number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  put(kProtocol);
  visit_numbers(r, put);
  put(r.late_faces.size());
  put(r.options.unit.size());
  return bytes + to_bytes(r.late_faces) + r.options.unit + r.text;
}

CadRequest request_from(const std::string& bytes) {
  std::istringstream in(bytes);
  const auto get = [&](auto& number) { in.read(reinterpret_cast<char*>(&number), sizeof number); };
  int protocol = 0;
  get(protocol);
  if (protocol != kProtocol)
    throw InputError("the program that reads CAD files is of another version than the library that asks it");
  CadRequest r;
  visit_numbers(r, get);
  std::size_t n_late = 0, n_unit = 0;
  get(n_late);
  get(n_unit);
  const std::string rest = bytes.substr(static_cast<std::size_t>(in.tellg()));
  const std::size_t n_late_bytes = n_late * sizeof(int);
  r.late_faces = numbers_from(rest.substr(0, n_late_bytes));
  r.options.unit = rest.substr(n_late_bytes, n_unit);
  r.text = rest.substr(n_late_bytes + n_unit);
  return r;
}

std::string to_bytes(const std::vector<int>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(int)};
}

std::vector<int> numbers_from(const std::string& bytes) {
  std::vector<int> numbers(bytes.size() / sizeof(int));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(int));
  return numbers;
}

}  // namespace delquad::cad
