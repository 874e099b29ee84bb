# SPDX-License-Identifier: GPL-3.0-or-later
target_compile_definitions(delquad_mesher PRIVATE DELQUAD_VERSION="${PROJECT_VERSION}")
