// SPDX-License-Identifier: GPL-3.0-or-later
#include <expat.h>
#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "base/located.h"
#include "delquad/error.h"
#include "geometry/mesh/drop_unused_points.h"
#include "io/face_reader.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"

// 3D Manufacturing Format, core specification 1.3, with its materials: a ZIP archive with models in XML. By
// its production extension, objects may lie in other files of the archive.

namespace delquad {

namespace {

/// Row by row, the last row is the shift, as 3MF writes it: x' = x m00 + y m10 + z m20 + m30.
struct Transform {
  std::array<double, 12> m = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

  Vec3 operator()(const Vec3& p) const {
    return {p.x * m[0] + p.y * m[3] + p.z * m[6] + m[9], p.x * m[1] + p.y * m[4] + p.z * m[7] + m[10],
            p.x * m[2] + p.y * m[5] + p.z * m[8] + m[11]};
  }
  bool mirrors() const { return dot(cross({m[0], m[1], m[2]}, {m[3], m[4], m[5]}), {m[6], m[7], m[8]}) < 0; }
};

struct Triangle {
  std::array<int, 3> v;
  std::string colour;
};

/// The file of the archive, and the object's number there.
using ObjectId = std::pair<std::string, int>;

struct Component {
  ObjectId object;
  Transform transform;
};

/// A mesh, or other objects put together.
struct Object {
  std::string name;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<Component> components;
  int depth = 0;    ///< of components in components
  double size = 1;  ///< points, triangles and objects in it, also in its components
};

struct ZipCloser {
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

/// The files of the archive.
class Archive {
 public:
  explicit Archive(std::string path) : path_(std::move(path)) {
    int error = 0;
    archive_.reset(zip_open(path_.c_str(), ZIP_RDONLY, &error));
    if (archive_) return;
    zip_error_t reason;
    zip_error_init_with_code(&reason, error);
    const std::string text = zip_error_strerror(&reason);
    zip_error_fini(&reason);
    throw InputError(path_ + ": not a readable 3MF file, which is a ZIP archive: " + text);
  }

  const std::string& path() const { return path_; }

  /// Returns the text of a file, and nothing if there is no such file. Sizes that the archive states do not
  /// count.
  std::optional<std::string> text_of(const std::string& name) const {
    const zip_int64_t at = zip_name_locate(archive_.get(), name.c_str(), ZIP_FL_NOCASE);
    if (at < 0) return std::nullopt;
    const std::unique_ptr<zip_file_t, ZipCloser> file(
        zip_fopen_index(archive_.get(), static_cast<zip_uint64_t>(at), 0));
    if (!file) fail(name, zip_strerror(archive_.get()));
    constexpr std::size_t kInflated = 1 << 16, kMostBytes = 1'000'000'000;
    std::string text;
    for (;;) {
      const std::size_t before = text.size();
      text.resize(before + kInflated);
      const zip_int64_t n = zip_fread(file.get(), text.data() + before, kInflated);
      if (n < 0) fail(name, zip_file_strerror(file.get()));
      text.resize(before + static_cast<std::size_t>(n));
      if (n == 0) return text;
      if (text.size() > kMostBytes)
        throw InputError(path_ + ": " + name + " has more than 1 GB: expected a smaller part");
    }
  }

  /// The first file with a model that is no part of another, where none has the usual name.
  std::string main_model() const {
    constexpr const char* kUsual = "3D/3dmodel.model";
    if (zip_name_locate(archive_.get(), kUsual, ZIP_FL_NOCASE) >= 0) return kUsual;
    for (zip_int64_t i = 0; i < zip_get_num_entries(archive_.get(), 0); ++i) {
      const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
      if (name != nullptr && std::string_view(name).ends_with(".model") &&
          !std::string_view(name).starts_with("3D/Objects/"))
        return name;
    }
    throw InputError(path_ + ": a ZIP archive without a model (3D/*.model): expected a 3MF file");
  }

 private:
  [[noreturn]] void fail(const std::string& name, const char* reason) const {
    refuse("{}: {} cannot be unpacked: {}", path_, name, reason);
  }

  std::string path_;
  std::unique_ptr<zip_t, ZipCloser> archive_;
};

/// The contents of an XML file of the archive, gathered while it is read. Objects of other files follow when
/// they are named.
class ModelParser {
 public:
  using Objects = std::map<ObjectId, Object>;

