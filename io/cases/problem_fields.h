// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>

#include "io/cases/case.h"
#include "io/cases/description.h"

// This header describes all structs of a problem; a new member needs a line here. Readers and writers use
// it.

namespace delquad {

// --- meshes and models in memory

template <>
inline constexpr auto kFields<Motion> =
    std::tuple(field("translate", &Motion::shift, "shift [x, y] or [x, y, z]"),
               field("rotate", &Motion::angle, "degrees, counterclockwise", {.form = Form::kDegrees}),
               field("centre", &Motion::centre, "center of the rotation; default: the origin"),
               field("axis", &Motion::axis, "axis of the rotation; default: z", {.form = Form::kVector}));
template <>
inline constexpr auto kFields<ModelCurve> = std::tuple(inner("shape", &ModelCurve::shape),
                                                       inner("name", &ModelCurve::name),
                                                       place(&ModelCurve::where),
                                                       inner("crack", &ModelCurve::is_crack),
                                                       inner("gone", &ModelCurve::is_gone),
                                                       inner("data", &ModelCurve::is_data));
template <>
inline constexpr auto kFields<ModelLoop> = std::tuple(inner("curves", &ModelLoop::curves),
                                                      inner("region", &ModelLoop::region),
                                                      place(&ModelLoop::where),
                                                      inner("hole", &ModelLoop::is_hole));
template <>
inline constexpr auto kFields<ModelPoint> = std::tuple(inner("at", &ModelPoint::at),
                                                       inner("name", &ModelPoint::name),
                                                       place(&ModelPoint::where));
template <>
inline constexpr auto kFields<PlanarModel> =
    std::tuple(place(&PlanarModel::source), inner("curve", &PlanarModel::curves),
               inner("loop", &PlanarModel::loops), inner("point", &PlanarModel::points),
               ignored(&PlanarModel::notes, "its reader makes the same warnings again"));
template <>
inline constexpr auto kFields<LineModel> = std::tuple(inner("mesh", &LineModel::mesh),
                                                      inner("surfaces", &LineModel::surfaces),
                                                      place(&LineModel::source));
template <>
inline constexpr auto kFields<TriangleModel> =
    std::tuple(inner("mesh", &TriangleModel::mesh), place(&TriangleModel::source),
               ignored(&TriangleModel::notes, "its reader makes the same warnings again"));
template <>
inline constexpr auto kFields<GivenMesh> = std::tuple(inner("mesh", &GivenMesh::mesh),
                                                      place(&GivenMesh::source),
                                                      ignored(&GivenMesh::notes,
                                                              "its reader makes the same warnings again"));
template <>
inline constexpr auto kFields<CadModel> =
    std::tuple(inner("file", &CadModel::file), field("bytes", &CadModel::bytes, "", {.form = Form::kBytes}));
template <>
inline constexpr auto kFields<ExampleModel> = std::tuple(inner("name", &ExampleModel::name));
template <>
inline constexpr auto kFields<ModelFile> = std::tuple(inner("path", &ModelFile::path),
                                                      inner("given", &ModelFile::given));
/// The alternatives of Model in records.
inline constexpr const char* kModelKinds = "planar|lines|triangles|given|cad|example|file";

// --- surfaces

template <>
inline constexpr auto kFields<MirrorPlane> = std::tuple(
    field("point", &MirrorPlane::point, "point of the plane, [x, y, z]",
          {.form = Form::kVector, .required = true}),
    field("normal", &MirrorPlane::normal, "normal of the plane, [x, y, z]",
          {.form = Form::kVector, .above = 0, .required = true}),
    field("tolerance", &MirrorPlane::tolerance,
          "distance of shared edges from the plane, in diagonals of the model", {.least = 0, .most = 0.1}),
    field("join", &MirrorPlane::join, "whether faces run on through the plane"));
template <>
inline constexpr auto kFields<EmbeddedLine> = std::tuple(inner("points", &EmbeddedLine::points),
                                                         inner("name", &EmbeddedLine::name),
                                                         place(&EmbeddedLine::where),
                                                         inner("crack", &EmbeddedLine::is_crack));
template <>
inline constexpr auto kFields<PartRule> = std::tuple(
    field("number", &PartRule::numbers, "numbers that 'delquad info' lists", {.least = 1}),
    field("like", &PartRule::like, "one of their names: * is any text, ? a letter"),
    field("box", &PartRule::box, "two opposite corners of a box that holds them whole"),
    field("normal", &PartRule::normal, "normal everywhere, within 5 degrees", {.form = Form::kVector}),
    field("at", &PartRule::at, "place that the part is nearest to", {.form = Form::kVector}));
template <>
inline constexpr auto kFields<NamedPart> =
    std::tuple(field("as", &NamedPart::name, "name that the parts get", {.required = true}),
               field("of", &NamedPart::curves, "kind of the parts", {.words = "faces|curves"}),
               field("", &NamedPart::rule), place(&NamedPart::where));
template <>
inline constexpr auto kFields<SurfaceSpec> = std::tuple(
    field("compound", &SurfaceSpec::compounds, "faces to mesh as one",
          {.form = Form::kOwn,
           .words = "none|tangent|all|groups",
           .type = R"({"anyOf": [{"enum": ["all", "tangent"]}, {"type": "array", "items":
               {"type": "array", "items": {"type": "integer"}, "minItems": 2}}]})",
           .option = "--compound",
           .keyword = "compounds"}),
    inner("groups", &SurfaceSpec::groups),
    field("ignore_below", &SurfaceSpec::ignore_below,
          "length: narrower faces become part of neighbors, shorter curves points",
          {.above = 0, .option = "--ignore-below"}),
    field("idealize", &SurfaceSpec::idealize, "whether ignore_below is min_length of the criteria",
          {.option = "--idealize"}),
    field("keep", &SurfaceSpec::keep, "names of faces and curves that are not left out",
          {.option = "--keep"}),
    field("fill_holes", &SurfaceSpec::fill_holes, "diameter up to which holes are closed",
          {.above = 0, .option = "--fill-holes"}),
    field("simplify", &SurfaceSpec::simplify, "sizes within which polylines and chains of curves lose points",
          {.least = 0, .option = "--simplify"}),
    field("feature_angle", &SurfaceSpec::feature_angle, "degrees by which triangles turn at a curve",
          {.above = 0, .most = 180, .option = "--feature-angle"}),
    field("weld_tolerance", &SurfaceSpec::weld_tolerance,
          "distance of open edges that are joined, in diagonals of the model",
          {.least = 0, .most = 0.1, .option = "--weld", .keyword = "weld"}),
    field("mirror", &SurfaceSpec::mirror, "plane of symmetry of a model that is one half"),
    field("glue", &SurfaceSpec::glue, "whether bodies of CAD share the faces at which they touch",
          {.option = "--glue"}),
    field("unit", &SurfaceSpec::unit, "unit of lengths",
          {.words = "um|mm|cm|m|km|in|ft", .option = "--unit"}),
    inner("embed", &SurfaceSpec::embed),
    field("name", &SurfaceSpec::names, "names of faces and curves", {.keyword = "names"}),
    field("faces", &SurfaceSpec::faces, "faces to mesh alone: names, numbers or rules",
          {.form = Form::kOwn,
           .type = R"({"type": ["string", "array"], "items": {"type": ["string", "object"]}})",
           .option = "--faces"}),
    field("midsurface", &SurfaceSpec::midsurface,
          "whether thin bodies are meshed half-way between their faces", {.option = "--midsurface"}),
    place(&SurfaceSpec::where));

