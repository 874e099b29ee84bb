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

/// Form of the value of a field in files.
enum class Form {
  kPlain,    ///< by its type: a number, a text, true or false, a list, a table
  kFormula,  ///< a text, or a number instead
  kTexts,    ///< a list of texts, or one text alone
  kGroup,    ///< the same, or a text, each the name of a physical group
  kVector,   ///< three numbers
  kDegrees,  ///< degrees; the struct and records have radians
  kBytes,    ///< bytes, which records have as their digest
  kLeast,    ///< the first number of a pair; the next field has the second
  kMost,     ///< the second number of the pair
  kOwn,      ///< read by own code
  kNone,     ///< set by programs only
};

/// The rules for the value of a field.
struct Rule {
  Form form = Form::kPlain;
  /// Limits of numbers, and of lengths of vectors. For lists of texts and points, `least` is their least
  /// number.
  std::optional<double> least = {}, above = {}, most = {};
  bool required = false;          ///< its table is refused without it
  bool unique = false;            ///< a list of different texts
  const char* words = nullptr;    ///< "a|b": allowed texts; for enumerations and flags one for each value
  const char* type = nullptr;     ///< for kOwn and texts: JSON Schema of the value, unless it is a table
  const char* option = nullptr;   ///< option of the program that sets it
  const char* keyword = nullptr;  ///< keyword of Python that sets it, if that is not the key
  const char* no_result =
      nullptr;  ///< why it determines no result; null: it does, and is in digests and records
};

/// Returns the texts of Rule::words.
std::vector<std::string> words_of(const char* words);

struct FieldInfo {
  const char* key;   ///< in files and records; empty: the fields of the member replace it
  const char* help;  ///< meaning, for people
  Rule rule;
};

template <class Struct, class Member>
struct Field : FieldInfo {
  Member Struct::*member;
};

/// Returns the description of a field.
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

/// Returns a field for the place in a file from which a struct was read.
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

/// Returns the number of members of an aggregate: the largest number of values that can initialize it.
template <class T, class... Values>
consteval std::size_t count_members() {
  if constexpr (requires { T{Values{}..., AnyValue{}}; })
    return count_members<T, Values..., AnyValue>();
  else
    return sizeof...(Values);
}

/// Calls visit(FieldInfo, member, same member of the others...) for each field, in the order of the
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
