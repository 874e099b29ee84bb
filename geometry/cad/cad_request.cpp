#include "geometry/cad/cad_request.h"

#include <cstring>
#include <sstream>

#include "delquad/error.h"

namespace delquad::cad {

namespace {

/// To be changed with what is sent either way.
constexpr int kProtocol = 1;

template <class T>
void put(std::ostream& out, const T& number) {
  out.write(reinterpret_cast<const char*>(&number), sizeof number);
}
template <class T>
void get(std::istream& in, T& number) {
  in.read(reinterpret_cast<char*>(&number), sizeof number);
}

}  // namespace

std::string to_bytes(const CadRequest& r) {
  std::ostringstream out;
  put(out, kProtocol);
  put(out, r.source);
  put(out, r.options.deflection);
  put(out, r.options.angle);
  put(out, r.options.face_seconds);
  put(out, r.options.healing_seconds);
  put(out, r.threads);
  put(out, r.seconds);
  put(out, r.heals);
  put(out, r.late_faces.size());
  out << to_bytes(r.late_faces) << r.text;
  return out.str();
}

CadRequest request_from(const std::string& bytes) {
  std::istringstream in(bytes);
  int protocol = 0;
  get(in, protocol);
  if (protocol != kProtocol)
    throw InputError("the program that reads CAD files is of another version than the library that asks it");
  CadRequest r;
  get(in, r.source);
  get(in, r.options.deflection);
  get(in, r.options.angle);
  get(in, r.options.face_seconds);
  get(in, r.options.healing_seconds);
  get(in, r.threads);
  get(in, r.seconds);
  get(in, r.heals);
  std::size_t n_late = 0;
  get(in, n_late);
  const std::string rest = bytes.substr(static_cast<std::size_t>(in.tellg()));
  r.late_faces = numbers_from(rest.substr(0, n_late * sizeof(int)));
  r.text = rest.substr(n_late * sizeof(int));
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