  ModelParser(const Archive& archive, std::string part, Objects& found, const ModelParser* main = nullptr)
      : objects(found),
        archive_(archive),
        part_(std::move(part)),
        main_(main),
        text_(archive.text_of(part_).value_or("")) {
    if (main_ != nullptr) unit = main_->unit;
  }

  void parse() {
    constexpr std::size_t kPiece = 1 << 20;
    for (std::size_t at = 0; at < text_.size() || at == 0; at += kPiece) {
      const std::string_view piece = std::string_view(text_).substr(at, kPiece);
      const bool is_last = at + kPiece >= text_.size();
      const auto status =
          XML_Parse(parser_.get(), piece.data(), static_cast<int>(piece.size()), is_last ? 1 : 0);
      if (!reason_.empty()) throw InputError(reason_);
      if (status != XML_STATUS_OK)
        throw InputError(place() + XML_ErrorString(XML_GetErrorCode(parser_.get())));
    }
  }

  Objects& objects;
  std::vector<Component> build;
  std::string unit = "mm";

 private:
  using Attributes = std::map<std::string_view, std::string_view>;

  struct Closer {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };
  using Parser = std::unique_ptr<std::remove_pointer_t<XML_Parser>, Closer>;

  Parser make_parser() {
    XML_Parser parser = XML_ParserCreate(nullptr);
    if (parser == nullptr) throw std::bad_alloc();
    XML_SetUserData(parser, this);
    // Exceptions must not pass through C.
    XML_SetElementHandler(
        parser,
        [](void* self, const XML_Char* name, const XML_Char** attributes) {
          static_cast<ModelParser*>(self)->begin_guarded(name, attributes);
        },
        [](void*, const XML_Char*) {});
    return Parser(parser);
  }

  std::string place() const {
    const std::string part = main_ == nullptr ? "its model" : part_;
    return fmt::format("{}: {}, line {}: ", archive_.path(), part, XML_GetCurrentLineNumber(parser_.get()));
  }

  void begin_guarded(const char* name, const char** list) {
    if (!reason_.empty()) return;
    try {
      Attributes attributes;
      for (; *list != nullptr; list += 2) attributes.emplace(list[0], list[1]);
      const char* colon = std::strchr(name, ':');
      begin(colon == nullptr ? name : colon + 1, attributes);
    } catch (const std::exception& error) {
      const std::string reason = error.what();
      reason_ = reason.starts_with(archive_.path()) ? reason : place() + reason;
      XML_StopParser(parser_.get(), XML_FALSE);
    }
  }

  static std::string_view text_of(const Attributes& attributes, std::string_view key) {
    const auto at = attributes.find(key);
    if (at == attributes.end()) refuse("expected an attribute '{}'", key);
    return at->second;
  }

  template <class T>
  static T number(std::string_view text, std::string_view what) {
    while (!text.empty() && text[0] == ' ') text.remove_prefix(1);
    if (text.starts_with('+')) text.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() ||
        !std::isfinite(static_cast<double>(value)))
      refuse("{}: expected a number, found {}", what, TextScanner::printable(text));
    return value;
  }

  static Transform transform_of(const Attributes& attributes) {
    Transform transform;
    const auto at = attributes.find("transform");
    if (at == attributes.end()) return transform;
    std::string_view rest = at->second;
    for (double& m : transform.m) {
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
      const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n"));
      m = number<double>(word, "transform");
      rest.remove_prefix(word.size());
    }
    return transform;
  }

  Component component_of(const Attributes& attributes) {
    const int id = number<int>(text_of(attributes, "objectid"), "objectid");
    const auto path =
        std::ranges::find_if(attributes, [](const auto& a) { return a.first.ends_with(":path"); });
    const std::string part = path == attributes.end() ? part_ : read_part(path->second);
    if (objects.find({part, id}) == objects.end())
      refuse("objectid {}: there is no such object {}", id, part == part_ ? "before it" : "in " + part);
    return {{part, id}, transform_of(attributes)};
  }

