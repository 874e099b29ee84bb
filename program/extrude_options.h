#pragma once

#include "program/commands.h"

namespace CLI {
class App;
}

namespace delquad {

/// The command 'extrude', without the options that others have, too.
CLI::App* add_extrude(CLI::App& app, ExtrudeArguments& arguments);

}  // namespace delquad
