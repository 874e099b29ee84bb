# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing, then calls the CMake presets.
PRESET ?= release
RESULTS ?= results
# Folder of models that `make data` fetches; experiments without their models are skipped.
DATA ?= $(if $(wildcard ../shared/data),../shared/data,data)
# Files of peers that `make suite` runs beside our own pipelines.
SUITE_PEERS ?= $(if $(shell command -v gmsh),experiments/peers/adapters/gmsh.toml)
DELQUAD = build/$(PRESET)/delquad
CMAKE_FLAGS ?=
# Seconds of `make fuzz`, for all targets together.
SECONDS ?= 120

.PHONY: doc-tables fig15 package build dev lint test test-programs test-long sanitize python data paper studies peers public public_models suite site bench fuzz

# Builds the program, the programs and libraries that it loads, and the library for C++.
build:
	@cmake/install-packages.sh build
	cmake --preset $(PRESET) $(CMAKE_FLAGS)
	cmake --build --preset $(PRESET) --target delquad

# Builds file by file, with warnings as errors; compiles only changed files. TARGETS names some targets.
dev:
	@cmake/install-packages.sh build python test dev
	@[ -d build/dev ] || cmake --preset dev -DBUILD_TESTING=ON $(CMAKE_FLAGS)
	cmake --build --preset dev $(if $(TARGETS),--target $(TARGETS))

# Checks the format of the sources, their structure and their prose, without a build.
lint:
	@cmake/install-packages.sh lint
	git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run -Werror
	python3 tests/house/check_house.py .
	python3 tests/house/check_prose.py

# Builds and runs the tests; names skipped tests and the reasons. TESTS has options of ctest, such as -R "^mesher".
TESTS ?= -LE "long|programs"
test:
	@cmake/install-packages.sh build python test
	cmake --preset $(PRESET) -DBUILD_TESTING=ON -DDELQUAD_PYTHON=$(if $(filter asan,$(PRESET)),OFF,ON) $(CMAKE_FLAGS)
	cmake --build --preset $(PRESET)
	ctest --preset $(PRESET) -j $$(nproc) $(TESTS); status=$$?; \
	  sed -n -e '/: Skipped$$/{n;p}' -e 's/^skipped: //p' build/$(PRESET)/Testing/Temporary/LastTest.log | sort | uniq -c; \
	  exit $$status

# Installs solvers, meshers, browsers and LaTeX, and runs the tests that need them.
test-programs:
	@cmake/install-packages.sh programs
	@$(MAKE) test TESTS="-L programs"

# Runs the tests that take minutes.
test-long:
	@$(MAKE) test TESTS="-L long"