  /// Reads another file of the archive, once; returns its name.
  std::string read_part(std::string_view path) {
    std::string part(path.substr(path.starts_with('/') ? 1 : 0));
    if (part == part_) return part;
    if (main_ != nullptr)
      refuse("an object in {}: expected objects in other files in the main model alone",
             TextScanner::printable(path));
    if (!parts_.insert(part).second) return part;
    if (!archive_.text_of(part))
      refuse("there is no file {} in the archive: expected a whole 3MF file", TextScanner::printable(path));
    ModelParser(archive_, part, objects, this).parse();
    return part;
  }

  void begin(std::string_view name, const Attributes& attributes) {
    if (name == "model") {
      set_unit(attributes);
    } else if (name == "basematerials" || name == "colorgroup") {
      palette_ = &palettes_[number<int>(text_of(attributes, "id"), "id")];
    } else if ((name == "base" || name == "color") && palette_ != nullptr) {
      palette_->push_back(colour_of(text_of(attributes, name == "base" ? "displaycolor" : "color")));
    } else if (name == "object") {
      begin_object(attributes);
    } else if (name == "vertex" && object_ != nullptr) {
      ++object_->size;
      object_->points.push_back({number<double>(text_of(attributes, "x"), "x"),
                                 number<double>(text_of(attributes, "y"), "y"),
                                 number<double>(text_of(attributes, "z"), "z")});
    } else if (name == "triangle" && object_ != nullptr) {
      add_triangle(attributes);
    } else if (name == "component" && object_ != nullptr) {
      add_component(component_of(attributes));
    } else if (name == "item") {
      build.push_back(component_of(attributes));
    }
  }

  void set_unit(const Attributes& attributes) {
    static const std::map<std::string_view, const char*> kUnits = {{"micron", "um"},     {"millimeter", "mm"},
                                                                   {"centimeter", "cm"}, {"meter", "m"},
                                                                   {"inch", "in"},       {"foot", "ft"}};
    const auto given = attributes.find("unit");
    if (given == attributes.end()) return;
    const auto at = kUnits.find(given->second);
    if (at == kUnits.end()) refuse("unknown unit {}", TextScanner::printable(given->second));
    if (main_ != nullptr && unit != at->second)
      refuse("lengths in {}, but the main model is in {}: expected one unit", at->second, unit);
    unit = at->second;
  }

  /// "#RRGGBB", perhaps with an opacity after it.
  static std::string colour_of(std::string_view text) {
    std::string colour;
    if (text.size() < 7 || text[0] != '#') return colour;
    for (const char c : text.substr(1, 6)) colour += c >= 'A' && c <= 'F' ? static_cast<char>(c + 32) : c;
    return colour.find_first_not_of("0123456789abcdef") == std::string::npos ? colour : "";
  }

  std::string colour_of(const Attributes& attributes, const char* group, const char* index) const {
    const auto pid = attributes.find(group), at = attributes.find(index);
    const auto palette =
        palettes_.find(pid == attributes.end() ? palette_of_object_ : number<int>(pid->second, group));
    if (palette == palettes_.end()) return "";
    const int i = at == attributes.end() ? colour_of_object_ : number<int>(at->second, index);
    return i >= 0 && i < static_cast<int>(palette->second.size()) ? palette->second[i] : "";
  }

  void begin_object(const Attributes& attributes) {
    const int id = number<int>(text_of(attributes, "id"), "id");
    const auto [at, is_new] = objects.try_emplace({part_, id});
    if (!is_new) refuse("a second object {}", id);
    object_ = &at->second;
    if (const auto name = attributes.find("name"); name != attributes.end()) object_->name = name->second;
    const auto pid = attributes.find("pid"), index = attributes.find("pindex");
    palette_of_object_ = pid == attributes.end() ? -1 : number<int>(pid->second, "pid");
    colour_of_object_ = index == attributes.end() ? -1 : number<int>(index->second, "pindex");
  }

  void add_triangle(const Attributes& attributes) {
    Triangle triangle;
    for (int k = 0; k < 3; ++k) {
      constexpr std::array<const char*, 3> kNames = {"v1", "v2", "v3"};
      const int v = number<int>(text_of(attributes, kNames[k]), kNames[k]);
      if (v < 0 || v >= static_cast<int>(object_->points.size()))
        refuse("{}: expected a vertex below {}, found {}", kNames[k], object_->points.size(), v);
      triangle.v[k] = v;
    }
    triangle.colour = colour_of(attributes, "pid", "p1");
    object_->triangles.push_back(std::move(triangle));
    ++object_->size;
  }

