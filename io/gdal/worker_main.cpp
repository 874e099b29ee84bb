#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "base/located.h"
#include "base/utf8.h"
#include "base/worker_process.h"
#include "io/gdal/gdal_files.h"
#include "io/gdal/gdal_request.h"

// The program that reads files by GDAL. It is started by the library, with its number as its parent's and a
// socket as standard input.

namespace delquad {

namespace {

/// Of processor time: far more than files need.
constexpr unsigned kSeconds = 600;
constexpr double kMostCells = 1 << 28;

std::string failure;  // the first that GDAL told

void hear_error(CPLErr kind, CPLErrorNum, const char* message) {
  if (kind >= CE_Failure && failure.empty()) failure = message;
}

void check_failure(bool failed = true) {
  if (failed && !failure.empty()) refuse("GDAL: {}", failure);
}

GDALDatasetUniquePtr open(const std::string& path, unsigned kind, const char* what) {
  GDALDatasetUniquePtr file(GDALDataset::Open(path.c_str(), kind | GDAL_OF_VERBOSE_ERROR));
  check_failure(!file);
  if (!file) refuse("GDAL knows no {} of this kind", what);
  failure.clear();
  return file;
}

OGRSpatialReference system_named(const std::string& name) {
  OGRSpatialReference system;
  if (system.SetFromUserInput(name.c_str()) != OGRERR_NONE)
    refuse("'{}' is no coordinate system that PROJ knows: expected \"utm\" or one such as EPSG:32631", name);
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return system;
}

/// "EPSG:32631", or all that is known of it.
std::string text_of(const OGRSpatialReference* system) {
  if (system == nullptr) return "";
  if (const char* code = system->GetAuthorityCode(nullptr))
    return fmt::format("{}:{}", system->GetAuthorityName(nullptr), code);
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  char* text = nullptr;
  system->exportToWkt(&text, options);
  const std::unique_ptr<char, decltype(&CPLFree)> owner(text, &CPLFree);
  return text;
}

/// The zone in which the middle of the layer lies.
OGRSpatialReference utm_of(OGRLayer& layer, const OGRSpatialReference& from) {
  OGREnvelope box;
  if (layer.GetExtent(&box) != OGRERR_NONE) refuse("there is nothing in the layer");
  OGRSpatialReference degrees = system_named("EPSG:4326");
  const std::unique_ptr<OGRCoordinateTransformation> way(OGRCreateCoordinateTransformation(&from, &degrees));
  double x = (box.MinX + box.MaxX) / 2, y = (box.MinY + box.MaxY) / 2;
  if (!way || !way->Transform(1, &x, &y)) refuse("its middle has no longitude and latitude");
  constexpr int kNorth = 32600, kSouth = 32700, kZones = 60, kZone = 6, kFirst = -180;
  const int zone = static_cast<int>(std::floor((x - kFirst) / kZone)) % kZones + 1;
  return system_named(fmt::format("EPSG:{}", (y < 0 ? kSouth : kNorth) + zone));
}

OGRLayer& layer_of(GDALDataset& file, const std::string& name) {
  std::vector<std::string> names;
  for (OGRLayer* layer : file.GetLayers()) {
    names.push_back(layer->GetName());
    if (name == names.back()) return *layer;
  }
  if (names.size() == 1 && name.empty()) return *file.GetLayer(0);
  if (names.empty()) refuse("there is no layer");
  refuse("{}: expected FILE:LAYER with one of {}",
         name.empty() ? "there are several layers" : fmt::format("there is no layer '{}'", name),
         fmt::join(names, ", "));
}

using Texts = std::vector<std::string>;

/// What a tool of GDAL is told.
CPLStringList list_of(const Texts& texts) {
  CPLStringList list;
  for (const std::string& text : texts) list.AddString(text.c_str());
  return list;
}

/// The bytes of a data set that a tool writes to memory as GeoJSON.
std::string geojson_of(GDALDataset& file, Texts options) {
  const char* const kFile = "/vsimem/outlines.geojson";
  options.insert(options.begin(),
                 {"-f", "GeoJSON", "-lco", "SIGNIFICANT_FIGURES=17", "-nlt", "CONVERT_TO_LINEAR"});
  const std::unique_ptr<GDALVectorTranslateOptions, decltype(&GDALVectorTranslateOptionsFree)> told(
      GDALVectorTranslateOptionsNew(list_of(options).List(), nullptr), &GDALVectorTranslateOptionsFree);
  GDALDatasetH source = &file;
  GDALClose(GDALVectorTranslate(kFile, nullptr, 1, &source, told.get(), nullptr));
  check_failure();
  vsi_l_offset size = 0;
  const GByte* bytes = VSIGetMemFileBuffer(kFile, &size, FALSE);
  return as_utf8({reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)});
}

std::string outlines(const Texts& asked) {
  const std::string &path = asked[0], &name = asked[1], &project = asked[2];
  const auto file = open(path, GDAL_OF_VECTOR, "outlines");
  OGRLayer& layer = layer_of(*file, name);
  const OGRSpatialReference* system = layer.GetSpatialRef();
  Texts options;
  OGRSpatialReference target;
  if (!project.empty()) {
    if (system == nullptr) refuse("no coordinate system is told: it cannot be projected to '{}'", project);
    target = project == "utm" ? utm_of(layer, *system) : system_named(project);
    system = &target;
    options = {"-t_srs", text_of(system)};
  }
  options.push_back(layer.GetName());
  const bool in_degrees = system != nullptr && system->IsGeographic();
  return (in_degrees ? kDegrees : '-') + text_of(system) + '\0' + geojson_of(*file, options);
}

GDALDatasetUniquePtr projected(GDALDatasetUniquePtr file, const std::string& crs) {
  const OGRSpatialReference* from = file->GetSpatialRef();
  if (crs.empty() || from == nullptr) return file;
  const OGRSpatialReference to = system_named(crs);
  if (from->IsSame(&to)) return file;
  const CPLStringList told = list_of({"-of", "MEM", "-t_srs", crs, "-r", "bilinear", "-et", "0", "-wo",
                                      "XSCALE=1", "-wo", "YSCALE=1", "-ot", "Float32", "-dstnodata", "nan"});
  const std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> options(
      GDALWarpAppOptionsNew(const_cast<CPLStringList&>(told).List(), nullptr), &GDALWarpAppOptionsFree);
  GDALDatasetH source = file.get();
  GDALDatasetUniquePtr result(
      GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &source, options.get(), nullptr)));
  check_failure();
  return result;
}

