// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "algorithms/fields/sampled_fields.h"
#include "algorithms/regularity/regularity.h"
#include "algorithms/treatment/treatment.h"
#include "base/activity.h"
#include "base/box.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/text.h"
#include "features/crosses/made_crosses.h"
#include "features/crosses/size_aware.h"
#include "features/curves/compose_size.h"
#include "features/curves/mesh_surface_curves.h"
#include "features/curves/surface_input.h"
#include "features/embedded/imprint.h"
#include "features/given/given_domain.h"
#include "features/given/given_surface.h"
#include "features/given/given_worst.h"
#include "features/grids/grids.h"
#include "features/layers/add_layers.h"
#include "features/metric/metric_surface.h"
#include "features/midsurface/opposite_sides.h"
#include "features/naming/name_parts.h"
#include "features/periodic/periodic.h"
#include "features/seed/perturb.h"
#include "features/sizes/curve_options.h"
#include "features/sizes/fine_spots.h"
#include "features/sizes/named_parts.h"
#include "features/sizes/size_warnings.h"
#include "features/symmetry/mirrored_surface.h"
#include "features/thin/gap_sizes.h"
#include "features/washers/surface_washers.h"
#include "geometry/mesh/model_kind.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/improve_triangulation.h"
#include "mesher/prepare.h"
#include "metrics/judgement/criteria.h"

namespace delquad {
namespace {

/// Faces that cannot be meshed. They end the run, or are left out if problem.keep_going is set.
class Failures {
 public:
  explicit Failures(const MeshProblem& problem) : where_(problem.where), keep_going_(problem.keep_going) {}

  /// Failures of these faces, by region, do not count.
  void ignore(std::vector<char> faces) { ignored_ = std::move(faces); }
  void add(int face, const std::string& reason) {
    if (is_ignored(face)) return;
    if (!keep_going_) throw InputError(where_ + ": " + reason);
    failures_.push_back({face, reason});
  }
  bool are_left_out() const { return keep_going_ || !ignored_.empty(); }
  bool is_ignored(int face) const { return face >= 0 && !ignored_.empty() && ignored_[face] != 0; }
  std::vector<FaceFailure> take() {
    std::ranges::stable_sort(failures_, {}, &FaceFailure::face);
    return std::move(failures_);
  }