  void add_component(const Component& component) {
    constexpr int kDeepest = 64;
    if (&objects.at(component.object) == object_)
      throw InputError("an object holds itself: expected objects without a circle");
    object_->depth = std::max(object_->depth, objects.at(component.object).depth + 1);
    if (object_->depth > kDeepest) refuse("objects within objects to more than {} levels", kDeepest);
    object_->components.push_back(component);
    object_->size += objects.at(component.object).size;
  }

  const Archive& archive_;
  std::string part_;         ///< the file of the archive
  const ModelParser* main_;  ///< that names this one; null: it is the main model itself
  std::string text_, reason_;
  std::set<std::string> parts_;  ///< that were read
  Parser parser_ = make_parser();
  Object* object_ = nullptr;
  std::map<int, std::vector<std::string>> palettes_;
  std::vector<std::string>* palette_ = nullptr;
  int palette_of_object_ = -1, colour_of_object_ = -1;
};

/// Points and triangles: objects that hold one another could ask for any number.
constexpr double kMostItems = 5e7;

/// Puts the objects of the build where they belong.
class Assembly {
 public:
  explicit Assembly(const ModelParser& model) : model_(model) {}

  Mesh mesh;
  FaceColours colours;

  void add(const Component& component, const std::vector<Transform>& outer, const std::string& name) {
    const Object& object = model_.objects.at(component.object);
    std::vector<Transform> transforms = {component.transform};
    transforms.insert(transforms.end(), outer.begin(), outer.end());
    const std::string own = object.name.empty() ? name : object.name;
    const int first = static_cast<int>(mesh.points.size());
    for (Vec3 p : object.points) {
      for (const Transform& t : transforms) p = t(p);
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        throw InputError(
            "an object is placed where coordinates are not finite: expected a finite 'transform'");
      mesh.points.push_back(p);
    }
    if (!object.points.empty()) first_points_[first] = component.object;
    const bool turns = std::ranges::count_if(transforms, &Transform::mirrors) % 2 != 0;
    for (const Triangle& t : object.triangles) {
      const auto [a, b, c] = t.v;
      mesh.triangles.push_back({first + a, first + (turns ? c : b), first + (turns ? b : c)});
      mesh.triangle_region.push_back(colours.region(own, t.colour));
    }
    for (const Component& inner : object.components) add(inner, transforms, own);
  }

  /// "object 3, vertex 7": where the model has a point of the mesh.
  std::string place(int point) const {
    const auto at = std::prev(first_points_.upper_bound(point));
    return fmt::format("{}, object {}, vertex {}", at->second.first, at->second.second, point - at->first);
  }

 private:
  const ModelParser& model_;
  std::map<int, ObjectId> first_points_;  ///< of the objects that were placed
};

/// Reads 3MF: what the model's build holds, from whatever file of the archive, in its unit. Each object is a
/// region with its name, or one for each of its colors, unless there are more than 64. Throws InputError
/// with the line of the model inside.
Mesh read_3mf(const std::filesystem::path& path, ReadNotes* notes, Strays strays) {
  const Archive archive(path.string());
  ModelParser::Objects objects;
  ModelParser model(archive, archive.main_model(), objects);
  model.parse();
  double size = 0;
  for (const Component& item : model.build) size += model.objects.at(item.object).size;
  if (size > kMostItems)
    refuse("{}: its objects have more than {:.0e} points and triangles", path.string(), kMostItems);
  Assembly assembly(model);
  for (const Component& item : model.build) located(path.string(), [&] { assembly.add(item, {}, ""); });
  Mesh mesh = std::move(assembly.mesh);
  if (mesh.triangles.empty()) throw InputError(path.string() + ": the file's build holds no triangles");
  check_strays(mesh, strays, [&](int i) { return path.string() + ": " + assembly.place(i); });
  assembly.colours.finish(mesh, notes);
  mesh.unit = model.unit;
  drop_unused_points(mesh);
  return mesh;
}

}  // namespace

MeshFormat three_mf_format() { return {{".3mf"}, "3D Manufacturing Format", read_3mf}; }

}  // namespace delquad
