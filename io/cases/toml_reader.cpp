// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/toml_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"

namespace delquad {
/// Values that replace the values at dotted keys, seen from the table that they were chosen for. Later ones
/// count more.
struct TomlChoices {
  struct Value {
    std::string key;
    const toml::node* node;
    std::string path;  // of the table that it stands in, for messages
  };
  std::vector<TomlTable> tables = {};  // keep the nodes alive
  std::vector<Value> values = {};
  toml::table empty = {};  // for tables that hold nothing but choices

  /// The value at a dotted path, or else one below it; null: none.
  const Value* find(const std::string& path) const {
    const Value* found = nullptr;
    for (const Value& value : values) {
      if (value.key == path) found = &value;
      if ((found == nullptr || found->key != path) && value.key.starts_with(path + ".")) found = &value;
    }
    return found;
  }
};

namespace {

/// As short as it can be read back.
std::string number_text(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

void collect_leaves(const toml::table& table, const std::string& prefix, std::vector<std::string>& leaves) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table())
      collect_leaves(*inner, name + ".", leaves);
    else
      leaves.push_back(name);
  }
}

}  // namespace

struct TomlTable::Data {
  std::shared_ptr<const toml::table> root;  // keeps `table` alive
  const toml::table* table;
  std::filesystem::path file = {};
  std::string path = {};  // of the table inside the file, for messages; empty at the top
  std::shared_ptr<const TomlChoices> choices = nullptr;  // null: none
  std::string below = {};  // dotted path from the table with choices, with its dot at the end
  std::shared_ptr<const std::vector<std::string>> options = nullptr;  // by line, in place of a file

  std::string place(unsigned line) const {
    return options ? options->at(line - 1) : file.string() + ":" + std::to_string(line);
  }
  std::string place(const toml::node& node) const { return place(node.source().begin.line); }
  const TomlChoices::Value* chosen(const std::string& key) const {
    return choices ? choices->find(below + key) : nullptr;
  }
  /// As the file has it: what was chosen stands in another table.
  std::string name(const std::string& key) const {
    const auto* choice = chosen(key);
    return choice ? choice->path + "." + below + key : own_name(key);
  }
  std::string own_name(const std::string& key) const { return path.empty() ? key : path + "." + key; }

  const toml::node* find(const std::string& key) const {
    const toml::node* node = table->get(key);
    const auto* choice = chosen(key);
    if (!choice) return node;
    if (choice->key == below + key) return choice->node;
    if (node && !node->is_table())
      refuse("{}: '{}' is varied, but '{}' is no table at {}", place(*choice->node), choice->key, below + key,
             place(*node));
    return node ? node : &choices->empty;
  }
  /// Own keys and chosen ones.
  std::set<std::string> keys() const {
    std::set<std::string> names;
    for (const auto& [key, node] : *table) names.emplace(key.str());
    if (choices)
      for (const auto& value : choices->values)
        if (value.key.starts_with(below))
          names.insert(value.key.substr(below.size(), value.key.find('.', below.size()) - below.size()));
    return names;
  }
  [[noreturn]] void expected(const toml::node& node, const std::string& key, const std::string& what) const {
    throw InputError(place(node) + ": '" + name(key) + "' must be " + what);
  }
  const toml::node& need(const std::string& key, const std::string& what) const {
    const toml::node* node = find(key);
    if (!node) refuse("{}: '{}' is missing: expected {}", place(line()), name(key), what);
    return *node;
  }
  unsigned line() const { return std::max(1u, static_cast<unsigned>(table->source().begin.line)); }

  std::shared_ptr<Data> child(const toml::table& inner, const std::string& inner_path) const {
    return std::make_shared<Data>(
        Data{.root = root, .table = &inner, .file = file, .path = inner_path, .options = options});
  }
};

TomlTable TomlTable::read(const std::filesystem::path& file) {
  const std::string text = file_bytes(file);
  try {
    auto root = std::make_shared<const toml::table>(toml::parse(text, file.string()));
    const toml::table* top = root.get();
    return TomlTable(std::make_shared<Data>(Data{std::move(root), top, file}));
  } catch (const toml::parse_error& error) {
    refuse("{}:{}: not TOML: {}", file.string(), error.source().begin.line, error.description());
  }
}

