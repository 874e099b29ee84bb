#include "io/cases/toml_reader.h"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "base/located.h"
#include "delquad/error.h"

namespace delquad {
/// What stands in for the values at dotted keys, seen from the table that they were chosen for.
struct TomlChoices {
  struct Value {
    const toml::node* node;
    std::string path;  // of the table that it stands in, for messages
  };
  std::vector<TomlTable> tables = {};  // keep the nodes alive
  std::map<std::string, Value> values = {};
  toml::table empty = {};  // for tables that hold nothing but choices
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
  std::filesystem::path file;
  std::string path;  // of the table inside the file, for messages; empty at the top
  std::set<std::string> asked;
  std::shared_ptr<const TomlChoices> choices;  // null: none
  std::string below;  // dotted path from the table with choices, with its dot at the end
  std::shared_ptr<const std::vector<std::string>> options = nullptr;  // by line, in place of a file

  std::string place(unsigned line) const {
    return options ? options->at(line - 1) : file.string() + ":" + std::to_string(line);
  }
  std::string place(const toml::node& node) const { return place(node.source().begin.line); }
  /// As the file has it: what was chosen stands in another table.
  std::string name(const std::string& key) const {
    return is_chosen(below + key) ? choices->values.lower_bound(below + key)->second.path + "." + below + key
                                  : own_name(key);
  }
  std::string own_name(const std::string& key) const { return path.empty() ? key : path + "." + key; }
  /// Whether the value at a dotted path from the table with choices was chosen, or one below it.
  bool is_chosen(const std::string& path_to) const {
    if (!choices) return false;
    const auto inside = choices->values.lower_bound(path_to + ".");
    return choices->values.contains(path_to) ||
           (inside != choices->values.end() && inside->first.starts_with(path_to + "."));
  }

  const toml::node* find(const std::string& key) {
    asked.insert(key);
    const toml::node* node = table->get(key);
    if (!choices) return node;
    const std::string path_to = below + key;
    if (const auto chosen = choices->values.find(path_to); chosen != choices->values.end())
      return chosen->second.node;
    const auto inside = choices->values.lower_bound(path_to + ".");
    if (inside == choices->values.end() || !inside->first.starts_with(path_to + ".")) return node;
    if (node && !node->is_table())
      throw InputError(place(*inside->second.node) + ": '" + inside->first + "' is varied, but '" + path_to +
                       "' is no table at " + place(*node));
    return node ? node : &choices->empty;
  }
  /// Own keys and chosen ones.
  std::set<std::string> keys() const {
    std::set<std::string> names;
    for (const auto& [key, node] : *table) names.emplace(key.str());
    if (!choices) return names;
    for (auto at = choices->values.lower_bound(below);
         at != choices->values.end() && at->first.starts_with(below); ++at)
      names.insert(at->first.substr(below.size(), at->first.find('.', below.size()) - below.size()));
    return names;
  }
  [[noreturn]] void expected(const toml::node& node, const std::string& key, const std::string& what) const {
    throw InputError(place(node) + ": '" + name(key) + "' must be " + what);
  }
  const toml::node& need(const std::string& key, const std::string& what) {
    const toml::node* node = find(key);
    if (!node) refuse("{}: '{}' is missing: expected {}", place(line()), name(key), what);
    return *node;
  }
  unsigned line() const { return std::max(1u, static_cast<unsigned>(table->source().begin.line)); }

  double number(const toml::node& node, const std::string& key, const std::string& what) const {
    const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) expected(node, key, what);
    return *value;
  }
  Vec2 point(const toml::node& node, const std::string& key, const std::string& what) const {
    const toml::array* pair = node.as_array();
    if (!pair || pair->size() != 2) expected(node, key, what);
    return {number(*pair->get(0), key, what), number(*pair->get(1), key, what)};
  }
  Vec3 space_point(const toml::node& node, const std::string& key, const std::string& what) const {
    const toml::array* x = node.as_array();
    if (!x || x->size() < 2 || x->size() > 3) expected(node, key, what);
    const auto at = [&](std::size_t i) { return number(*x->get(i), key, what); };
    return {at(0), at(1), x->size() == 3 ? at(2) : 0};
  }
  const toml::array& array(const toml::node& node, const std::string& key, const std::string& what) const {
    if (!node.is_array()) expected(node, key, what);
    return *node.as_array();
  }
  /// The nodes of a list, each as `read` makes it.
  template <class T, class Read>
  std::vector<T> list(const std::string& key, const char* what, Read read) {
    std::vector<T> result;
    for (const toml::node& node : array(need(key, what), key, what)) result.push_back(read(node));
    return result;
  }
  std::shared_ptr<Data> child(const toml::table& inner, const std::string& inner_path) const {
    return std::make_shared<Data>(Data{root, &inner, file, inner_path, {}, nullptr, "", options});
  }
};