// --- sizes and directions

template <>
inline constexpr auto kFields<SizeSource> = std::tuple(
    field("at", &SizeSource::a, "point, or first end of a segment", {.required = true}),
    field("to", &SizeSource::b, "other end of a segment"),
    field("near", &SizeSource::size_near, "size up to radius_near", {.above = 0, .required = true}),
    field("far", &SizeSource::size_far, "size beyond radius_far", {.above = 0, .required = true}),
    field("radius_near", &SizeSource::radius_near, "distance, or 0", {.least = 0}),
    field("radius_far", &SizeSource::radius_far, "distance", {.above = 0, .required = true}));
template <>
inline constexpr auto kFields<NamedSize> = std::tuple(
    field("name", &NamedSize::name, "name of curves, points, regions or faces", {.required = true}),
    field("size", &NamedSize::size, "largest size on them and in them", {.above = 0}),
    field("reach", &NamedSize::reach, "distance within which the size holds, too; default 0", {.least = 0}),
    field("growth", &NamedSize::growth, "growth of sizes from there on, per length; default 0.3",
          {.above = 0}),
    field("curvature", &NamedSize::curvature, "elements per full turn", {.least = kLeastPerTurn}),
    place(&NamedSize::where));
template <>
inline constexpr auto kFields<SizeSpec> = std::tuple(
    field("base", &SizeSpec::text, "number, formula, file or \"boundary\"",
          {.form = Form::kFormula, .above = 0, .option = "--size", .keyword = "size"}),
    ignored(&SizeSpec::folder, "the content of the file counts"), inner("field", &SizeSpec::field),
    inner("function", &SizeSpec::function), inner("from_boundary", &SizeSpec::from_boundary),
    field("source", &SizeSpec::sources, "points and segments with sizes", {.keyword = "sources"}),
    field("on", &SizeSpec::named, "sizes of parts by name", {.option = "--size-on", .keyword = "size_on"}),
    field("gradation", &SizeSpec::gradation, "most that sizes grow per length",
          {.above = 0, .option = "--gradation"}),
    field("curvature", &SizeSpec::curvature, "elements per full turn of curves and faces",
          {.least = kLeastPerTurn, .option = "--curvature"}),
    field("min", &SizeSpec::min, "least size by curvature",
          {.above = 0, .option = "--size-min", .keyword = "min_size"}),
    field("max", &SizeSpec::max, "largest size", {.above = 0, .option = "--size-max", .keyword = "max_size"}),
    place(&SizeSpec::where));
