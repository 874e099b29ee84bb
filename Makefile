# Installs what is missing, then calls the CMake presets.
PRESET ?= release
RESULTS ?= results
# Models that are no part of the project, see `make data`; experiments without theirs are skipped.
DATA ?= $(if $(wildcard ../shared/data),../shared/data,data)
# Files of peers that `make suite` runs beside our own words.
SUITE_PEERS ?= $(if $(shell command -v gmsh),experiments/peers/gmsh.toml)
CMAKE_FLAGS ?=
# How long `make fuzz` tries its targets, all of them together.
SECONDS ?= 120

.PHONY: packages package build dev lint test sanitize python data paper peers public public_models suite site bench fuzz

packages:
	@cmake/install-packages.sh

build: packages
	cmake --preset $(PRESET) $(CMAKE_FLAGS)
	cmake --build --preset $(PRESET)

# For daily work: file by file, with warnings as errors; only what was touched is compiled again. TARGETS: some of them by name.
dev: packages
	@[ -d build/dev ] || cmake --preset dev $(CMAKE_FLAGS)
	cmake --build --preset dev $(if $(TARGETS),--target $(TARGETS))

# Without a build: checks the format of the sources, their structure, and the prose of new and changed lines.
lint:
	git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run -Werror
	python3 tests/house/check_house.py .
	python3 tests/house/check_prose.py

test: build
	ctest --preset $(PRESET) -j $$(nproc); status=$$?; \
	  grep -h -A1 ': Skipped$$' build/$(PRESET)/Testing/Temporary/LastTest.log | grep -v -e '^--$$' -e ': Skipped$$' | sort | uniq -c; \
	  exit $$status

PEERS = $(wildcard experiments/peers*.toml)

# Every experiment but those with other meshers: tables, pictures and a page that shows them, under $(RESULTS)/.
paper: EXPERIMENTS = $(filter-out $(PEERS),$(wildcard experiments/*.toml experiments/made/*.toml))
# Those; failed cells are part of their tables.
peers: EXPERIMENTS = $(PEERS)
peers: MAY_FAIL = ||:
# Models of other projects, beside what these published.
public: EXPERIMENTS = $(wildcard experiments/public/*.toml)
public: MAY_FAIL = ||:
public: INTO = $(RESULTS)/public
public: public_models
paper peers public: INTO ?= $(RESULTS)
paper peers public: build
	@build/$(PRESET)/delquad suite models -o experiments/made/models > /dev/null
	@for e in $(EXPERIMENTS); do \
	  build/$(PRESET)/delquad run $$e --data $(DATA) -o $(INTO)/$$(basename $$e .toml) $(MAY_FAIL) || exit $$?; \
	done
	build/$(PRESET)/delquad report $(INTO) -o $(INTO)/report.html
	@echo "Tables and pictures lie in $(INTO)/; $(INTO)/report.html shows them."

# Fetches these models, and writes those in formats of others anew: as model files, and with gmsh, where it is, as .brep.
public_models:
	@python3 experiments/data/fetch.py $(DATA) --list experiments/data/public.toml
	@python3 experiments/public/hohqmesh.py $(DATA)/hohqmesh/Benchmarks/ControlFiles/*.control experiments/public/models
	@python3 experiments/public/geo.py $(DATA)/marmousi.geo experiments/public/models/marmousi_lines.toml polyline
	@python3 experiments/public/geo.py $(DATA)/marmousi.geo experiments/public/models/marmousi_splines.toml spline
	@! command -v gmsh > /dev/null || for f in $(DATA)/hexme/original/*.geo; do gmsh $$f -0 -o $${f%.geo}.brep -v 2; done

# Fetches what is missing of the paper's own models, and checks what is there.
data:
	@python3 experiments/data/fetch.py $(DATA)

# Ours and other programs on the models that the program makes itself: failed cells are part of the ranking.
suite: build
	build/$(PRESET)/delquad suite models $(addprefix --public ,$(wildcard $(DATA) experiments/public/models)) -o $(RESULTS)/suite/models
	build/$(PRESET)/delquad run $(RESULTS)/suite/models/suite.toml -o $(RESULTS)/suite/run -j 2 --timeout 300 \
	  $(foreach peers,$(SUITE_PEERS),--peer $(peers)) > $(RESULTS)/suite/run.log ||:
	build/$(PRESET)/delquad suite table $(RESULTS)/suite
	build/$(PRESET)/delquad report $(RESULTS)/suite -o $(RESULTS)/suite/report.html
	@echo "$(RESULTS)/suite/ranking has the table; $(RESULTS)/suite/report.html shows the meshes."

# Debian packages, an archive and a Python wheel for other machines, in build/packages: docs/packages.md.
package: build
	@cmake/install-packages.sh dpkg-dev file patchelf xz-utils
	packaging/package.sh build/$(PRESET) build/packages

# The documentation as pages with a search, a gallery, and the references of C++ and Python, in build/site; with the tables of $(RESULTS) where
# there are any. They need no network.
site: build
	@cmake/install-packages.sh mkdocs mkdocs-material doxygen
	/usr/bin/python3 docs/site/make_site.py build/$(PRESET) $(RESULTS) build/site

# The rooms below the mesher, under the address and undefined-behaviour sanitizers; `make test PRESET=asan` takes all up to it.
SANITIZED = base matching mesh geometry_surface io boundaries insertion treatment recombination cleanup regularity cvt optimisation metrics
space = $(subst ,, )
sanitize: packages
	cmake --preset asan $(CMAKE_FLAGS)
	cmake --build --preset asan --target $(SANITIZED:%=test_%)
	ctest --preset asan -j $$(nproc) -R '^($(subst $(space),|,$(strip $(SANITIZED))))\.'

# The Python module, in build/$(PRESET)/python, and its tests.
python: packages
	cmake --preset $(PRESET) $(CMAKE_FLAGS)
	cmake --build --preset $(PRESET) --target delquad_python
	ctest --preset $(PRESET) -R '^python\.'

# BENCH_FLAGS: for Google Benchmark, or --record.
bench: build
	@cmake/install-packages.sh python3-scipy
	python3 benchmarks/cleanup_cost.py --counts 60000 250000 --words DB DBCO DLBCO --delquad build/$(PRESET)/delquad --data $(DATA)
	/usr/bin/python3 benchmarks/ratios.py build/$(PRESET) $(BENCH_FLAGS)

# Readers, experiments and the mesher against inputs that nobody would write: ends with an error when something was found,
# see CONTRIBUTING.md. TARGETS: some of them by name.
fuzz: packages
	@cmake/install-packages.sh clang-16 libclang-rt-16-dev
	cmake --preset fuzz $(CMAKE_FLAGS)
	cmake --build --preset fuzz
	python3 tests/fuzz/run.py build/fuzz --seconds $(SECONDS) $(if $(TARGETS),--targets $(TARGETS))