TomlTable TomlTable::of_options(const std::vector<std::pair<std::string, std::string>>& lines) {
  std::string text;
  auto names = std::make_shared<std::vector<std::string>>();
  for (const auto& [name, line] : lines) {
    if (line.find_first_of("\n\r") != line.npos) refuse("{}: expected one line", name);
    text += line + "\n";
    names->push_back(name);
  }
  names->push_back(names->empty() ? "" : names->back());  // the end of the text
  try {
    auto root = std::make_shared<const toml::table>(toml::parse(text));
    const toml::table* top = root.get();
    return TomlTable(
        std::make_shared<Data>(Data{.root = std::move(root), .table = top, .options = std::move(names)}));
  } catch (const toml::parse_error& error) {
    const std::string& name = names->at(error.source().begin.line - 1);
    if (error.description().find("cannot redefine") != std::string_view::npos)
      refuse("{}: another option sets this key, too: expected one of them", name);
    refuse("{}: {}", name, error.description());
  }
}

bool TomlTable::is_of_options() const { return data_->options != nullptr; }

const std::filesystem::path& TomlTable::file() const { return data_->file; }
std::string TomlTable::where() const { return data_->place(data_->line()); }
std::string TomlTable::where(const std::string& key) const {
  const toml::node* node = data_->find(key);
  return node ? data_->place(*node) : where();
}

TomlKind TomlTable::kind(const std::string& key) const {
  const toml::node* node = data_->find(key);
  if (!node) return TomlKind::kNone;
  if (node->is_number()) return TomlKind::kNumber;
  if (node->is_string()) return TomlKind::kText;
  if (node->is_boolean()) return TomlKind::kFlag;
  if (node->is_array()) return TomlKind::kArray;
  return TomlKind::kTable;
}

std::vector<std::string> TomlTable::keys() const {
  const std::set<std::string> names = data_->keys();
  return {names.begin(), names.end()};
}