TomlTable TomlTable::read(const std::filesystem::path& file) {
  std::error_code status;
  if (std::filesystem::is_directory(file, status))
    throw InputError(file.string() + ": is a folder; expected a TOML file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse("{}: cannot be read: {}", file.string(), std::generic_category().message(errno));
  try {
    auto root = std::make_shared<const toml::table>(toml::parse(stream, file.string()));
    const toml::table* top = root.get();
    return TomlTable(std::make_shared<Data>(Data{std::move(root), top, file, "", {}, nullptr, ""}));
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
        std::make_shared<Data>(Data{std::move(root), top, "", "", {}, nullptr, "", std::move(names)}));
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

double TomlTable::number(const std::string& key) const {
  constexpr const char* kWhat = "a finite number";
  return data_->number(data_->need(key, kWhat), key, kWhat);
}
double TomlTable::number(const std::string& key, double absent) const {
  return has(key) ? number(key) : absent;
}

double TomlTable::positive_number(const std::string& key) const {
  constexpr const char* kWhat = "a number > 0";
  const toml::node& node = data_->need(key, kWhat);
  const double value = data_->number(node, key, kWhat);
  if (value <= 0) data_->expected(node, key, kWhat);
  return value;
}

long long TomlTable::integer(const std::string& key) const {
  constexpr const char* kWhat = "an integer";
  const toml::node& node = data_->need(key, kWhat);
  const std::optional<std::int64_t> value = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
  if (!value) data_->expected(node, key, kWhat);
  return *value;
}
long long TomlTable::integer(const std::string& key, long long absent) const {
  return has(key) ? integer(key) : absent;
}

bool TomlTable::flag(const std::string& key, bool absent) const {
  const toml::node* node = data_->find(key);
  if (!node) return absent;
  if (!node->is_boolean()) data_->expected(*node, key, "true or false");
  return *node->value<bool>();
}

std::string TomlTable::text(const std::string& key) const {
  constexpr const char* kWhat = "a text in quotes";
  const toml::node& node = data_->need(key, kWhat);
  if (!node.is_string()) data_->expected(node, key, kWhat);
  return *node.value<std::string>();
}
std::string TomlTable::text(const std::string& key, const std::string& absent) const {
  return has(key) ? text(key) : absent;
}

std::string TomlTable::expression(const std::string& key) const {
  constexpr const char* kWhat = "a finite number or an expression in quotes";
  const toml::node& node = data_->need(key, kWhat);
  if (node.is_string()) return *node.value<std::string>();
  return number_text(data_->number(node, key, kWhat));
}

Vec2 TomlTable::point(const std::string& key) const {
  constexpr const char* kWhat = "a point [x, y]";
  return data_->point(data_->need(key, kWhat), key, kWhat);
}

Vec3 TomlTable::space_point(const std::string& key) const {
  constexpr const char* kWhat = "a point [x, y] or [x, y, z]";
  return data_->space_point(data_->need(key, kWhat), key, kWhat);
}

std::vector<Vec3> TomlTable::space_points(const std::string& key) const {
  constexpr const char* kWhat = "a list of points [[x, y, z], ...]";
  return data_->list<Vec3>(key, kWhat,
                           [&](const toml::node& node) { return data_->space_point(node, key, kWhat); });
}

std::vector<Vec2> TomlTable::points(const std::string& key) const {
  constexpr const char* kWhat = "a list of points [[x, y], ...]";
  return data_->list<Vec2>(key, kWhat,
                           [&](const toml::node& node) { return data_->point(node, key, kWhat); });
}

std::vector<double> TomlTable::numbers(const std::string& key) const {
  constexpr const char* kWhat = "a list of finite numbers";
  return data_->list<double>(key, kWhat,
                             [&](const toml::node& node) { return data_->number(node, key, kWhat); });
}

std::vector<std::vector<int>> TomlTable::integer_lists(const std::string& key) const {
  const std::string what = "a list of lists of integers [[1, 2], ...]";
  std::vector<std::vector<int>> result;
  for (const toml::node& list : data_->array(data_->need(key, what), key, what)) {
    result.emplace_back();
    for (const toml::node& node : data_->array(list, key, what)) {
      const auto value = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
      if (!value || !std::in_range<int>(*value)) data_->expected(node, key, what);
      result.back().push_back(static_cast<int>(*value));
    }
  }
  return result;
}

std::vector<std::string> TomlTable::texts(const std::string& key) const {
  constexpr const char* kWhat = "a list of texts in quotes";
  return data_->list<std::string>(key, kWhat, [&](const toml::node& node) {
    if (!node.is_string()) data_->expected(node, key, kWhat);
    return *node.value<std::string>();
  });
}

std::vector<std::variant<std::string, Vec3>> TomlTable::texts_and_points(const std::string& key) const {
  constexpr const char* kWhat = "a list of texts in quotes or points [x, y, z]";
  using Entry = std::variant<std::string, Vec3>;
  return data_->list<Entry>(key, kWhat, [&](const toml::node& node) -> Entry {
    if (node.is_string()) return *node.value<std::string>();
    return data_->space_point(node, key, kWhat);
  });
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
  const toml::node* node = data_->find(key);
  if (!node) return {};
  if (node->is_table()) return {table(key)};
  const std::string what = "a table or a list of tables";
  std::vector<TomlTable> result;
  for (const toml::node& item : data_->array(*node, key, what)) {
    if (!item.is_table()) data_->expected(item, key, what);
    result.push_back(TomlTable(data_->child(*item.as_table(), data_->own_name(key))));
  }
  return result;
}

std::pair<std::vector<std::string>, std::vector<TomlTable>> TomlTable::texts_and_tables(
    const std::string& key) const {
  const toml::node* node = data_->find(key);
  if (!node) return {};
  if (node->is_string()) return {{text(key)}, {}};
  if (node->is_table()) return {{}, {table(key)}};
  const std::string what = "a text in quotes, a table, or a list of these";
  std::pair<std::vector<std::string>, std::vector<TomlTable>> result;
  for (const toml::node& item : data_->array(*node, key, what)) {
    if (item.is_string())
      result.first.push_back(*item.value<std::string>());
    else if (item.is_table())
      result.second.push_back(TomlTable(data_->child(*item.as_table(), data_->own_name(key))));
    else
      data_->expected(item, key, what);
  }
  return result;
}

std::vector<std::string> TomlTable::leaves() const {
  std::vector<std::string> leaves;
  collect_leaves(*data_->table, "", leaves);
  std::ranges::sort(leaves);
  const auto twice = std::ranges::adjacent_find(leaves);
  if (twice != leaves.end()) throw InputError(where() + ": '" + *twice + "' is given twice");
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
    choices->values[leaves[k]] = {&element(*lists.data_->table, leaves[k], choice[k]), lists.data_->path};
  auto data = std::make_shared<Data>(*data_);
  data->asked.clear();
  data->choices = std::move(choices);
  return TomlTable(std::move(data));
}

void TomlTable::require_among(const std::vector<std::string>& known) const {
  for (const std::string& name : data_->keys()) {
    if (std::ranges::find(known, name) != known.end()) continue;
    const auto key = data_->table->find(name);
    const std::string place =
        key != data_->table->end()
            ? data_->place(key->first.source().begin.line)
            : data_->place(*data_->choices->values.lower_bound(data_->below + name)->second.node);
    std::string message = place + ": unknown key '" + data_->name(name) + "'";
    if (const std::string near = suggestion(name, known); !near.empty()) throw InputError(message + near);
    message += "; known here:";
    for (const std::string& other : known) message += " " + other;
    throw InputError(message);
  }
}

void TomlTable::finish() const { require_among({data_->asked.begin(), data_->asked.end()}); }

void TomlTable::require_known(const TomlKeys& keys) const {
  std::vector<std::string> known;
  for (const TomlKey& key : keys) known.push_back(key.name);
  std::ranges::sort(known);
  require_among(known);
}

void TomlTable::finish(const TomlKeys& keys) const {
  for (const std::string& name : data_->asked)
    if (std::ranges::find(keys, name, &TomlKey::name) == keys.end())
      throw std::logic_error("the key '" + data_->name(name) + "' is read but not listed");
  finish();
}

}  // namespace delquad
