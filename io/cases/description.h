// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

// This header describes structs, each by one list of its fields. Readers of files, schemas, documents,
// records, digests and equality go by it.

namespace delquad {

/// How the value of a field stands in files.
enum class Form {
  kPlain,    ///< as its type says: a number, a text, true or false, a list, a table
  kFormula,  ///< a text, or a number in its place
  kTexts,    ///< a list of texts, or one text alone
  kGroup,    ///< the same, or a text, each the name of a physical group
  kVector,   ///< three numbers
  kDegrees,  ///< degrees; the struct and records have radians
  kBytes,    ///< bytes, which records have by their digest
  kLeast,    ///< the first number of a pair; the next field has the second
  kMost,     ///< the second number of the pair
  kOwn,      ///< code of its own reads it
  kNone,     ///< only programs set it
};

/// The rules for the value of a field.
struct Rule {
  Form form = Form::kPlain;
  /// Limits of numbers, and of lengths of vectors; `least` of lists of texts and points: how many there are
  /// at least.
  std::optional<double> least = {}, above = {}, most = {};
  bool required = false;        ///< its table is refused without it
  bool unique = false;          ///< a list of texts, each of which stands there once
  const char* words = nullptr;  ///< "a|b": texts that it may be; of enumerations and flags one for each value
  const char* type = nullptr;   ///< of kOwn and texts: JSON Schema of the value, unless it is a table
  const char* option = nullptr;   ///< option of the program that sets it
  const char* keyword = nullptr;  ///< keyword of Python that sets it, where that is not the key
  const char* no_result =
      nullptr;  ///< the reason why it determines no result: then it is in no digest and record
};

/// Returns each of the texts of Rule::words.
std::vector<std::string> words_of(const char* words);

struct FieldInfo {
  const char* key;   ///< in files and records; empty: the fields of the member stand in its place
  const char* help;  ///< what it is, for people
  Rule rule;
};

template <class Struct, class Member>
struct Field : FieldInfo {
  Member Struct::*member;
};

template <class Struct, class Member>
constexpr Field<Struct, Member> field(const char* key, Member Struct::*member, const char* help = "",
                                      Rule rule = {}) {
  return {{key, help, rule}, member};
}

/// Returns a field that only programs set.
template <class Struct, class Member>
constexpr Field<Struct, Member> inner(const char* key, Member Struct::*member) {
  return field(key, member, "", {.form = Form::kNone});
}

/// Returns a field that determines no result, and the reason.
template <class Struct, class Member>
constexpr Field<Struct, Member> ignored(Member Struct::*member, const char* reason) {
  return field("ignored", member, "", {.form = Form::kNone, .no_result = reason});
}

/// Returns the place in a file that a struct was read from.
template <class Struct, class Member>
constexpr Field<Struct, Member> place(Member Struct::*member) {
  return ignored(member, "it names a place in messages");
}

struct NotDescribed {};
/// The description: a tuple of its fields.
template <class T>
inline constexpr auto kFields = NotDescribed{};
template <class T>
concept Described = !std::is_same_v<const NotDescribed, decltype(kFields<T>)>;

/// Stands for a value of any type.
struct AnyValue {
  template <class T>
  operator T() const;
};

/// The number of members of a struct: with so many values, and no more, it can be made.
template <class T, class... Values>
consteval std::size_t count_members() {
  if constexpr (requires { T{Values{}..., AnyValue{}}; })
    return count_members<T, Values..., AnyValue>();
  else
    return sizeof...(Values);
}

/// Calls visit(FieldInfo, member, the same member of the others...) for each field, in the order of the
/// description.
template <class Visit, class T, class... Same>
void visit_fields(Visit&& visit, T& object, Same&... others) {
  using Struct = std::remove_const_t<T>;
  static_assert(std::tuple_size_v<decltype(kFields<Struct>)> == count_members<Struct>(),
                "the description lacks a member of the struct, or has one twice");
  std::apply(
      [&](const auto&... one) {
        const auto visit_one = [&](const auto& field) {
          const auto member = field.member;
          if constexpr (Described<std::remove_cvref_t<decltype(object.*member)>>) {
            if (*field.key == '\0') return visit_fields(visit, object.*member, others.*member...);
          }
          visit(static_cast<const FieldInfo&>(field), object.*member, others.*member...);
        };
        (visit_one(one), ...);
      },
      kFields<Struct>);
}

/// Calls visit(FieldInfo, member) for each field.
template <class T, class Visit>
void for_each_field(T& object, Visit&& visit) {
  visit_fields(visit, object);
}

}  // namespace delquad
