#include "io/formats/msh_output.h"

#include <charconv>

namespace delquad {

namespace {

/// Names as they can stand between quotes, without control characters; Gmsh reads lines of up to 255 bytes.
std::string quotable(const std::string& name) {
  std::string label = name;
  for (char& c : label) {
    if (c == '"') c = '\'';
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return label;
}

}  // namespace

void write_msh_header(MshNumbers& out, bool binary) {
  out.line("$MeshFormat");
  out.line(binary ? "4.1 1 8" : "4.1 0 8");
  if (binary) {
    out.integer(1);
    out.line("");
  }
  out.line("$EndMeshFormat");
}

void write_msh_groups(MshNumbers& out, const MshGroups& groups) {
  if (groups.labels.empty()) return;
  out.line("$PhysicalNames");
  out.line(std::to_string(groups.labels.size()));
  for (const auto& [dim, tag, name] : groups.labels)
    out.line(std::to_string(dim) + ' ' + std::to_string(tag) + " \"" + name + '"');
  out.line("$EndPhysicalNames");
}

MshGroups number_msh_groups(const std::vector<UniqueLabels::Key>& keys) {
  constexpr size_t kLongestLabel = 200;
  const UniqueLabels labels(keys, {quotable, false, kLongestLabel});
  MshGroups groups;
  std::set<int> taken;
  for (const auto& key : keys) {
    int tag = 0;
    const std::string& name = key.second;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), tag);
    if (error != std::errc() || tag <= 0 || name != std::to_string(tag)) continue;
    groups.tags[key] = tag;
    taken.insert(tag);
  }
  int next = 1;
  for (const auto& key : keys) {
    if (!groups.tags.contains(key)) {
      while (taken.contains(next)) ++next;
      groups.tags[key] = next++;
    }
    groups.labels.insert({key.first, groups.tags[key], labels.of(key)});
  }
  return groups;
}

void write_more_names(std::ostream& stream, const std::vector<MshEntity>& entities) {
  TextWriter out(stream);
  std::vector<std::pair<const MshEntity*, std::string>> all;
  for (const MshEntity& entity : entities)
    for (const std::string& name : entity.entity->names)
      if (name != entity.group) all.emplace_back(&entity, quotable(name));
  if (all.empty()) return;
  out << "$MoreNames\n" << all.size() << '\n';
  for (const auto& [entity, name] : all)
    out << entity->dim << ' ' << entity->entity->tag << " \"" << name << "\"\n";
  out << "$EndMoreNames\n";
  out.flush();
}

void write_msh_unit(std::ostream& stream, const std::string& unit) {
  if (!unit.empty()) stream << "$Unit\n" << unit << "\n$EndUnit\n";
}

}  // namespace delquad
