target_compile_definitions(delquad_mesher PRIVATE DELQUAD_VERSION="${PROJECT_VERSION}")