template <>
inline constexpr auto kFields<MetricLimits> =
    std::tuple(field("min", &MetricLimits::min, "least length", {.above = 0}),
               field("max", &MetricLimits::max, "largest length", {.above = 0}),
               field("aspect", &MetricLimits::aspect, "most that one length is of the other", {.least = 1}));
template <>
inline constexpr auto kFields<MetricSpec> =
    std::tuple(inner("function", &MetricSpec::function), inner("in_space", &MetricSpec::in_space),
               field("tensor", &MetricSpec::tensor,
                     "formulas of m11, m12, m22; of surfaces m11, m12, m13, m22, m23, m33"),
               field("chord", &MetricSpec::chord, "distance by which sides on a surface stray from an arc",
                     {.above = 0}),
               field("sizes", &MetricSpec::sizes, "formulas of h1, h2 and the direction of h1, in radians"),
               field("solution", &MetricSpec::solution, "formula that is interpolated well"),
               field("file", &MetricSpec::file, "FILE or FILE:FIELD with tensors at the points of its mesh"),
               ignored(&MetricSpec::folder, "the content of the file counts"), field("", &MetricSpec::limits),
               field("gradation", &MetricSpec::gradation,
                     "factor by which lengths grow per unit length at most", {.least = 1}),
               field("complexity", &MetricSpec::complexity,
                     "approximate number of quads, to which lengths are scaled", {.above = 0}),
               inner("scale", &MetricSpec::scale), place(&MetricSpec::where),
               ignored(&MetricSpec::plane, "it is made from the other fields"));
template <>
inline constexpr auto kFields<CrossSpec> =
    std::tuple(field("text", &CrossSpec::text, "", {.form = Form::kFormula}),
               field("kind", &CrossSpec::kind, "",
                     {.form = Form::kNone, .words = "boundary|size-aware|metric|gradient|field|made"}),
               inner("field", &CrossSpec::field), inner("function", &CrossSpec::function),
               inner("maker", &CrossSpec::maker), place(&CrossSpec::where));

// --- curves and grids

template <>
inline constexpr auto kFields<CurveDivision> =
    std::tuple(field("name", &CurveDivision::name, "name of curves", {.required = true}),
               field("edges", &CurveDivision::edges, "number of edges of each curve",
                     {.least = 1, .most = 100'000'000, .required = true}),
               field("progression", &CurveDivision::progression,
                     "length of each edge over the length of the edge before it", {.above = 0}),
               field("bump", &CurveDivision::bump,
                     "length of edges at the ends over the length in the middle", {.above = 0}),
               place(&CurveDivision::where));
template <>
inline constexpr auto kFields<PeriodicPair> =
    std::tuple(field("from", &PeriodicPair::from, "name of curves or faces", {.required = true}),
               field("to", &PeriodicPair::to, "name of their images", {.required = true}),
               field("", &PeriodicPair::motion), place(&PeriodicPair::where));
template <>
inline constexpr auto kFields<SymmetryPlane> = std::tuple(
    field("point", &SymmetryPlane::point, "point of the plane", {.required = true}),
    field("normal", &SymmetryPlane::normal, "normal of the plane", {.above = 0, .required = true}));
template <>
inline constexpr auto kFields<SymmetrySpec> = std::tuple(inner("planes", &SymmetrySpec::planes),
                                                         inner("automatic", &SymmetrySpec::automatic),
                                                         place(&SymmetrySpec::where));
template <>
inline constexpr auto kFields<GridCorner> = std::tuple(inner("name", &GridCorner::name),
                                                       inner("at", &GridCorner::at));
