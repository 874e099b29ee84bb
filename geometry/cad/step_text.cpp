#include "geometry/cad/step_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace delquad::cad {

namespace {

struct Range {
  std::size_t begin, end;
};

struct Reference {
  int to, owner;  ///< number of an entity, index of a statement
  int list;       ///< -1: an argument by itself
  Range at;
  bool is_dropped = false;
};

struct Statement {
  int number;
  std::string_view type;  ///< the first, of several
  Range at;
  int first, end;  ///< references
  bool is_damaged = false;
};

bool has_word(std::string_view type, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words,
                             [&](std::string_view w) { return type.find(w) != std::string_view::npos; });
}

bool is_face_type(std::string_view type) { return type == "ADVANCED_FACE" || type == "FACE_SURFACE"; }
bool is_shell_type(std::string_view type) { return has_word(type, {"_SHELL", "CONNECTED_FACE_SET"}); }
bool is_representation(std::string_view type) {
  return has_word(type, {"REPRESENTATION"}) && !has_word(type, {"DEFINITION", "PRESENTATION_R"});
}
/// Of a list of these any part may be missing.
bool is_collection(std::string_view type) {
  return is_shell_type(type) || is_representation(type) ||
         has_word(type, {"SURFACE_MODEL", "WITH_VOIDS", "GEOMETRIC_SET", "LAYER_ASSIGNMENT", "PRESENTATION"});
}
/// Products and where they are placed need no shape.
bool is_about_products(std::string_view type) {
  return type != "DEFINITIONAL_REPRESENTATION" &&
         has_word(type, {"PRODUCT", "DEFINITION", "CONTEXT", "RELATIONSHIP", "OCCURRENCE", "REPRESENTATION"});
}
bool is_curve_on_surfaces(std::string_view type) {
  return type == "SURFACE_CURVE" || type == "SEAM_CURVE" || type == "INTERSECTION_CURVE";
}

class StepText {
 public:
  explicit StepText(const std::string& text) : text_(text) {
    for (std::size_t at = 0; at < text_.size();) at = read_statement(at);
    for (int s = 0; s < std::ssize(statements_); ++s) index_of_.emplace(statements_[s].number, s);
  }

  StepRest without(const std::map<int, std::string>& unreadable) {
    StepRest rest;
    gone_.assign(statements_.size(), 0);
    rest.ends_early = in_data_;
    if (in_data_)
      rest.lost.push_back(
          fmt::format("it ends too early, in line {}", 1 + std::count(text_.begin(), text_.end(), '\n')));
    for (const auto& [number, reason] : unreadable)
      if (const auto at = index_of_.find(number); at != index_of_.end()) {
        rest.lost.push_back(fmt::format("{}: {}", title(at->second), reason));
        take_out(at->second);
      }
    for (int s = 0; s < std::ssize(statements_); ++s)
      if (statements_[s].is_damaged) {
        rest.lost.push_back(fmt::format("{}: it is damaged", title(s)));
        take_out(s);
        is_shape_hurt_ = true;  // whatever it was about
      }
    std::set<int> told;
    for (Reference& r : references_)
      if (!index_of_.contains(r.to)) {
        if (!in_data_ && told.insert(r.to).second)
          rest.lost.push_back(fmt::format("#{}, which {} needs, is not defined", r.to, title(r.owner)));
        lose(r);
      }
    if (rest.lost.empty()) return rest;
    spread();
    bool is_left = false;
    for (int s = 0; s < std::ssize(statements_); ++s)
      if (is_face_type(statements_[s].type)) {
        if (gone_[s])
          rest.faces.push_back(statements_[s].number);
        else
          is_left = true;
      }
    rest.is_whole = !in_data_ && !is_shape_hurt_;
    if (rest.is_whole && only_in_space_.empty()) return {};
    if (is_left) rest.text = rewritten();
    return rest;
  }

 private:
  std::string title(int statement) const {
    return fmt::format("#{} ({})", statements_[statement].number, statements_[statement].type);
  }

  bool is_comment(std::size_t at) const { return text_.compare(at, 2, "/*") == 0; }

  /// Behind a text, a comment, or one character.
  std::size_t skip(std::size_t at) const {
    std::size_t end = at;
    if (text_[at] == '\'')
      end = text_.find('\'', at + 1);
    else if (is_comment(at))
      end = text_.find("*/", at + 2);
    return end == std::string::npos ? text_.size() : end + 1;
  }