namespace {

// These take the value of a node, and return the node that is none; null: all are right.

template <class T>
const toml::node* take(const toml::node& node, T& value) {
  const auto given = node.value_exact<T>();
  value = given.value_or(T());
  return given ? nullptr : &node;
}
const toml::node* take(const toml::node& node, double& value) {
  value = node.is_number() ? *node.value<double>() : NAN;
  return std::isfinite(value) ? nullptr : &node;
}
const toml::node* take(const toml::node& node, long long& value) {
  std::int64_t whole = 0;
  const toml::node* wrong = take(node, whole);
  value = whole;
  return wrong;
}
const toml::node* take(const toml::node& node, int& value) {
  long long whole = 0;
  if (take(node, whole) != nullptr || !std::in_range<int>(whole)) return &node;
  value = static_cast<int>(whole);
  return nullptr;
}
const toml::node* take(const toml::node& node, Vec2& p);
const toml::node* take(const toml::node& node, Vec3& p);
const toml::node* take(const toml::node& node, std::variant<std::string, Vec3>& value);
template <class T>
const toml::node* take(const toml::node& node, std::vector<T>& values) {
  if (!node.is_array()) return &node;
  for (const toml::node& one : *node.as_array())
    if (const toml::node* wrong = take(one, values.emplace_back())) return wrong;
  return nullptr;
}
template <class T, std::size_t N>
const toml::node* take(const toml::node& node, std::array<T, N>& values) {
  std::vector<T> list;
  if (const toml::node* wrong = take(node, list)) return wrong;
  if (list.size() != N) return &node;
  std::ranges::copy(list, values.begin());
  return nullptr;
}
const toml::node* take(const toml::node& node, Vec2& p) {
  std::array<double, 2> x;
  const toml::node* wrong = take(node, x);
  p = {x[0], x[1]};
  return wrong;
}
const toml::node* take(const toml::node& node, Vec3& p) {
  std::vector<double> x;
  if (const toml::node* wrong = take(node, x)) return wrong;
  if (x.size() < 2 || x.size() > 3) return &node;
  p = {x[0], x[1], x.size() == 3 ? x[2] : 0};
  return nullptr;
}
const toml::node* take(const toml::node& node, std::variant<std::string, Vec3>& value) {
  if (node.is_string()) return take(node, value.emplace<std::string>());
  return take(node, value.emplace<Vec3>());
}

// These functions return the expected values of each type.
const char* expected_of(bool) { return "true or false"; }
const char* expected_of(int) { return "an integer"; }
const char* expected_of(long long) { return "an integer"; }
const char* expected_of(double) { return "a finite number"; }
const char* expected_of(const std::string&) { return "a text in quotes"; }
const char* expected_of(Vec2) { return "a point [x, y]"; }
const char* expected_of(Vec3) { return "a point [x, y] or [x, y, z]"; }
const char* expected_of(const std::array<double, 2>&) { return "two numbers [least, most]"; }
const char* expected_of(const std::array<double, 3>&) { return "three numbers [x, y, z]"; }
const char* expected_of(const std::array<int, 2>&) { return "two integers [nx, ny]"; }
const char* expected_of(const std::array<Vec2, 2>&) { return "two points [[x, y], [x, y]]"; }
const char* expected_of(const std::array<Vec3, 2>&) { return "two opposite corners [[x, y, z], [x, y, z]]"; }
const char* expected_of(const std::vector<int>&) { return "a list of integers"; }
const char* expected_of(const std::vector<std::string>&) { return "a list of texts in quotes"; }
const char* expected_of(const std::vector<Vec2>&) { return "a list of points [[x, y], ...]"; }
const char* expected_of(const std::vector<Vec3>&) { return "a list of points [[x, y, z], ...]"; }
const char* expected_of(const std::vector<std::vector<int>>&) {
  return "a list of lists of integers [[1, 2], ...]";
}
const char* expected_of(const std::vector<std::variant<std::string, Vec3>>&) {
  return "a list of texts in quotes or points [x, y, z]";
}

}  // namespace

void TomlTable::read(const std::string& key, const TomlTarget& target) const {
  std::visit(
      [&](auto* value) {
        const char* expected = expected_of(*value);
        if (const toml::node* wrong = take(data_->need(key, expected), *value))
          data_->expected(*wrong, key, expected);
      },
      target);
}

std::string TomlTable::expression(const std::string& key) const {
  if (kind(key) == TomlKind::kText) return text(key);
  constexpr const char* kExpected = "a finite number or an expression in quotes";
  const toml::node& node = data_->need(key, kExpected);
  double value = 0;
  if (take(node, value) != nullptr) data_->expected(node, key, kExpected);
  return number_text(value);
}

TomlTable TomlTable::table(const std::string& key) const {
  const std::string what = "a table of keys and values";
  const toml::node& node = data_->need(key, what);
  if (!node.is_table()) data_->expected(node, key, what);
  auto inner = data_->child(*node.as_table(), data_->own_name(key));
  inner->choices = data_->choices;
  inner->below = data_->below + key + ".";
  return TomlTable(std::move(inner));
}

std::optional<TomlTable> TomlTable::optional_table(const std::string& key) const {
  return has(key) ? std::optional(table(key)) : std::nullopt;
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) const {
  return texts_and_tables(key, false).second;
}

std::pair<std::vector<std::string>, std::vector<TomlTable>> TomlTable::texts_and_tables(
    const std::string& key, bool may_be_texts) const {
  const toml::node* node = data_->find(key);
  if (!node) return {};
  const char* what = may_be_texts ? "a text in quotes such as \"auto\", a table, or a list of these"
                                  : "a table or a list of tables";
  std::pair<std::vector<std::string>, std::vector<TomlTable>> result;
  const auto add = [&](const toml::node& item) {
    if (may_be_texts && item.is_string())
      result.first.push_back(*item.value<std::string>());
    else if (!item.is_table())
      data_->expected(item, key, what);
    else
      result.second.push_back(
          &item == node ? table(key) : TomlTable(data_->child(*item.as_table(), data_->own_name(key))));
  };
  if (!node->is_array())
    add(*node);
  else
    for (const toml::node& item : *node->as_array()) add(item);
  return result;
}

