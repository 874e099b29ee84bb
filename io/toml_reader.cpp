#include "io/toml_reader.h"

#include <toml++/toml.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <system_error>

#include "mesh/error.h"

namespace delquad {

struct TomlTable::Data {
  std::shared_ptr<const toml::table> root;  // keeps `table` alive
  const toml::table* table;
  std::filesystem::path file;
  std::string path;  // of the table inside the file, for messages; empty at the top
  std::set<std::string> asked;

  std::string place(const toml::node& node) const {
    return file.string() + ":" + std::to_string(node.source().begin.line);
  }
  std::string name(const std::string& key) const { return path.empty() ? key : path + "." + key; }

  const toml::node* find(const std::string& key) {
    asked.insert(key);
    return table->get(key);
  }
  [[noreturn]] void expected(const toml::node& node, const std::string& key, const std::string& what) const {
    throw InputError(place(node) + ": '" + name(key) + "' must be " + what);
  }
  const toml::node& need(const std::string& key, const std::string& what) {
    const toml::node* node = find(key);
    if (!node)
      throw InputError(file.string() + ":" + std::to_string(line()) + ": '" + name(key) +
                       "' is missing: expected " + what);
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
  const toml::array& array(const toml::node& node, const std::string& key, const std::string& what) const {
    if (!node.is_array()) expected(node, key, what);
    return *node.as_array();
  }
  std::shared_ptr<Data> child(const toml::table& inner, const std::string& inner_path) const {
    return std::make_shared<Data>(Data{root, &inner, file, inner_path, {}});
  }
};

TomlTable TomlTable::read(const std::filesystem::path& file) {
  std::error_code status;
  if (std::filesystem::is_directory(file, status))
    throw InputError(file.string() + ": is a folder; expected a TOML file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError(file.string() + ": cannot be read: " + std::generic_category().message(errno));
  try {
    auto root = std::make_shared<const toml::table>(toml::parse(stream, file.string()));
    const toml::table* top = root.get();
    return TomlTable(std::make_shared<Data>(Data{std::move(root), top, file, "", {}}));
  } catch (const toml::parse_error& error) {
    throw InputError(file.string() + ":" + std::to_string(error.source().begin.line) +
                     ": not TOML: " + std::string(error.description()));
  }
}

const std::filesystem::path& TomlTable::file() const { return data_->file; }
std::string TomlTable::where() const { return data_->file.string() + ":" + std::to_string(data_->line()); }
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
  std::vector<std::string> names;
  for (const auto& [key, node] : *data_->table) names.emplace_back(key.str());
  return names;
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
  const double value = data_->number(node, key, kWhat);
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

Vec2 TomlTable::point(const std::string& key) const {
  constexpr const char* kWhat = "a point [x, y]";
  return data_->point(data_->need(key, kWhat), key, kWhat);
}

Vec3 TomlTable::space_point(const std::string& key) const {
  const std::string what = "a point [x, y] or [x, y, z]";
  const toml::node& node = data_->need(key, what);
  const toml::array* x = node.as_array();
  if (!x || x->size() < 2 || x->size() > 3) data_->expected(node, key, what);
  const auto at = [&](std::size_t i) { return data_->number(*x->get(i), key, what); };
  return {at(0), at(1), x->size() == 3 ? at(2) : 0};
}

std::vector<Vec2> TomlTable::points(const std::string& key) const {
  constexpr const char* kWhat = "a list of points [[x, y], ...]";
  std::vector<Vec2> result;
  for (const toml::node& node : data_->array(data_->need(key, kWhat), key, kWhat))
    result.push_back(data_->point(node, key, kWhat));
  return result;
}

std::vector<double> TomlTable::numbers(const std::string& key) const {
  constexpr const char* kWhat = "a list of finite numbers";
  std::vector<double> result;
  for (const toml::node& node : data_->array(data_->need(key, kWhat), key, kWhat))
    result.push_back(data_->number(node, key, kWhat));
  return result;
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
  std::vector<std::string> result;
  for (const toml::node& node : data_->array(data_->need(key, kWhat), key, kWhat)) {
    if (!node.is_string()) data_->expected(node, key, kWhat);
    result.push_back(*node.value<std::string>());
  }
  return result;
}

TomlTable TomlTable::table(const std::string& key) const {
  const std::string what = "a table of keys and values";
  const toml::node& node = data_->need(key, what);
  if (!node.is_table()) data_->expected(node, key, what);
  return TomlTable(data_->child(*node.as_table(), data_->name(key)));
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
    result.push_back(TomlTable(data_->child(*item.as_table(), data_->name(key))));
  }
  return result;
}

void TomlTable::finish() const {
  for (const auto& [key, node] : *data_->table) {
    const std::string name(key.str());
    if (data_->asked.contains(name)) continue;
    const std::vector<std::string> known(data_->asked.begin(), data_->asked.end());
    std::string message = data_->file.string() + ":" + std::to_string(key.source().begin.line) +
                          ": unknown key '" + data_->name(name) + "'";
    if (const auto near = nearest_name(name, known)) {
      message += "; did you mean '" + *near + "'?";
    } else {
      message += "; known here:";
      for (const std::string& other : known) message += " " + other;
    }
    throw InputError(message);
  }
}

}  // namespace delquad