  /// In any locale.
  static bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }
  static bool is_word(char c) { return is_ascii(c) && (std::isalnum(c) != 0 || c == '_'); }

  std::size_t end_of_word(std::size_t at) const {
    while (at < text_.size() && is_word(text_[at])) ++at;
    return at;
  }

  /// "#17", or 0.
  int number_at(std::size_t at) const {
    int number = 0;
    for (++at; at < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at])) != 0; ++at) {
      if (number > 100'000'000) return 0;
      number = 10 * number + (text_[at] - '0');
    }
    return number;
  }

  /// Returns where the next one begins.
  std::size_t read_statement(std::size_t at) {
    Statement s{0, {}, {at, at}, static_cast<int>(references_.size()), 0};
    std::string_view first;
    std::vector<int> open;  // lists, by their index
    std::size_t outer = 1;  // lists around arguments
    for (; at < text_.size() && text_[at] != ';';) {
      const char c = text_[at];
      if (c == '#') {
        const std::size_t end = end_of_word(at + 1);
        if (s.number == 0 && first.empty())
          s.number = number_at(at), s.at.begin = at;
        else
          references_.push_back({number_at(at),
                                 static_cast<int>(statements_.size()),
                                 open.size() > outer ? open.back() : -1,
                                 {at, end}});
        at = end;
      } else if (is_word(c)) {
        const std::size_t end = end_of_word(at);
        if (first.empty()) {
          first = std::string_view(text_).substr(at, end - at);
          outer = open.size() + 1;
          // Arguments follow.
          const std::size_t next = text_.find_first_not_of(" \t\r\n", end);
          s.is_damaged =
              s.is_damaged || next == std::string::npos || !(text_[next] == '(' || is_comment(next));
        }
        at = end;
      } else {
        if (c == '(') {
          open.push_back(static_cast<int>(lists_.size()));
          lists_.push_back({at, at});
        }
        if (c == ')') {
          s.is_damaged = s.is_damaged || open.empty();
          if (!open.empty()) {
            lists_[open.back()].end = at;
            open.pop_back();
          }
        }
        // Outside of texts and comments all is ASCII.
        s.is_damaged = s.is_damaged || !is_ascii(c) || (std::isprint(c) == 0 && std::isspace(c) == 0);
        at = skip(at);
      }
    }
    if (first == "DATA") in_data_ = true;
    if (first == "ENDSEC") in_data_ = false;
    s.is_damaged = s.is_damaged || !open.empty();
    s.at.end = std::min(at + 1, text_.size());
    if (s.number > 0 && at < text_.size()) {
      s.type = first;
      s.end = static_cast<int>(references_.size());
      statements_.push_back(s);
    } else {
      references_.resize(s.first);
    }
    if (at < text_.size()) end_ = s.at.end;
    return at + 1;
  }

  void take_out(int s) {
    if (gone_[s]) return;
    gone_[s] = 1;
    open_.push_back(s);
    is_shape_hurt_ = is_shape_hurt_ || is_face_type(statements_[s].type);
  }

  /// What a reference leads to is missing.
  void lose(Reference& r) {
    const Statement& s = statements_[r.owner];
    if (gone_[r.owner]) return;
    if (is_curve_on_surfaces(s.type) && r.list >= 0) {
      only_in_space_.insert(r.owner);
      return;
    }
    if (r.list >= 0 && is_collection(s.type)) {
      r.is_dropped = true;
      shortened_.insert(r.owner);
      is_shape_hurt_ = is_shape_hurt_ || is_shell_type(s.type) || is_representation(s.type);
      for (int i = s.first; i < s.end; ++i)
        if (references_[i].list == r.list && !references_[i].is_dropped) return;
    }
    if (!is_about_products(s.type)) take_out(r.owner);
  }

  /// To all that needs what is gone.
  void spread() {
    for (int i = 0; i < std::ssize(references_); ++i) users_.emplace_back(references_[i].to, i);
    std::ranges::sort(users_);
    while (!open_.empty()) {
      const int number = statements_[open_.back()].number;
      open_.pop_back();
      for (const auto& [to, i] : std::ranges::equal_range(users_, number, {}, &std::pair<int, int>::first))
        lose(references_[i]);
    }
  }

  /// Faces or shells that nothing has which is left.
  std::string forsaken(bool (*is_wanted)(std::string_view),
                       std::initializer_list<std::string_view> owners) const {
    std::string list;
    for (int s = 0; s < std::ssize(statements_); ++s) {
      if (gone_[s] || !is_wanted(statements_[s].type)) continue;
      const auto users =
          std::ranges::equal_range(users_, statements_[s].number, {}, &std::pair<int, int>::first);
      if (std::ranges::none_of(users, [&](const auto& user) {
            const int owner = references_[user.second].owner;
            return !gone_[owner] && has_word(statements_[owner].type, owners);
          }))
        list += fmt::format("{}#{}", list.empty() ? "" : ",", statements_[s].number);
    }
    return list;
  }

  /// A surface of what belonged to missing solids: its entities, and its number.
  std::pair<std::string, int> surface_of_forsaken() const {
    int number = 0;
    for (const Statement& s : statements_) number = std::max(number, s.number);
    std::string made, shells = forsaken(is_shell_type, {"BREP", "SURFACE_MODEL", "ORIENTED"});
    if (const std::string faces = forsaken(is_face_type, {"_SHELL", "CONNECTED_FACE_SET"}); !faces.empty()) {
      made = fmt::format("#{}=OPEN_SHELL('',({}));\n", ++number, faces);
      shells += fmt::format("{}#{}", shells.empty() ? "" : ",", number);
    }
    if (shells.empty()) return {"", 0};
    made += fmt::format("#{}=SHELL_BASED_SURFACE_MODEL('',({}));\n", ++number, shells);
    return {made, number};
  }

  std::string rewritten() const {
    std::vector<std::pair<Range, std::string>> edits;
    std::vector<int> short_of_items;  // representations
    for (const int s : shortened_)
      if (!gone_[s] && is_representation(statements_[s].type)) short_of_items.push_back(s);
    std::pair<std::string, int> made;
    if (short_of_items.size() == 1) {
      made = surface_of_forsaken();
      const std::size_t before = statements_[short_of_items[0]].at.begin;
      edits.push_back({{before, before}, made.first});
    }
    for (int s = 0; s < std::ssize(statements_); ++s)
      if (gone_[s] || only_in_space_.contains(s)) edits.push_back({statements_[s].at, ""});
    for (const int s : shortened_) {
      if (gone_[s]) continue;
      std::map<int, std::string> kept;  // by list
      for (int i = statements_[s].first; i < statements_[s].end; ++i) {
        if (references_[i].list < 0) continue;
        std::string& list = kept[references_[i].list];
        if (!references_[i].is_dropped)
          list += fmt::format("{}#{}", list.empty() ? "" : ",", references_[i].to);
      }
      if (made.second > 0 && s == short_of_items[0]) {
        std::string& list = kept.begin()->second;
        list += fmt::format("{}#{}", list.empty() ? "" : ",", made.second);
      }
      for (const auto& [list, items] : kept)
        edits.push_back({{lists_[list].begin, lists_[list].end}, "(" + items});
    }
    for (const Reference& r : references_)
      if (const auto at = index_of_.find(r.to); at != index_of_.end() && !gone_[r.owner] &&
                                                only_in_space_.contains(at->second) && !gone_[at->second])
        edits.push_back({r.at, fmt::format("#{}", references_[statements_[at->second].first].to)});
    std::ranges::sort(edits, {}, [](const auto& e) { return std::pair(e.first.begin, e.first.end); });
    std::string text;
    std::size_t done = 0;
    for (const auto& [range, replacement] : edits) {
      if (range.begin < done) continue;
      text.append(text_, done, range.begin - done).append(replacement);
      done = range.end;
    }
    text.append(text_, done, end_ - done);
    return in_data_ ? text + "\nENDSEC;\nEND-ISO-10303-21;\n" : text;
  }

  const std::string& text_;
  std::vector<Statement> statements_;
  std::vector<Reference> references_;
  std::vector<Range> lists_;
  std::unordered_map<int, int> index_of_;  ///< of statements, by number
  bool in_data_ = false;                   ///< in the end: it is cut off
  std::size_t end_ = 0;                    ///< of the last whole statement
  std::vector<char> gone_;
  std::vector<int> open_;
  std::vector<std::pair<int, int>> users_;   ///< number of an entity, and a reference to it
  std::set<int> shortened_, only_in_space_;  ///< statements
  bool is_shape_hurt_ = false;
};

}  // namespace

StepRest rest_of_step(const std::string& text, const std::map<int, std::string>& unreadable) {
  return StepText(text).without(unreadable);
}

}  // namespace delquad::cad