std::vector<std::string> TomlTable::leaves() const {
  std::vector<std::string> leaves;
  collect_leaves(*data_->table, "", leaves);
  std::ranges::sort(leaves);
  const auto twice = std::ranges::adjacent_find(leaves);
  if (twice != leaves.end())
    throw InputError(where() + ": '" + *twice + "' is given twice: expected it once");
  return leaves;
}

namespace {

/// Where a key is quoted its dots may be its own: "a.b" = and a.b = say the same.
const toml::node* find_leaf(const toml::table& table, std::string_view leaf) {
  for (const auto& [key, node] : table) {
    if (key.str() == leaf) return &node;
    const toml::table* inner = node.as_table();
    if (inner == nullptr || !leaf.starts_with(key.str()) || leaf[key.str().size()] != '.') continue;
    if (const toml::node* found = find_leaf(*inner, leaf.substr(key.str().size() + 1))) return found;
  }
  return nullptr;
}

const toml::node& element(const toml::table& table, const std::string& leaf, std::size_t i) {
  const toml::node& node = *find_leaf(table, leaf);
  return i == TomlTable::kWhole ? node : *node.as_array()->get(i);
}

}  // namespace

std::size_t TomlTable::count(const std::string& leaf) const {
  const toml::node& node = *find_leaf(*data_->table, leaf);
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty()) data_->expected(node, leaf, "a list of at least one value");
  return list->size();
}

std::string TomlTable::element_text(const std::string& leaf, std::size_t i) const {
  const toml::node& node = element(*data_->table, leaf, i);
  if (node.is_string()) return *node.value<std::string>();
  if (node.is_floating_point()) return number_text(*node.value<double>());
  std::ostringstream text;
  node.visit([&](const auto& value) {
    if constexpr (toml::is_table<decltype(value)>)
      text << toml::toml_formatter(value);
    else
      text << value;
  });
  return text.str();
}

TomlTable TomlTable::with_choice(const TomlTable& lists, const std::vector<std::string>& leaves,
                                 const std::vector<std::size_t>& choice) const {
  auto choices = std::make_shared<TomlChoices>();
  if (data_->choices) {
    choices->tables = data_->choices->tables;
    choices->values = data_->choices->values;
  }
  choices->tables.push_back(lists);
  for (std::size_t k = 0; k < leaves.size(); ++k)
    choices->values.push_back(
        {leaves[k], &element(*lists.data_->table, leaves[k], choice[k]), lists.data_->path});
  auto data = std::make_shared<Data>(*data_);
  data->choices = std::move(choices);
  return TomlTable(std::move(data));
}

void TomlTable::refuse_removed(const RemovedKeys& keys) const {
  const std::set<std::string> present = data_->keys();
  for (const auto& [key, way] : keys)
    if (present.contains(key)) refuse("{}: the key '{}' was removed: {}", where(key), data_->name(key), way);
}

void TomlTable::require_known(const TomlKeys& keys) const {
  for (const std::string& name : data_->keys()) {
    if (std::ranges::find(keys, name, &TomlKey::name) != keys.end()) continue;
    const auto key = data_->table->find(name);
    const std::string place = key != data_->table->end() ? data_->place(key->first.source().begin.line)
                                                         : data_->place(*data_->chosen(name)->node);
    std::vector<std::string> known;
    for (const TomlKey& one : keys) known.push_back(one.name);
    std::ranges::sort(known);
    const std::string near = suggestion(name, known);
    refuse("{}: unknown key '{}'{} [unknown-key]", place, data_->name(name),
           near.empty() ? fmt::format("; known here: {}", fmt::join(known, " ")) : near);
  }
}

}  // namespace delquad
