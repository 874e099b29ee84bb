// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/bench.h"

int main(int argc, char** argv) { return delquad::run_program(argc, argv); }
