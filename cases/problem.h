#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cases/case.h"
#include "delquad/mesher.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"

namespace delquad {

/// Whether the file holds a surface by its extension: CAD or triangles.
bool is_surface_file(const std::filesystem::path& path);
/// These extensions, for messages.
std::string surface_files();

/// How cases write it: "boundary", "size-aware", "gradient"; "angle" of fields.
std::string text_of(CrossKind kind);

/// What a case asks for: its files read (but for CAD), its formulas parsed. Throws InputError with file and
/// line.
MeshProblem make_problem(const Case& c);

/// Throws InputError with file and line where the model's file is missing (but for data that cases are
/// skipped without) or formulas of size or crosses cannot be read: what is known before anything is meshed.
void check_case(const Case& c);

/// Boundary, background mesh and fields of a case: prepare(make_problem(c), refinement), with the time of
/// reading.
PreparedProblem prepare_case(const Case& c, const Refinement& refinement = {});
/// run_word(), and then refine_unsound().
RunResult run_case(const Case& c, const Word& word, PreparedProblem& prepared,
                   const std::function<void(const std::string& stage)>& begins = {});

/// The size field of a mesh that is there already: `text` is a number, an expression, a file or "boundary",
/// as --size gives it.
std::shared_ptr<const SizeField> size_of_mesh(const Mesh& mesh, const std::string& text);

}  // namespace delquad