 private:
  std::string where_;
  bool keep_going_;
  std::vector<char> ignored_;
  std::vector<FaceFailure> failures_;
};

void add_unflattened(const Flattening& flattening, const SurfaceModel& model, Failures& failures) {
  for (std::size_t i = 0; i < flattening.failed.size(); ++i) {
    const int face = flattening.failed[i];
    const auto& [low, high] = flattening.failed_at[i];
    failures.add(face,
                 fmt::format("face {} could not be flattened, not even in pieces: look between {} and {} "
                             "for triangles without area, or for a fold [not-flattened]",
                             model.fine.regions[face].tag, show_point(low), show_point(high)));
  }
}

/// Meshes the curves. Faces for which that is impossible are left out; faces with washers first lose these.
SurfaceDomain mesh_curves_of(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size,
                             const SizeField* asked, const MeshProblem& problem,
                             const std::vector<CurveDivision>& divisions, SurfaceWashers& washers,
                             const std::vector<LayerSpec>& layers, const MappedSpec& mapped,
                             const PeriodicSides& periodic, const CurveAgreement& agreement,
                             Failures& failures) {
  const auto solver = matching_solver(recombination_options(problem.options).solver, problem.options);
  while (!flattening.patches.empty()) {
    try {
      const bool may_repeat = failures.are_left_out() || washers.can_give_way();
      return make_surface_domain(model, may_repeat ? flattening : std::move(flattening), size, *solver, asked,
                                 divisions, periodic, mapped, agreement, layered_curves(model.fine, layers));
    } catch (const FaceError& error) {
      if (washers.give_way(error)) continue;
      failures.add(error.face(), error.what());
      std::erase_if(flattening.patches, [&](const FlatPatch& p) { return p.face == error.face(); });
    }
  }
  throw InputError(model.source + ": no face can be meshed");
}

void check_surface_cross(const CrossSpec& cross) {
  if (cross.kind == CrossKind::kGradient || cross.kind == CrossKind::kField)
    throw InputError(cross.where +
                     ": a surface takes its crosses from its curves: expected 'boundary' or 'size-aware'");
}

/// Least size beside short curves, over the least length of the criteria.
constexpr double kLeastSize = 1.5;
/// Maps of given elements are taken when they distort less: these may be large, and every cut holds nodes.
constexpr double kMaxSigmaOfGiven = 1.6;

void prepare_patches(const std::shared_ptr<SurfaceSetup>& surface, MeshingSetup& p) {
  const std::vector<SurfacePatch>& patches = surface->domain.patches;
  p.patches.resize(patches.size());
  parallel_for(
      patches.size(),
      [&](std::size_t i) {
        const SurfacePatch& patch = patches[i];
        const FaceScope face(surface->model.fine.regions[patch.map.face].tag);
        const auto size = std::make_shared<SurfacePatchSize>(patch, surface->model.fine, *surface->size);
        size->limits = p.settings.limits;
        p.patches[i] = {
            patch.boundary, patch.map.face, std::make_shared<HarmonicCrossField>(patch.background), size,
            [surface, &patch](Vec2 u, int& hint) { return lift(patch, surface->model, u, hint); }};
      },
      [&](std::size_t i) { return static_cast<double>(patches[i].map.flat.triangles.size()); });
}

/// A cross field of the plane of a flat surface, in the parameters of a patch.
class FlatCross final : public CrossField {
 public:
  FlatCross(std::shared_ptr<const CrossField> cross, std::shared_ptr<const SurfaceSetup> surface, int patch)
      : cross_(std::move(cross)), surface_(std::move(surface)), patch_(surface_->domain.patches[patch]) {}
  Cross at(Vec2 u, int& hint) const override {
    const Mesh& fine = surface_->model.fine;
    const Vec3 x = fine_place(patch_, fine, u, hint);
    const auto [a, b] = tangents(patch_, fine, hint);
    int far_hint = -1;
    const double theta = cross_->at({x.x, x.y}, far_hint).angle();
    const Vec3 along{std::cos(theta), std::sin(theta), 0};
    return Cross::along({along.x * b.y - along.y * b.x, a.x * along.y - a.y * along.x});
  }