template <>
inline constexpr auto kFields<GridCorners> =
    std::tuple(field("name", &GridCorners::region, "name of a region or face", {.required = true}),
               field("corners", &GridCorners::corners, "three or four: names of points, or places",
                     {.form = Form::kOwn,
                      .required = true,
                      .type = R"({"type": "array", "items": {"type": ["string", "array"],
                          "items": {"type": "number"}}, "minItems": 3, "maxItems": 4})"}),
               place(&GridCorners::where));
template <>
inline constexpr auto kFields<MappedSpec> = std::tuple(inner("names", &MappedSpec::names),
                                                       inner("automatic", &MappedSpec::automatic),
                                                       place(&MappedSpec::where),
                                                       inner("corners", &MappedSpec::corners),
                                                       inner("rings", &MappedSpec::rings));
template <>
inline constexpr auto kFields<LayerSpec> = std::tuple(
    field("on", &LayerSpec::on, "names of curves that bound regions",
          {.form = Form::kTexts, .required = true}),
    field("first", &LayerSpec::first, "height of the quads at the curve", {.above = 0, .required = true}),
    field("growth", &LayerSpec::growth, "height of a quad over the height of the quad below it",
          {.least = 1}),
    field("number", &LayerSpec::number, "quads that stand on each other", {.least = 1, .most = 10'000}),
    field("thickness", &LayerSpec::thickness, "height of all of them, instead of the number", {.above = 0}),
    field("fan", &LayerSpec::fan, "degrees by which corners with a fan turn away", {.above = 0, .most = 120}),
    field("into", &LayerSpec::into, "names of the regions that get them; default: both sides of the curves",
          {.form = Form::kTexts}),
    place(&LayerSpec::where));
template <>
inline constexpr auto kFields<WasherSpec> = std::tuple(
    field("diameter", &WasherSpec::least, "diameters of the holes, [least, most]",
          {.form = Form::kLeast, .least = 0, .required = true}),
    field("diameter", &WasherSpec::most, "", {.form = Form::kMost, .above = 0, .required = true}),
    field("rows", &WasherSpec::rows, "rows of quads; default 1", {.least = 1, .most = 1000}),
    field("edges", &WasherSpec::edges, "edges around, even; default: by the size",
          {.least = 4, .most = 100'000'000}),
    field("width", &WasherSpec::width, "width of all rows; default: as high as edges are long", {.above = 0}),
    place(&WasherSpec::where));
template <>
inline constexpr auto kFields<FilletRows> =
    std::tuple(field("radius", &FilletRows::least, "radii of the fillets, [least, most]",
                     {.form = Form::kLeast, .least = 0, .required = true}),
               field("radius", &FilletRows::most, "", {.form = Form::kMost, .above = 0, .required = true}),
               field("rows", &FilletRows::rows, "rows of quads; default 1", {.least = 1, .most = 1000}),
               place(&FilletRows::where));

// --- criteria

template <>
inline constexpr auto kFields<CriterionLimit> = std::tuple(inner("criterion", &CriterionLimit::key),
                                                           inner("limit", &CriterionLimit::value),
                                                           inner("in_sizes", &CriterionLimit::in_sizes),
                                                           inner("on", &CriterionLimit::on),
                                                           place(&CriterionLimit::where));
template <>
inline constexpr auto kFields<Material> = std::tuple(
    field("young", &Material::young, "Young's modulus", {.above = 0, .required = true}),
    field("poisson", &Material::poisson, "Poisson's ratio", {.least = 0, .most = 0.5, .required = true}),
    field("density", &Material::density, "mass per volume", {.above = 0, .required = true}));
template <>
inline constexpr auto kFields<Criteria> = std::tuple(
    ignored(&Criteria::name, "it is a word of messages"),
    ignored(&Criteria::source, "it names a preset or file, whose limits count"),
    inner("limits", &Criteria::limits), field("material", &Criteria::material, "material for times"),
    field("time_step_by", &Criteria::time_step_by, "program by whose length times go",
          {.words = "ls-dyna|radioss|abaqus"}),
    field("strict", &Criteria::strict, "whether a mesh with elements that fail is not written"),
    place(&Criteria::where));

// --- the problem, and a case of an experiment

template <>
inline constexpr auto kFields<MeshProblem> = std::tuple(
    ignored(&MeshProblem::name, "it is a word of messages"), place(&MeshProblem::where),
    field("model", &MeshProblem::model, "", {.form = Form::kNone, .words = kModelKinds}),
    field("surface", &MeshProblem::surface, "how the faces of a surface are made"),
    field("layer", &MeshProblem::layers, "thin quads along curves", {.keyword = "layers"}),
    field("size", &MeshProblem::size, "wanted edge length",
          {.form = Form::kOwn, .type = R"({"type": ["number", "string"], "exclusiveMinimum": 0})"}),
    field("metric", &MeshProblem::metric, "lengths by direction, in place of a size"),
    field("cross", &MeshProblem::cross, "wanted directions: boundary, size-aware, gradient or an angle",
          {.form = Form::kOwn, .type = R"({"type": ["number", "string"]})", .option = "--cross"}),
    field("divide", &MeshProblem::divisions, "numbers of edges of curves"),
    field("periodic", &MeshProblem::periodic, "curves and faces that get the nodes of others"),
    field("symmetry", &MeshProblem::symmetry, "planes of symmetry, or \"auto\"",
          {.form = Form::kOwn, .type = R"({"enum": ["auto"]})"}),
    field("washers", &MeshProblem::washers, "rows of quads around holes", {.option = "--washers"}),
    field("fillet_rows", &MeshProblem::fillet_rows, "rows of quads across fillets",
          {.option = "--fillet-rows"}),
    field("mapped", &MeshProblem::mapped, "regions or faces that become grids, or \"auto\"",
          {.form = Form::kOwn,
           .type = R"({"type": ["string", "array"], "items": {"type": ["string", "object"]}})",
           .option = "--mapped"}),
    field("seed", &MeshProblem::seed, "above 0: the domain is changed a little at random", {.least = 0}),
    inner("options", &MeshProblem::options),
    field("criteria", &MeshProblem::criteria, "limits of elements: a preset, a file or a table",
          {.form = Form::kOwn, .type = R"({"type": "string"})", .option = "--criteria"}),
    field("refine", &MeshProblem::refine, "factor by which all sizes are divided",
          {.above = 0, .option = "--refine"}),
    field("quads", &MeshProblem::quads, "number of quads, about, by other sizes",
          {.least = 1, .option = "--quads"}),
    field("order", &MeshProblem::order, "order of the elements: curved above 1",
          {.least = 1, .most = kMostOrder, .option = "--order"}),
    field("max_elements", &MeshProblem::max_elements, "", {.form = Form::kNone, .least = 1}),
    inner("keep_going", &MeshProblem::keep_going), inner("allow_unsound", &MeshProblem::allow_unsound));

template <>
inline constexpr auto kFields<AdaptSpec> = std::tuple(
    inner("quads", &AdaptSpec::quads), inner("error", &AdaptSpec::error),
    field("norm", &AdaptSpec::norm, "p of the Lp norm of the error of interpolation", {.least = 1}),
    field("", &AdaptSpec::limits),
    field("gradation", &AdaptSpec::gradation, "factor by which lengths grow per unit length at most",
          {.least = 1}),
    inner("isotropic", &AdaptSpec::isotropic), inner("weight", &AdaptSpec::weight),
    inner("quality", &AdaptSpec::quality));
template <>
inline constexpr auto kFields<AdaptLoop> =
    std::tuple(field("kind", &AdaptLoop::kind, "kind of the meshes: sizes of the case, one size, or a loop",
                     {.words = "given|uniform|squares|stretched"}),
               field("meshes", &AdaptLoop::meshes,
                     "meshes of a loop, with the uniform one that it begins from", {.least = 2, .most = 100}),
               field("", &AdaptLoop::spec));
template <>
inline constexpr auto kFields<CaseOfStudy> =
    std::tuple(ignored(&CaseOfStudy::variant, "it names the cell, and the problem has its values"),
               ignored(&CaseOfStudy::folder, "it is the place of the results"),
               ignored(&CaseOfStudy::model_file, "the problem has its content"),
               ignored(&CaseOfStudy::may_be_absent, "it decides what happens without a model"),
               ignored(&CaseOfStudy::data_folder, "it is the place of the model"),
               field("domain", &CaseOfStudy::domain,
                     "domain that results count as, with others of the name; default: the geometry",
                     {.no_result = "it decides which results count together, and study.json has it"}),
               field("solution", &CaseOfStudy::solution,
                     "formula in x and y that Poisson's equation has as its solution"),
               field("adapt", &CaseOfStudy::adapt, "meshes that follow the solution"),
               field("compare", &CaseOfStudy::compare, "published row beside each pipeline",
                     {.no_result = "it names rows to show beside results"}));

}  // namespace delquad