# Each of these targets runs the experiments of a folder, and makes a page of their tables and pictures. Finished cells are kept. If a cell
# fails that must not, the exit code says so at the end.
# `paper` makes the paper's tables and figures. SMALL=1 runs few pipelines, as a check.
paper: EXPERIMENTS = $(wildcard experiments/paper/*.toml)
paper: INTO = $(RESULTS)$(if $(SMALL),/small)
paper: FLAGS = $(if $(SMALL),--pipelines D$(,)DB)
paper: fig15
fig15: build
	@cmake --build --preset $(PRESET) --target fig15 > /dev/null
	@build/$(PRESET)/fig15 $(or $(INTO),$(RESULTS))/fig15_linf_delaunay
# `studies` makes all other measurements.
studies: EXPERIMENTS = $(wildcard experiments/studies/*.toml experiments/studies/on_suite/*.toml)
# `peers` compares with other meshers; it names those that are not installed, and stops programs that hang.
peers: FLAGS = --timeout 300
peers: EXPERIMENTS = $(wildcard experiments/peers/*.toml)
peers: STATUS = 0
# `public` compares with published results of other projects, for models that can be fetched.
public: EXPERIMENTS = experiments/public/mbb.toml experiments/public/hexme.toml \
  $(shell [ ! -f experiments/public/models/NACA0012.toml ] || echo experiments/public/hohqmesh.toml) \
  $(shell [ ! -f experiments/public/models/marmousi_lines.toml ] || echo experiments/public/marmousi.toml)
public: STATUS = 0
public: public_models

, = ,
STATUS = $$status
studies peers public: INTO = $(RESULTS)/$@
studies peers public: PACKAGES = python3 $(if $(filter peers,$@),python3-meshio)
paper studies peers public: build
	@cmake/install-packages.sh $(PACKAGES)
	@cmake/install-packages.sh python3-matplotlib || echo "The tables are made, and no figures."
	@$(DELQUAD) run $(EXPERIMENTS) -o $(INTO) --data $(DATA) -j $$(nproc) $(FLAGS) > /dev/null; status=$$?; \
	  $(DELQUAD) report $(INTO) -o $(INTO)/report.html || exit $$?; \
	  echo "Tables and pictures lie in $(INTO)/; $(INTO)/report.html shows them."; \
	  exit $(STATUS)

# Runs the short experiments of README and docs, and renews all tables of measurements whose results exist.
doc-tables: build
	@cmake/install-packages.sh python3
	@for name in $(shell python3 docs/make_tables.py --cheap); do \
	  $(DELQUAD) run experiments/studies/$$name.toml -o $(RESULTS)/studies/$$name > /dev/null || exit $$?; done
	@! cd $(RESULTS)/studies/which_quality 2> /dev/null || python3 $(CURDIR)/experiments/studies/which_quality.py . > printed.md
	@python3 docs/make_tables.py $(RESULTS)

# Fetches these models, and converts foreign formats to model files, or with gmsh to .brep.
public_models:
	@cmake/install-packages.sh curl ca-certificates python3
	@python3 experiments/data/fetch.py $(DATA) --list experiments/data/public.toml
	@mkdir -p experiments/public/models
	@[ ! -d $(DATA)/hohqmesh ] || python3 experiments/public/hohqmesh.py $(DATA)/hohqmesh/Benchmarks/ControlFiles/*.control experiments/public/models
	@[ ! -f $(DATA)/marmousi.geo ] || for curve in polyline:lines spline:splines; do \
	  python3 experiments/public/geo.py $(DATA)/marmousi.geo experiments/public/models/marmousi_$${curve#*:}.toml $${curve%:*} || exit $$?; done
	@[ ! -d $(DATA)/hexme ] || ! command -v gmsh > /dev/null || for f in $(DATA)/hexme/original/*.geo; do gmsh $$f -0 -o $${f%.geo}.brep -v 2; done

# Fetches missing models of the paper, and checks present ones.
data:
	@cmake/install-packages.sh curl ca-certificates python3
	@python3 experiments/data/fetch.py $(DATA)

# Runs our pipelines and other programs on the models of the suite; failed cells count in the ranking.
suite: build
	@cmake/install-packages.sh python3 python3-scipy
	@mkdir -p $(RESULTS)/suite
	$(DELQUAD) run $(wildcard experiments/suite/*.toml) -o $(RESULTS)/suite/run -j 2 --timeout 300 \
	  $(foreach peers,$(SUITE_PEERS),--peer $(peers)) > $(RESULTS)/suite/run.log ||:
	/usr/bin/python3 experiments/suite/ranking.py $(RESULTS)/suite
	$(DELQUAD) report $(RESULTS)/suite/run -o $(RESULTS)/suite/report.html
	@echo "$(RESULTS)/suite/ranking has the table; $(RESULTS)/suite/report.html shows the meshes."

# Makes Debian packages, an archive and a Python wheel in build/packages; see docs/packages.md.
package: build
	@cmake/install-packages.sh package python
	cmake --preset $(PRESET) -DDELQUAD_PYTHON=ON
	cmake --build --preset $(PRESET) --target delquad_python
	cmake/packaging/package.sh build/$(PRESET) build/packages

# Makes the documentation as web pages in build/site, with a search, a gallery, the references of C++ and Python, and tables of $(RESULTS).
site: build
	@cmake/install-packages.sh site
	/usr/bin/python3 docs/site/make_site.py build/$(PRESET) $(RESULTS) build/site

# Tests the modules that edit meshes and read files with the address and undefined-behavior sanitizers, in about ten minutes. The tests of
# termination take two minutes, and run the code of the tests of regularity.
sanitize:
	@cmake/install-packages.sh build test
	cmake --preset asan -DBUILD_TESTING=ON $(CMAKE_FLAGS)
	cmake --build --preset asan --target test_basics
	ctest --preset asan -j $$(nproc) -LE long -E Termination

# Builds the Python module in build/$(PRESET)/python.
python:
	@cmake/install-packages.sh build python
	cmake --preset $(PRESET) -DDELQUAD_PYTHON=ON $(CMAKE_FLAGS)
	cmake --build --preset $(PRESET) --target delquad_python

# Times single steps. BENCH_FLAGS has options of Google Benchmark, or --record.
bench:
	@cmake/install-packages.sh build bench
	cmake --preset $(PRESET) -DDELQUAD_BENCHMARKS=ON $(CMAKE_FLAGS)
	cmake --build --preset $(PRESET)
	python3 benchmarks/cleanup_cost.py --counts 60000 250000 --words DB DBCO DLBCO --delquad build/$(PRESET)/delquad --data $(DATA)
	/usr/bin/python3 benchmarks/ratios.py build/$(PRESET) $(BENCH_FLAGS)

# Tries readers, experiments and the mesher with damaged and random inputs; fails if it finds something (CONTRIBUTING.md). TARGETS names some
# targets.
fuzz:
	@cmake/install-packages.sh build fuzz
	cmake --preset fuzz $(CMAKE_FLAGS)
	cmake --build --preset fuzz
	python3 tests/fuzz/run.py build/fuzz --seconds $(SECONDS) $(if $(TARGETS),--targets $(TARGETS))