 private:
  std::shared_ptr<const CrossField> cross_;
  std::shared_ptr<const SurfaceSetup> surface_;
  const SurfacePatch& patch_;
};

/// Replaces the fields of a flat surface's patches by a field of its plane.
void follow_in_plane(const std::shared_ptr<const CrossField>& cross,
                     const std::shared_ptr<const SurfaceSetup>& surface, MeshingSetup& p) {
  for (std::size_t i = 0; i < p.patches.size(); ++i)
    p.patches[i].cross = std::make_shared<FlatCross>(cross, surface, static_cast<int>(i));
}

void append(std::vector<Warning>& warnings, const std::vector<Warning>& more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

/// Warns of gaps between regions of a flat surface.
void warn_of_flat_gaps(const SurfaceDomain& domain, std::vector<Warning>& warnings) {
  PlanarDomain flat;
  flat.boundary.curves = domain.boundary.curves;
  for (const SurfacePatch& patch : domain.patches) {
    PatchBoundary& boundary = flat.patches.emplace_back(patch.boundary);
    for (std::size_t i = 0; i < boundary.points.size(); ++i) {
      const Vec3& x = domain.nodes.points[boundary.point_node[i]];
      boundary.points[i] = {x.x, x.y};
    }
  }
  warn_of_gaps(flat, warnings);
}

class SurfaceSteps final : public ModelSteps {
 public:
  SurfaceSteps(const MeshProblem& problem, const RetryHints& hints) : problem_(problem), hints_(hints) {}

  void read(MeshingSetup& p) override {
    read_model(p);
    if (!kind_of(problem_.model).in_plane) check_surface_cross(problem_.cross);
    p.unselected = unselected_faces();
    failures_.ignore(p.unselected);
    check_count(expected_quads(model_.fine, SurfaceSize(asked_), {}, nullptr, p.unselected), problem_);
    cut_ = cut_at_planes(problem_, model_, asked_);
    if (cut_) divisions_ = divisions_of_part(problem_.divisions, *cut_);
    if (cut_) layers_ = layers_of_part(problem_.layers, *cut_);
    if (cut_) model_ = std::move(cut_->half.model);
    if (problem_.metric.asks())
      metric_ = wanted_metric(problem_, model_, hints_.spots);
    else
      wanted_ = surface_size(problem_, model_, asked_, divisions_, spots_of_curves(), part());
    if (shortest_ > 0 && !wanted_.curve_limit.empty()) keep_size_beside_curves();
  }

  /// Raises the sizes beside short curves to kLeastSize, by the least wanted size on each curve.
  void keep_size_beside_curves() {
    const Mesh& fine = model_.fine;
    std::vector<double> least(fine.curves.size(), std::numeric_limits<double>::infinity());
    int hint = -1;
    for (std::size_t l = 0; l < fine.lines.size(); ++l)
      for (const int v : fine.lines[l]) {
        double& size = least[fine.line_curve[l]];
        size = std::min(size, asked_->at(fine.points[v], hint));
      }
    for (std::size_t c = 0; c < least.size(); ++c)
      if (std::isfinite(least[c]))
        wanted_.curve_limit[c] = std::max(wanted_.curve_limit[c], kLeastSize * shortest_ * least[c]);
  }

  bool is_surface() const override { return true; }

  void flatten(MeshingSetup& p) override {
    improve_triangulation(model_);
    if (metric_) {
      wanted_.base = make_constant_size(1);
      wanted_.metric = refine_for_metric(model_, *metric_);
    } else if (const int rows = curve_options(problem_.options).gap_rows; rows > 0) {
      make_room_in_gaps(rows, p);
    }
    lay_flat();
  }

  void mesh_curves(MeshingSetup& p) override {
    surface_->cuts = flattening_.cuts;
    set_size(p);
    surface_->domain = curves_by(*surface_->size, std::move(flattening_));
    put_layers_on(p);
    if (!p.unselected.empty()) leave_out(p);
    surface_->model = std::move(model_);
    surface_->cad = cad_;
    surface_->metric = wanted_.metric;
    p.failures = failures_.take();
    p.surface = surface_;
    append(p.warnings, surface_->model.warnings);
    append(p.warnings, of_periodic_);
    append(p.warnings, surface_->domain.warnings);
    if (kind_of(problem_.model).in_plane) warn_of_flat_gaps(surface_->domain, p.warnings);
    if (!metric_) {
      warn_of_large_size(*wanted_.base, surface_->model.fine, p.warnings);
      warn_of_coarse_turns(wanted_, *surface_, p.warnings);
    }
    p.boundary = surface_->domain.boundary;
    p.boundary.unit = surface_->model.fine.unit;
  }

  void make_patches(MeshingSetup& p) override {
    prepare_patches(surface_, p);
    if (const auto cross = given_cross(problem_.cross, p.boundary, p)) follow_in_plane(cross, surface_, p);
    add_grids(mapped_, surface_->domain.mapped, p);
    for (std::size_t i = 0; i < p.patches.size(); ++i)
      if (p.patches[i].grid && p.patches[i].grid_stays)
        for (const auto& loop : surface_->domain.patches[i].outline)
          for (const CurveSide& side : loop) surface_->domain.chain_stays[side.chain] = 1;
    if (problem_.cross.kind == CrossKind::kSizeAware) make_crosses_size_aware(p);
    if (problem_.cross.kind == CrossKind::kMade) use_made_crosses(problem_.cross, p);
    if (problem_.cross.kind == CrossKind::kMetric)
      make_crosses_size_aware(
          p, [&](int patch, Vec2 u, int& hint) { return pull_at(*surface_, patch, u, hint); });
    if (!cut_) return;
    add_whole(std::move(*cut_), *surface_, p);
  }

 private:
  const CutSurface* part() const { return cut_ ? &*cut_ : nullptr; }

  void read_model(MeshingSetup& p) {
    std::vector<FeatureBall> kept;
    if (hints_.keep_features && problem_.surface.faces.empty())
      for (const SizeBall& spot : hints_.spots) kept.push_back({spot.at, spot.reach});
    cad_ = hints_.cad;
    model_ = make_surface(problem_, kept, cad_);
    if (problem_.surface.midsurface) find_opposite_sides();
    const std::string& where = problem_.surface.where.empty() ? problem_.where : problem_.surface.where;
    for (const int face : selected_faces(problem_.surface.faces, where, model_.fine))
      selected_.insert(model_.fine.regions[face].tag);
    if (problem_.metric.asks()) {
      const auto metric = [&] {
        return std::make_shared<SurfaceMetric>(model_, wanted_metric(problem_, model_, {}));
      };
      asked_ = metric();
      model_ = join_curves(problem_, *asked_, std::move(model_));
      imprint(model_, *asked_);
      asked_ = metric();
      return;
    }
    const SampleDomain domain = {Box<Vec3>::around(model_.fine.points), &model_.fine};
    asked_ = base_size(problem_.size, domain, p.warnings, [&] {
      return largest_size(
          problem_.size,
          problem_.size.from_boundary
              ? "'boundary' extends the lengths of a planar boundary that is "
                "kept; a surface's curves are meshed anew: expected a size (a "
                "number or an expression)"
              : "there is no size: expected a number, an expression or a number of quads (--size, --quads)");
    });
    p.settings.limits = limits_of(problem_.criteria, *asked_, model_.fine.points);
    if (least_length(problem_.criteria) != nullptr) shortest_ = p.settings.limits.shortest;
    model_ = join_curves(problem_, *asked_, std::move(model_), shortest_);
    washers_.plan(*asked_);
    asked_ = imprint_named(problem_.size.named, std::move(asked_), model_, p.warnings);
    washers_.divide_fillets();
  }

  SurfaceDomain curves_by(const SurfaceSize& size, Flattening flattening) {
    std::optional<SurfaceSize> other;
    if (problem_.seed != 0) {
      WantedSize on_curves = wanted_;
      on_curves.base = jittered(wanted_.base, problem_.seed, diagonal(model_.fine));
      other.emplace(model_, on_curves);
    }
    CurveAgreement agreement = agreement_of(problem_, selected_.empty() ? hints_ : RetryHints{});
    agreement.shortest = shortest_;
    return mesh_curves_of(model_, std::move(flattening), other ? *other : size,
                          wanted_.curvature || metric_ ? nullptr : wanted_.base.get(), problem_, divisions_,
                          washers_, layers_, mapped_, periodic_, agreement, failures_);
  }

  void lay_flat() {
    refine_for_size(model_, wanted_);
    periodic_ = find_periodic_sides(model_, problem_.periodic, of_periodic_);
    const bool has_divided = std::ranges::any_of(periodic_.curves, [&](const PeriodicPair& pair) {
      return std::ranges::find(divisions_, pair.from, &CurveDivision::name) != divisions_.end();
    });
    if (!problem_.layers.empty() && (has_divided || !periodic_.faces.empty()))
      throw InputError(problem_.layers[0].where +
                       ": layers on a surface go neither with periodic faces nor with 'divide' of periodic "
                       "curves: expected one of the two");
    flattening_ = located(problem_.where, [&] {
      return metric_ ? flatten_by_metric(model_, *wanted_.metric) : flatten_periodic(model_, periodic_);
    });
    for (const LeftOutFace& face : model_.left_out) failures_.add(face.face, face.reason);
    add_unflattened(flattening_, model_, failures_);
    open_cracks(model_, flattening_.patches);
  }

  /// Meshes the curves once before, by sizes as they are, and makes these smaller in gaps.
  void make_room_in_gaps(int rows, MeshingSetup& p) {
    const SurfaceModel model = model_;
    const std::shared_ptr<const SizeField> base = wanted_.base;
    const auto spots = sizes_in_gaps(base, rows, [&](const auto& size, const LookAtPatch& look) {
      wanted_.base = size;
      lay_flat();
      const SurfaceDomain domain = curves_by(SurfaceSize(model_, wanted_), std::move(flattening_));
      for (const SurfacePatch& patch : domain.patches)
        look(patch.boundary, domain.boundary.points, domain.cut_face);
      model_ = model;
      failures_ = Failures(problem_);
      of_periodic_.clear();
    });
    if (spots.empty()) return;
    wanted_.base = finer_near(base, spots);
    warn_of_many_rows(problem_.name, rows, expected_quads(model_.fine, SurfaceSize(base)),
                      expected_quads(model_.fine, SurfaceSize(wanted_.base)), p.warnings);
    p.size.adapted_to.emplace_back("gaps between curves");
  }

  /// Selects one side of thin bodies.
  void find_opposite_sides() {
    const auto opposite = std::make_shared<OppositeSides>(model_);
    opposite->add_to(model_);
    for (const int face : opposite->faces()) selected_.insert(model_.fine.regions[face].tag);
    surface_->opposite = opposite;
  }

  /// By region; empty if all are selected.
  std::vector<char> unselected_faces() const {
    std::vector<char> unselected;
    for (const Entity& face : model_.fine.regions)
      unselected.push_back(!selected_.empty() && !selected_.contains(face.tag));
    return std::ranges::count(unselected, 1) > 0 ? unselected : std::vector<char>();
  }

  /// Where faces are left out, nodes on curves stay as they are in the whole model.
  std::vector<SizeBall> spots_of_curves() const {
    return selected_.empty() ? hints_.spots : std::vector<SizeBall>();
  }

  /// Takes out the patches of unselected faces. Nodes on their curves stay from then on; smaller sizes for a
  /// sound mesh hold inside of patches alone.
  void leave_out(MeshingSetup& p) {
    SurfaceDomain& domain = surface_->domain;
    std::vector<int> number;  // of each patch now
    int n = 0;
    for (const SurfacePatch& patch : domain.patches) {
      const bool stays = !failures_.is_ignored(patch.map.face);
      number.push_back(stays ? n++ : -1);
      for (const auto& loop : patch.outline)
        for (const CurveSide& side : loop)
          if (!stays) domain.chain_stays[side.chain] = 1;
    }
    std::erase_if(domain.patches, [&](const SurfacePatch& q) { return failures_.is_ignored(q.map.face); });
    const auto renumber = [&](auto& parts) {
      for (auto& part : parts) part.patch = number[part.patch];
      std::erase_if(parts, [](const auto& part) { return part.patch < 0; });
    };
    renumber(domain.caps);
    renumber(domain.mapped);
    if (domain.patches.empty())
      throw InputError(model_.source + ": none of the selected faces can be meshed");
    if (hints_.spots.empty()) return;
    wanted_.spots = hints_.spots;
    if (!(wanted_.gradation > 0)) wanted_.gradation = kShortCurveGradation;
    surface_->size = std::make_shared<SurfaceSize>(model_, wanted_);
    p.size.field = surface_->size;
  }

  void put_layers_on(MeshingSetup& p) {
    if (layers_.empty()) return;
    const bool has_rows = layers_.size() > problem_.layers.size();
    const auto before = has_rows ? std::optional(surface_->domain) : std::nullopt;
    std::vector<LocalSize> fine;
    try {
      fine = put_layers(layers_, problem_.mapped, model_, cut_ ? &cut_->half : nullptr, surface_->domain, p);
    } catch (const InputError& error) {
      if (!has_rows) throw;
      p.warnings.push_back(
          {"holes without rows", 1, fmt::format("the model gets no rows: {} [no-rows]", error.what())});
      layers_ = problem_.layers;
      surface_->domain = *before;
      return put_layers_on(p);
    }
    if (cut_) {
      auto whole = std::make_shared<LayerReport>(*p.layers);
      for (int* n : {&whole->count.columns, &whole->count.quads, &whole->count.fans})
        *n <<= cut_->planes.count();
      p.layers = std::move(whole);
    }
    p.size.expected_quads += p.layers->count.quads;
    check_count(p.size.expected_quads, problem_);
    if (fine.empty()) return;
    wanted_.base = finer_near(wanted_.base, fine);
    surface_->size = std::make_shared<SurfaceSize>(model_, wanted_);
    p.size.field = surface_->size;
    p.size.asked = asked_;
  }

  void set_size(MeshingSetup& p) {
    surface_->size = std::make_shared<SurfaceSize>(model_, wanted_);
    p.size.field = surface_->size;
    if (!wanted_.curve_limit.empty()) p.size.adapted_to.push_back("short curves");
    if (wanted_.curvature) p.size.adapted_to.push_back("curvature");
    if (!hints_.spots.empty()) p.size.adapted_to.push_back("sound quads");
    if (!divisions_.empty()) p.size.adapted_to.push_back("given edges");
    if (!p.size.adapted_to.empty()) p.size.asked = asked_;
    if (wanted_.curvature) {
      WantedSize curved = wanted_;
      curved.curve_limit.clear(), curved.spots.clear();
      p.size.curved = std::make_shared<SurfaceSize>(model_, curved);
    }
    p.size.expected_quads =
        expected_quads(model_.fine, *surface_->size, periodic_.faces, part(), p.unselected);
    check_count(p.size.expected_quads, problem_);
  }

  const MeshProblem& problem_;
  const RetryHints& hints_;
  Failures failures_{problem_};
  SurfaceModel model_;
  std::set<int> selected_;                   ///< numbers of the faces that are meshed; empty: all
  std::shared_ptr<const SurfaceModel> cad_;  ///< SurfaceSetup::cad
  std::shared_ptr<const SizeField> asked_;
  double shortest_ = 0;            ///< least length of the criteria, in sizes; 0: none
  std::optional<CutSurface> cut_;  ///< of a symmetric surface, of which `model_` is a part
  std::vector<CurveDivision> divisions_ = problem_.divisions;  ///< of the part
  MappedSpec mapped_ = problem_.mapped;
  std::vector<LayerSpec> layers_ = problem_.layers;  ///< and rows around holes
  SurfaceWashers washers_{problem_, model_, divisions_, mapped_, layers_};
  WantedSize wanted_;
  std::optional<WantedMetric> metric_;  ///< in place of a size
  PeriodicSides periodic_;
  std::vector<Warning> of_periodic_;
  Flattening flattening_;
  std::shared_ptr<SurfaceSetup> surface_ = std::make_shared<SurfaceSetup>();
};

class GivenSurfaceSteps final : public ModelSteps {
 public:
  explicit GivenSurfaceSteps(const MeshProblem& problem)
      : problem_(problem),
        mesh_(std::get<GivenMesh>(problem.model).mesh),
        source_(&std::get<GivenMesh>(problem.model)) {}
  /// Makes the steps for a mesh that was read.
  GivenSurfaceSteps(const MeshProblem& problem, GivenSurface given, const Mesh& mesh,
                    std::shared_ptr<const SizeField> size)
      : problem_(problem), mesh_(mesh), given_(std::move(given)) {
    wanted_.base = std::move(size);
  }

  void read(MeshingSetup& p) override {
    check_surface_cross(problem_.cross);
    if (source_ != nullptr) read_mesh(p.warnings);
    wanted_.gradation = problem_.size.gradation;
  }

  bool is_surface() const override { return true; }

  void flatten(MeshingSetup&) override {
    FlattenOptions options;
    options.max_sigma = kMaxSigmaOfGiven;
    options.element = given_.element;
    options.avoided = given_.avoided;
    flattening_ = located(problem_.where, [&] { return delquad::flatten(given_.model, options); });
    add_unflattened(flattening_, given_.model, failures_);
    if (flattening_.patches.empty()) throw InputError(given_.model.source + ": no face can be meshed");
  }

  void mesh_curves(MeshingSetup& p) override {
    SurfaceModel& model = given_.model;
    surface_->cuts = flattening_.cuts;
    surface_->size = std::make_shared<SurfaceSize>(model, wanted_);
    p.size.field = surface_->size;
    p.settings.limits = limits_of(problem_.criteria, *surface_->size, model.fine.points);
    p.size.expected_quads = expected_quads(model.fine, *surface_->size);
    if (source_ != nullptr) check_count(p.size.expected_quads, problem_);
    if (!mesh_.quads.empty()) p.given_worst = worst_of_given(mesh_, false, *surface_->size);
    surface_->domain = make_kept_domain(model, std::move(flattening_), *surface_->size);
    given_.given_curve.resize(model.fine.curves.size(), -1);
    surface_->given = {mesh_.curves, mesh_.regions, given_.given_curve, given_.given_region};
    p.failures = failures_.take();
    append(p.warnings, model.warnings);
    append(p.warnings, surface_->domain.warnings);
    p.boundary = surface_->domain.boundary;
    p.boundary.unit = model.fine.unit;
    inside_.resize(surface_->domain.patches.size());
    for (std::size_t i = 0; i < inside_.size(); ++i)
      elements_.push_back(elements_within(given_, surface_->domain.patches[i], inside_[i]));
    surface_->model = std::move(model);
    p.surface = surface_;
  }

  void make_patches(MeshingSetup& p) override {
    prepare_patches(surface_, p);
    for (std::size_t i = 0; i < inside_.size(); ++i) {
      p.patches[i].given = std::move(elements_[i]);
      p.patches[i].given_inside = std::move(inside_[i]);
    }
    if (problem_.cross.kind == CrossKind::kSizeAware) make_crosses_size_aware(p);
    if (problem_.cross.kind == CrossKind::kMade) use_made_crosses(problem_.cross, p);
  }

 private:
  void read_mesh(std::vector<Warning>& warnings) {
    const GivenMesh& given = *source_;
    given_ = located(problem_.where, [&] {
      return make_given_surface(given, problem_.surface.feature_angle.value_or(kGivenFeatureAngle));
    });
    const Mesh& fine = given_.model.fine;
    append(warnings, {given.notes.begin(), given.notes.end()});
    auto own = [&]() -> std::shared_ptr<const SizeField> {
      if (problem_.size.from_boundary)
        throw InputError(problem_.size.where +
                         ": 'boundary' extends the lengths of a planar boundary: expected no size, a number "
                         "or an expression");
      return make_nodal_size(given.mesh, sizes_of_elements(given.mesh, given.source));
    };
    wanted_.base = base_size(problem_.size, {Box<Vec3>::around(fine.points), &fine}, warnings, own);
    if (!problem_.size.named.empty())
      wanted_.base = finer_near(wanted_.base, NamedParts(given.mesh).spots(problem_.size.named));
  }

  const MeshProblem& problem_;
  const Mesh& mesh_;                   ///< the given mesh
  const GivenMesh* source_ = nullptr;  ///< null: the mesh was read
  Failures failures_{problem_};
  GivenSurface given_;
  WantedSize wanted_;
  Flattening flattening_;
  std::vector<QuadPatch> elements_;        ///< of each patch
  std::vector<std::vector<Vec3>> inside_;  ///< of each patch, the places of its points
  std::shared_ptr<SurfaceSetup> surface_ = std::make_shared<SurfaceSetup>();
};

}  // namespace

CurveAgreement agreement_of(const MeshProblem& problem, const RetryHints& hints) {
  // An unsound mesh does not lack regularity, and may be made many times.
  constexpr long long kRetrySteps = kMostAgreementSteps / 10;
  const CurveOptions curves = curve_options(problem.options);
  const CriterionLimit* least = least_length(problem.criteria);
  return {regularity_options(problem.options).weight * curves.agreement,
          hints.spots.empty() ? kMostAgreementSteps : kRetrySteps,
          curves.round_holes,
          least != nullptr && least->in_sizes ? least->value : 0,
          curves.thin_rows,
          kind_of(problem.model).in_plane ? !curves.thin_rows && curves.agreement > 0 : curves.thin_rows};
}

std::unique_ptr<ModelSteps> surface_steps(const MeshProblem& problem, const RetryHints& hints) {
  return std::make_unique<SurfaceSteps>(problem, hints);
}

std::unique_ptr<ModelSteps> given_surface_steps(const MeshProblem& problem) {
  return std::make_unique<GivenSurfaceSteps>(problem);
}

MeshingSetup prepare_given_surface(const MeshProblem& problem, GivenSurface given, const Mesh& mesh,
                                   std::shared_ptr<const SizeField> size) {
  GivenSurfaceSteps steps(problem, std::move(given), mesh, std::move(size));
  return run_model_steps(problem, steps);
}

}  // namespace delquad