void check_size(GDALDataset& file) {
  if (1. * file.GetRasterXSize() * file.GetRasterYSize() > kMostCells)
    refuse("{} x {} cells: more than {:g}: cut out what is needed ('gdal_translate -projwin')",
           file.GetRasterXSize(), file.GetRasterYSize(), kMostCells);
}

std::string raster(const Texts& asked) {
  auto file = open(asked[0], GDAL_OF_RASTER, "rasters");
  check_size(*file);
  file = projected(std::move(file), asked[1]);
  check_size(*file);
  RasterGrid grid{file->GetRasterXSize(), file->GetRasterYSize()};
  double place[6];
  if (file->GetRasterCount() == 0 || file->GetGeoTransform(place) != CE_None ||
      !GDALInvGeoTransform(place, grid.to_cells.data()))
    refuse("it does not say where its cells lie");
  GDALRasterBand& band = *file->GetRasterBand(1);
  const std::size_t n = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  std::vector<float> values(n);
  std::vector<GByte> valid(n);
  const auto read = [&](GDALRasterBand& from, void* to, GDALDataType type) {
    return from.RasterIO(GF_Read, 0, 0, grid.columns, grid.rows, to, grid.columns, grid.rows, type, 0, 0);
  };
  if (read(band, values.data(), GDT_Float32) != CE_None ||
      read(*band.GetMaskBand(), valid.data(), GDT_Byte) != CE_None)
    check_failure();
  for (std::size_t i = 0; i < n; ++i)
    values[i] = valid[i] == 0 ? std::numeric_limits<float>::quiet_NaN()
                              : static_cast<float>(values[i] * band.GetScale() + band.GetOffset());
  std::string reply(sizeof grid + n * sizeof(float), '\0');
  std::memcpy(reply.data(), &grid, sizeof grid);
  std::memcpy(reply.data() + sizeof grid, values.data(), n * sizeof(float));
  return reply;
}

std::string why_not() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return "damaged, or too large for the memory";
  } catch (const std::exception& error) {
    return as_utf8(error.what());
  }
}

}  // namespace

}  // namespace delquad

int main(int argc, char** argv) {
  using namespace delquad;
  constexpr int kInput = 0;
  if (argc != 2) return EXIT_FAILURE;
  work_for(
      kInput, std::atoi(argv[1]),
      [](const std::string& request) {
        limit_to(kSeconds);
        CPLSetErrorHandler(&hear_error);
        GDALAllRegister();
        const Texts asked = texts_of(request);
        const char kind = request.front();
        send_reply(kInput, kind, kind == kAskRaster ? raster(asked) : outlines(asked));
      },
      &why_not);
}
